#include "flexura/equipment/grbl_config.h"

#include <exception>
#include <string_view>

#include "flexura/base/table.h"
#include "flexura/equipment/grbl_codec.h"
#include "flexura/equipment/link.h"

namespace flexura {
namespace {

constexpr double longest_timeout = 600;  // s

void check_grbl(const GrblConfig& config, Reader& reader) {
  try {
    (void)parse_link_address(config.link);
  } catch (const std::exception& problem) {
    reader.problem_at("link", problem.what());
  }
  std::size_t next = 0;
  for (const char letter : config.axes) {
    const std::size_t at = grbl::axis_letters.find(letter, next);
    next = at == std::string_view::npos ? grbl::axis_letters.size() + 1 : at + 1;
    if (at == std::string_view::npos) break;
  }
  if (config.axes.empty() || next > grbl::axis_letters.size())
    reader.problem_at("axes",
                      "expected letters of axes in the order X Y Z A B C U V, each once, at least one");
  if (config.lead > config.most_lag) reader.problem_at("lead", "is above most_lag");
}

}  // namespace

const Table<GrblConfig>& fields_of(const GrblConfig*) {
  static const auto table =
      Table<GrblConfig>("grbl", "A motion controller with Grbl 1.1 or grblHAL.")
          .field("link", &GrblConfig::link,
                 {.meaning = "Serial line or address: \"/dev/ttyUSB0\", \"/dev/ttyACM0@115200\", "
                             "\"tcp:HOST:PORT\".",
                  .required = true})
          .field("axes", &GrblConfig::axes,
                 {.meaning =
                      "Letters of the controller's axes that drive motors, in the order X Y Z A B C U V."})
          .field("travel", &GrblConfig::travel,
                 {.meaning = "Largest motor position of either sign, microsteps.",
                  .range = between(1, 2097152),
                  .default_text = "2097152"})
          .field(
              "window", &GrblConfig::window,
              {.meaning =
                   "Largest number of bytes that the program sends before the controller has answered them.",
               .range = between(80, 4096)})
          .field(
              "lead", &GrblConfig::lead,
              {.meaning =
                   "Delay with which the motors follow a stream of commands without stopping between them.",
               .unit = Unit::second,
               .range = between(0, 1)})
          .field("most_lag", &GrblConfig::most_lag,
                 {.meaning = "If the rest of the previous motion lasts longer than this time, a new command "
                             "cancels the rest.",
                  .unit = Unit::second,
                  .range = between(0, 10)})
          .field(
              "answer_timeout", &GrblConfig::answer_timeout,
              {.meaning = "Longest wait for an answer.", .unit = Unit::second, .range = above_up_to(0, 10)})
          .field("connect_timeout", &GrblConfig::connect_timeout,
                 {.meaning = "Longest wait for a controller that is starting.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest_timeout)})
          .field("stop_timeout", &GrblConfig::stop_timeout,
                 {.meaning = "Longest duration of braking.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest_timeout)})
          .field("homing_timeout", &GrblConfig::homing_timeout,
                 {.meaning = "Longest duration of homing.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest_timeout)})
          .field("brake_time", &GrblConfig::brake_time,
                 {.meaning = "In an emergency stop: time for braking, before the controller is reset.",
                  .unit = Unit::second,
                  .range = between(0, 10)})
          .field(
              "writes_settings", &GrblConfig::writes_settings,
              {.meaning =
                   "Whether the program corrects wrong settings ($1, $10, $13) in the controller's memory."})
          .check(check_grbl);
  return table;
}

StopMessages grbl_stop(const GrblConfig& config) {
  return {.first = {std::string(1, grbl::hold)},
          .delay = config.brake_time,
          .then = {std::string(1, grbl::reset)}};
}

}  // namespace flexura
