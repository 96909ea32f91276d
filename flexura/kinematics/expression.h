#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

namespace flexura {

/// What is wrong with an expression, and where: `position` counts its characters from 0.
class ExpressionError : public std::runtime_error {
 public:
  /// `what` tells what is wrong and not where.
  ExpressionError(const std::string& what, std::size_t position)
      : std::runtime_error(what), position_(position) {}
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  std::size_t position_;
};

/// A formula of time as a user writes it, "0.3*sin(2*pi*t/T)": muParser's operators and functions (sin, cos,
/// exp, min, max, abs, if-then-else with ? :, ...), the variables t (time in the task, s), T (the task's
/// duration, s) and i (the section's number from 1), and pi. One thread at a time.
class Expression {
 public:
  /// Throws ExpressionError: not a formula, an unknown name, an assignment, more than 1000 characters.
  explicit Expression(const std::string& text);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  /// Its value at t s of a task of T s for a section counted from 1; not finite where the formula has none
  /// there (1/0, sqrt(-1)).
  [[nodiscard]] double value(double t, double T, std::size_t section_number) const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace flexura
