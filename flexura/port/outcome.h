#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace flexura {

/// Kind of failure of a device, which can occur without an error in the program.
enum class FaultKind {
  link_lost,  ///< The device does not answer.
  /// The device refuses a command. Examples are a position that is not finite and a shape that does not fit
  /// the arm.
  refused,
};

/// Reason why a device did not execute a command or return a reading.
struct PortFault {
  FaultKind kind = FaultKind::link_lost;
  std::string what;  ///< Error message with the device's name.
};

/// Returns "link lost: ..." or "refused: ...".
[[nodiscard]] std::string text(const PortFault& fault);

/// Result of a request to a device: a value, or the fault that prevented it.
template <class T>
class [[nodiscard]] Outcome {
 public:
  /// Makes an outcome from a value or a fault.
  Outcome(T value) : held_(std::move(value)) {}          // NOLINT(google-explicit-constructor)
  Outcome(PortFault fault) : held_(std::move(fault)) {}  // NOLINT(google-explicit-constructor)

  /// Returns true if there is a value.
  explicit operator bool() const { return std::holds_alternative<T>(held_); }

  /// Returns the value. Throws std::runtime_error with the fault's text if there is no value.
  [[nodiscard]] const T& value() const& {
    require_value();
    return std::get<T>(held_);
  }
  /// Moves the value out. Throws std::runtime_error with the fault's text if there is no value.
  [[nodiscard]] T&& value() && {
    require_value();
    return std::get<T>(std::move(held_));
  }
  /// Returns the fault, or std::nullopt if there is a value.
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

/// Value in the outcome of an accepted command, without content.
struct Accepted {};
/// Result of a command: accepted, or a fault. The result is available before the motion is completed.
using CommandOutcome = Outcome<Accepted>;

}  // namespace flexura
