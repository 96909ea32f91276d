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
constexpr char ask_status = '?';      ///< Answered by a status report.
constexpr char hold = '!';            ///< Brakes; the motion can go on later.
constexpr char resume = '~';          ///< Goes on after a hold.
constexpr char reset = '\x18';        ///< Restarts the firmware; motors stop without braking.
constexpr char cancel_jog = '\x85';   ///< Brakes a jog and forgets all jogs.
constexpr std::size_t most_axes = 8;  ///< Axes of a controller: X Y Z A B C U V.
constexpr std::string_view axis_letters = "XYZABCUV";  ///< In the order of positions.
constexpr std::size_t longest_line = 80;  ///< Characters of a line that Grbl 1.1 takes, with its end.
}  // namespace grbl

/// State of a controller.
enum class GrblState { idle, run, hold, jog, alarm, door, check, home, sleep, tool };
/// Returns the state's name in a status report, for example "Idle".
[[nodiscard]] std::string_view text(GrblState state);

/// Status report: `<Idle|MPos:0.000,0.000,0.000|FS:0,0>`.
struct GrblStatus {
  GrblState state = GrblState::idle;
  int part = -1;                       ///< Number after the state, as in Hold:1; -1 if there is none.
  bool is_work = false;                ///< Whether the positions are those of WPos instead of MPos.
  std::vector<double> positions = {};  ///< Position of each axis, mm; never empty.
  std::vector<double> offset = {};     ///< WCO, mm, with WPos = MPos - WCO; empty if it is not reported.
  std::optional<std::int64_t> free_blocks = {}, free_bytes = {};  ///< Bf: free places of the two buffers.
  std::optional<double> feed = {};                                ///< F or FS, mm/min.
  std::string pins = {};  ///< Pn: letters of the inputs that are active.
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

/// Returns the message of a line without its end. Never throws: a line that breaks any rule is unknown.
[[nodiscard]] GrblMessage parse_grbl(std::string_view line);

/// Returns a status report without the line's end, with 3 decimals as Grbl prints.
[[nodiscard]] std::string text(const GrblStatus& status);

/// Returns what `error:N` means.
[[nodiscard]] std::string_view grbl_error_meaning(int code);
/// Returns what `ALARM:N` means.
[[nodiscard]] std::string_view grbl_alarm_meaning(int code);

/// Returns the line, with its end, that moves axes to machine positions, mm, along a straight line.
/// `letters`: the axes, one letter per position. `feed`: speed along the line, mm/min, > 0. Positions have 5
/// decimals, without zeros at the end.
[[nodiscard]] std::string grbl_jog(std::string_view letters, std::span<const double> positions, double feed);

/// Cuts a stream of bytes into lines. Keeps at most `longest` bytes; a longer line is left out.
class GrblLines {
 public:
  static constexpr std::size_t longest = 512;  ///< Bytes of a line.

  /// Takes bytes; returns the lines that they complete, without ends. Empty lines are left out.
  std::vector<std::string> add(std::string_view bytes);
  /// Forgets the beginning of a line.
  void clear() { begun_.clear(), is_too_long_ = false; }

 private:
  std::string begun_;
  bool is_too_long_ = false;
};

}  // namespace flexura
