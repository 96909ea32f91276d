#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

namespace flexura {

/// An error in an expression. position() is the index of the faulty character, from 0.
class ExpressionError : public std::runtime_error {
 public:
  /// `what` describes the error without its position.
  ExpressionError(const std::string& what, std::size_t position)
      : std::runtime_error(what), position_(position) {}
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  std::size_t position_;
};

/// A user's formula as a function of time, such as "0.3*sin(2*pi*t/T)". Supports pi and the operators and
/// functions of muParser: sin, cos, exp, min, max, abs, if-then-else with ? :, ... Variables are t (time
/// since the start of the task, s), T (duration of the task, s) and i (number of the section, from 1). Not
/// thread-safe.
class Expression {
 public:
  /// Throws ExpressionError for an invalid formula, an unknown name, an assignment, or more than 1000
  /// characters.
  explicit Expression(const std::string& text);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  /// Returns the value at time t, s, in a task of duration T, s. Sections are numbered from 1. The result is
  /// not finite where the formula is undefined (1/0, sqrt(-1)).
  [[nodiscard]] double value(double t, double T, std::size_t section_number) const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace flexura
