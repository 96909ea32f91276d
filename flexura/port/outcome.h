#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace flexura {

/// What can go wrong at a port in a good run.
enum class FaultKind {
  link_lost,  ///< The device does not answer.
  refused,    ///< It answers, and does not do this: a position that is no number, a shape of another arm.
};

/// Why a device did not do or say what it was asked.
struct PortFault {
  FaultKind kind = FaultKind::link_lost;
  std::string what;  ///< In words, with the device's name.
};

/// "link lost: ...", "refused: ...".
[[nodiscard]] std::string text(const PortFault& fault);

/// What a port gives: a value, or the reason why there is none.
template <class T>
class [[nodiscard]] Outcome {
 public:
  /// A value, or a fault, where an outcome is asked for.
  Outcome(T value) : held_(std::move(value)) {}          // NOLINT(google-explicit-constructor)
  Outcome(PortFault fault) : held_(std::move(fault)) {}  // NOLINT(google-explicit-constructor)

  /// Whether there is a value.
  explicit operator bool() const { return std::holds_alternative<T>(held_); }

  /// std::runtime_error with the fault's text when there is no value.
  [[nodiscard]] const T& value() const& {
    require_value();
    return std::get<T>(held_);
  }
  /// The same, moved out.
  [[nodiscard]] T&& value() && {
    require_value();
    return std::get<T>(std::move(held_));
  }
  /// None when there is a value.
  [[nodiscard]] std::optional<PortFault> fault() const {
    if (*this) return std::nullopt;
    return std::get<PortFault>(held_);
  }

 private:
  void require_value() const {
    if (!*this) throw std::runtime_error(text(std::get<PortFault>(held_)));
  }
  std::variant<T, PortFault> held_;
};

/// The value of a command that was taken.
struct Accepted {};
/// What a command comes to: taken, or why not. It does not wait for the motion.
using CommandOutcome = Outcome<Accepted>;

}  // namespace flexura
