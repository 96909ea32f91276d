#pragma once

#include <cstdint>
#include <string>

namespace flexura {

/// Condition of a rig, or of a recorded run at one time.
enum class Condition : std::uint8_t {
  idle,     ///< Nothing moves, and no tasks run.
  moving,   ///< A client moves the arm.
  running,  ///< Tasks run.
  done,     ///< All tasks are done, and no client has moved the rig since the last task.
  halted,   ///< A client or the program has stopped the motion.
  failed,   ///< Tasks have failed.
  unsafe,   ///< The arm violates a limit or has a forbidden contact, now or during the run's tasks.
};

/// Returns the name of a condition in messages, such as "unsafe".
[[nodiscard]] const char* name_of(Condition condition);
/// Returns the condition after a run with this outcome in its results: "done", "unsafe", "failed" or
/// "cancelled". Returns `idle` for an unknown outcome.
[[nodiscard]] Condition condition_after(const std::string& outcome);

/// A condition and its reason.
struct Conditioned {
  Condition condition = Condition::idle;
  std::string text;  ///< Reason in one line; may be "".
  bool operator==(const Conditioned&) const = default;
};

/// Returns the text message for clients.
[[nodiscard]] std::string condition_message(const Conditioned& conditioned);

}  // namespace flexura
