#include "flexura/equipment/onvif_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "flexura/base/degree.h"
#include "flexura/base/table.h"
#include "flexura/equipment/link.h"

namespace flexura {
namespace {

constexpr NumberRange onvif_timeout_range = {.min = 0, .max = 30, .open_min = true};  // s
constexpr double most_onvif = 1e6;                                                    // Positions.

template <class Turn>
Table<Turn> onvif_turn_table(const char* name, const char* meaning, const char* sign,
                             const char* default_text) {
  return Table<Turn>(name, meaning)
      .field("per_degree", &Turn::per_degree,
             {.meaning = fmt::format("Positions per degree. Negative if positions increase {}.", sign),
              .range = between(-1e4, 1e4),
              .default_text = default_text})
      .field("zero", &Turn::zero,
             {.meaning = "Position at the head's angle 0.", .range = between(-most_onvif, most_onvif)})
      .field("limits", &Turn::limits,
             {.meaning = "Smallest and largest position that the program commands.",
              .range = between(-most_onvif, most_onvif),
              .default_text = "the head's range"})
      .field("tolerance", &Turn::tolerance,
             {.meaning = "Largest distance from the target at which a move counts as done, in degrees.",
              .range = between(0, 90)});
}

std::string onvif_turn_problem(const OnvifTurnConfig& turn, std::string_view name) {
  if (turn.per_degree && (!std::isfinite(*turn.per_degree) || *turn.per_degree == 0))
    return fmt::format("{}.per_degree: expected a number other than 0", name);
  if (!std::isfinite(turn.zero)) return fmt::format("{}.zero: expected a finite number", name);
  if (turn.limits && !((*turn.limits)[0] < (*turn.limits)[1]))
    return fmt::format("{}.limits: expected the smaller position first", name);
  if (!(turn.tolerance >= 0)) return fmt::format("{}.tolerance: expected at least 0", name);
  return {};
}

std::string onvif_zoom_problem(const OnvifZoomConfig& zoom) {
  const auto ascend = [](const std::vector<double>& all) {
    return std::ranges::all_of(all, [](double one) { return std::isfinite(one); }) &&
           std::ranges::is_sorted(all, std::less_equal<>());
  };
  if (zoom.points.size() < 2 || !ascend(zoom.points))
    return "zoom.points: expected 2 or more ascending numbers";
  if (zoom.positions && zoom.positions->size() != zoom.points.size())
    return "zoom.positions: expected one position per point";
  if (zoom.positions && !ascend(*zoom.positions)) return "zoom.positions: expected ascending numbers";
  if (!(zoom.tolerance >= 0)) return "zoom.tolerance: expected at least 0";
  return {};
}

// Positions per degree of pan (sign -1) or tilt (sign 1).
double per_degree(const OnvifConfig& config, const OnvifTurnConfig& turn, bool is_pan) {
  if (turn.per_degree) return *turn.per_degree;
  const double half = is_pan ? 180 : 90;  // Degrees at the generic position 1.
  return (is_pan ? -1 : 1) / (config.space == OnvifPositions::degrees ? 1 : half);
}

// Returns y at x of the line through points with ascending x. Outside, the line continues.
double on_onvif_line(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  const auto above = std::ranges::upper_bound(xs, x) - xs.begin();
  const auto i = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(above, 1, static_cast<std::ptrdiff_t>(xs.size()) - 1));
  return ys[i - 1] + (x - xs[i - 1]) / (xs[i] - xs[i - 1]) * (ys[i] - ys[i - 1]);
}

}  // namespace

const std::vector<std::string>& names_of(const OnvifPositions*) {
  static const std::vector<std::string> names = {"generic", "degrees"};
  return names;
}

const Table<OnvifPanConfig>& fields_of(const OnvifPanConfig*) {
  static const auto table =
      onvif_turn_table<OnvifPanConfig>("onvif_pan", "Pan axis of an ONVIF head.", "to the camera's right",
                                       "-1/180; with space = \"degrees\", -1");
  return table;
}

const Table<OnvifTiltConfig>& fields_of(const OnvifTiltConfig*) {
  static const auto table = onvif_turn_table<OnvifTiltConfig>(
      "onvif_tilt", "Tilt axis of an ONVIF head.", "downwards", "1/90; with space = \"degrees\", 1");
  return table;
}

const Table<OnvifZoomConfig>& fields_of(const OnvifZoomConfig*) {
  static const auto table =
      Table<OnvifZoomConfig>("onvif_zoom", "Zoom of an ONVIF head.")
          .field(
              "points", &OnvifZoomConfig::points,
              {.meaning =
                   "Zoom positions in the head's unit, ascending. The first and the last limit the commands.",
               .range = between(-most_onvif, most_onvif),
               .count = {.min = 2}})
          .field("positions", &OnvifZoomConfig::positions,
                 {.meaning = "Zoom position at each of the points, ascending. Between the points, the zoom "
                             "position is interpolated linearly.",
                  .range = between(-1e9, 1e9),
                  .default_text = "the points"})
          .field("tolerance", &OnvifZoomConfig::tolerance,
                 {.meaning =
                      "Largest distance from the target at which zooming counts as done, in the head's unit.",
                  .range = between(0, most_onvif)});
  return table;
}

