#pragma once

#include <cstdint>
#include <string>

namespace flexura {

/// The condition of a rig, or of a recorded run at one time.
enum class Condition : std::uint8_t {
  idle,     ///< Nothing happens.
  moving,   ///< Somebody moves the arm.
  running,  ///< Tasks run.
  done,     ///< They are done, and nobody has moved anything since.
  halted,   ///< Somebody, or the program, has stopped it.
  failed,   ///< Tasks have failed.
  unsafe,   ///< The arm is where it must not be, or has been in these tasks.
};

/// Returns its name in messages, such as "unsafe".
[[nodiscard]] const char* name_of(Condition condition);
/// Returns the condition after a run with this outcome ("done", "unsafe", "failed", "cancelled"), as results
/// name it; idle for an unknown one.
[[nodiscard]] Condition condition_after(const std::string& outcome);

/// A condition, and why it is so.
struct Conditioned {
  Condition condition = Condition::idle;
  std::string text;  ///< One line; may be "".
  bool operator==(const Conditioned&) const = default;
};

/// Returns the text message for clients.
[[nodiscard]] std::string condition_message(const Conditioned& conditioned);

}  // namespace flexura
