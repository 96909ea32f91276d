#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

namespace flexura {

/// An error in an expression; `position` is the index of the character, from 0.
class ExpressionError : public std::runtime_error {
 public:
  /// `what` describes the error without its position.
  ExpressionError(const std::string& what, std::size_t position)
      : std::runtime_error(what), position_(position) {}
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  std::size_t position_;
};

/// A formula of time from a user, "0.3*sin(2*pi*t/T)". Supports muParser's operators and functions (sin, cos,
/// exp, min, max, abs, if-then-else with ? :, ...) and pi. Variables are t (time in the task, s), T (the
/// task's duration, s) and i (the section's number from 1). Not thread-safe.
class Expression {
 public:
  /// Throws ExpressionError for an invalid formula, an unknown name, an assignment, or more than 1000
  /// characters.
  explicit Expression(const std::string& text);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  /// Returns the value at t s of a task of T s for a section counted from 1. Not finite if the formula has no
  /// value there (1/0, sqrt(-1)).
  [[nodiscard]] double value(double t, double T, std::size_t section_number) const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace flexura