const Table<OnvifConfig>& fields_of(const OnvifConfig*) {
  static const auto table =
      Table<OnvifConfig>("onvif", "Pan/tilt/zoom head of an ONVIF camera.")
          .field("link", &OnvifConfig::link, {.meaning = "Address: tcp:HOST:PORT.", .required = true})
          .field("user", &OnvifConfig::user,
                 {.meaning = "User name for the login.", .default_text = "none: without a login"})
          .field("password_file", &OnvifConfig::password_file,
                 {.meaning = "Path of a file with the password in its first line.", .default_text = "none"})
          .field("path", &OnvifConfig::path, {.meaning = "Path of the camera's device service."})
          .field("profile", &OnvifConfig::profile,
                 {.meaning = "Token of the media profile.", .default_text = "the first profile with a head"})
          .field(
              "space", &OnvifConfig::space,
              {.meaning =
                   "Unit of the positions that the head receives and reports: generic numbers or degrees."})
          .field("pan", &OnvifConfig::pan, {.meaning = "Pan axis."})
          .field("tilt", &OnvifConfig::tilt, {.meaning = "Tilt axis."})
          .field("zoom", &OnvifConfig::zoom,
                 {.meaning = "Zoom. This table has no effect if the head has no zoom."})
          .field("speed", &OnvifConfig::speed,
                 {.meaning = "Speed of moves, as a fraction of the highest speed.",
                  .range = above_up_to(0, 1),
                  .default_text = "the head's setting"})
          .field("reply_timeout", &OnvifConfig::reply_timeout,
                 {.meaning = "Longest wait for the answer of the head.",
                  .unit = Unit::second,
                  .range = onvif_timeout_range})
          .field("tries", &OnvifConfig::tries,
                 {.meaning = "Number of times that a request is sent before a head counts as lost.",
                  .range = between(1, 20)})
          .field("stall_time", &OnvifConfig::stall_time,
                 {.meaning = "Time for which a head may rest away from its target. After this time the "
                             "command is repeated. A head must also stop within this time after a halt.",
                  .unit = Unit::second,
                  .range = above_up_to(0, 100)})
          .check([](const OnvifConfig& config, Reader& reader) {
            if (const std::string problem = onvif_problem(config); !problem.empty()) {
              const std::string field = problem.substr(0, problem.find_first_of(".:"));
              reader.problem_at(field.find(' ') == std::string::npos ? field : "link", problem);
            }
          });
  return table;
}

std::string onvif_problem(const OnvifConfig& config) {
  try {
    if (parse_link_address(config.link).kind != LinkAddress::Kind::tcp) return "link: expected tcp:HOST:PORT";
  } catch (const std::invalid_argument& error) {
    return fmt::format("link: {}", error.what());
  }
  if (config.user.empty() != config.password_file.empty())
    return "user: expected user and password_file, or neither";
  if (!config.path.starts_with('/') ||
      !std::ranges::all_of(config.path, [](char c) { return c > ' ' && c < '\x7f'; }))
    return "path: expected a path such as /onvif/device_service";
  const auto is_share = [](double value) { return value > 0 && value <= 1; };
  if (config.speed && !is_share(*config.speed)) return "speed: expected more than 0, at most 1";
  if (!onvif_timeout_range.contains(config.reply_timeout))
    return "reply_timeout: expected more than 0 s, at most 30 s";
  if (config.tries < 1 || config.tries > 20) return "tries: expected 1 to 20";
  if (!std::isfinite(config.stall_time) || config.stall_time <= 0)
    return "stall_time: expected more than 0 s";
  for (const std::string& problem :
       {onvif_turn_problem(config.pan, "pan"), onvif_turn_problem(config.tilt, "tilt"),
        onvif_zoom_problem(config.zoom)})
    if (!problem.empty()) return problem;
  return {};
}

std::string_view onvif_space(const OnvifConfig& config) {
  return config.space == OnvifPositions::degrees ? onvif_degree_space : onvif_generic_space;
}

OnvifPlace onvif_place(const OnvifConfig& config, const OnvifRanges& ranges, const HeadState& state) {
  const auto turn = [&](const OnvifTurnConfig& axis, const OnvifRange& range, double angle, bool is_pan) {
    return std::clamp(axis.zero + angle / degree * per_degree(config, axis, is_pan), range.min, range.max);
  };
  OnvifPlace place{
      turn(config.pan, ranges.pan, state.pan, true), turn(config.tilt, ranges.tilt, state.tilt, false), {}};
  const std::vector<double>& points = config.zoom.points;
  if (ranges.has_zoom)
    place.zoom = std::clamp(on_onvif_line(config.zoom.positions.value_or(points), points, state.zoom),
                            points.front(), points.back());
  return place;
}

HeadState onvif_state(const OnvifConfig& config, const OnvifPlace& place) {
  const auto turn = [&](const OnvifTurnConfig& axis, double position, bool is_pan) {
    return (position - axis.zero) / per_degree(config, axis, is_pan) * degree;
  };
  const std::vector<double>& points = config.zoom.points;
  return {turn(config.pan, place.pan, true), turn(config.tilt, place.tilt, false),
          on_onvif_line(points, config.zoom.positions.value_or(points), place.zoom.value_or(points.front()))};
}

bool are_near(const OnvifConfig& config, const OnvifPlace& a, const OnvifPlace& b) {
  const auto near = [&](const OnvifTurnConfig& axis, double one, double other, bool is_pan) {
    constexpr double rounding = 1e-6;  // Of the six digits of a position in a command.
    return std::abs(one - other) <=
           axis.tolerance * std::abs(per_degree(config, axis, is_pan)) + rounding * std::abs(one);
  };
  return near(config.pan, a.pan, b.pan, true) && near(config.tilt, a.tilt, b.tilt, false) &&
         (!a.zoom || !b.zoom || std::abs(*a.zoom - *b.zoom) <= config.zoom.tolerance);
}

}  // namespace flexura
