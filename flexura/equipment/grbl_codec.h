#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

// Messages of the motion controller firmwares Grbl 1.1 and grblHAL. They talk in lines of text over a serial
// line. Some single bytes act at once, between the lines. Source: gnea/grbl, doc/markdown/interface.md,
// commands.md, jogging.md and settings.md. Positions are in "mm", which is only a name here: a controller has
// a number of steps per mm (`$100` and following).
namespace flexura {

/// Bytes that act at once, wherever they are in the stream.
namespace grbl {
constexpr char ask_status = '?';      ///< Requests a status report.
constexpr char hold = '!';            ///< Feed hold: brakes. The motion can be resumed later.
constexpr char resume = '~';          ///< Resumes the motion after a hold.
constexpr char reset = '\x18';        ///< Restarts the firmware. The motors stop without braking.
constexpr char cancel_jog = '\x85';   ///< Brakes the current jog and deletes all queued jogs.
constexpr std::size_t most_axes = 8;  ///< Largest number of axes of a controller: X Y Z A B C U V.
constexpr std::string_view axis_letters = "XYZABCUV";  ///< Letters of the axes, in the order of positions.
constexpr std::size_t longest_line =
    80;  ///< Largest length of a line that Grbl 1.1 accepts, in characters, including the line's end.
}  // namespace grbl

/// State of a controller.
enum class GrblState { idle, run, hold, jog, alarm, door, check, home, sleep, tool };
/// Returns the state's name in a status report, for example "Idle".
[[nodiscard]] std::string_view text(GrblState state);

/// Status report: `<Idle|MPos:0.000,0.000,0.000|FS:0,0>`.
struct GrblStatus {
  GrblState state = GrblState::idle;
  int part = -1;  ///< Number after the state, as in Hold:1; -1 if there is none.
  bool is_work =
      false;  ///< Whether the report has work positions (WPos) instead of machine positions (MPos).
  std::vector<double> positions = {};  ///< Position of each axis, mm; never empty.
  std::vector<double> offset =
      {};  ///< Work coordinate offset WCO = MPos - WPos, mm; empty if it is not reported.
  std::optional<std::int64_t>
      free_blocks = {},
      free_bytes = {};              ///< Bf: free blocks of the planner, and free bytes of the receive buffer.
  std::optional<double> feed = {};  ///< Feed (F or FS), mm/min.
  std::string pins = {};            ///< Pn: letters of the inputs that are active.
};

/// `Grbl 1.1h ['$' for help]`: the firmware has (re)started.
struct GrblBanner {
  std::string name;  ///< "Grbl 1.1h"
};
/// `ok`: answer to one line.
struct GrblOk {};
/// `error:N`: answer to one line that was refused.
struct GrblError {
  int code = 0;
};
/// `ALARM:N`
struct GrblAlarm {
  int code = 0;
};
/// `$N=value`
struct GrblSetting {
  int number = 0;
  std::string value;
};
/// `[TYPE:text]`, for example `[MSG:Caution: Unlocked]`.
struct GrblFeedback {
  std::string type, text;
};
/// Any other line.
struct GrblUnknown {
  std::string line;
};

using GrblMessage = std::variant<GrblStatus, GrblBanner, GrblOk, GrblError, GrblAlarm, GrblSetting,
                                 GrblFeedback, GrblUnknown>;

/// Returns the message in a line, which has no line end. Never throws: an invalid line is a GrblUnknown.
[[nodiscard]] GrblMessage parse_grbl(std::string_view line);

/// Returns the text of a status report, without a line end. Numbers have 3 decimals, as in Grbl.
[[nodiscard]] std::string text(const GrblStatus& status);

/// Returns the meaning of `error:N`.
[[nodiscard]] std::string_view grbl_error_meaning(int code);
/// Returns the meaning of `ALARM:N`.
[[nodiscard]] std::string_view grbl_alarm_meaning(int code);

/// Returns the command, with its line end, that moves axes to machine positions, mm, along a straight line.
/// `letters`: the axes, one letter per position. `feed`: speed along the line, mm/min, > 0. Positions have at
/// most 5 decimals.
[[nodiscard]] std::string grbl_jog(std::string_view letters, std::span<const double> positions, double feed);

/// Splits a stream of bytes into lines. A line longer than `longest` bytes is discarded.
class GrblLines {
 public:
  static constexpr std::size_t longest = 512;  ///< Bytes of a line.

  /// Adds bytes. Returns the lines that are now complete, without line ends. Empty lines are omitted.
  std::vector<std::string> add(std::string_view bytes);
  /// Discards an incomplete line.
  void clear() { begun_.clear(), is_too_long_ = false; }

 private:
  std::string begun_;
  bool is_too_long_ = false;
};

}  // namespace flexura
