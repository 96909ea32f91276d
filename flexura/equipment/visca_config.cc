#include "flexura/equipment/visca_config.h"

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

constexpr NumberRange visca_timeout_range = {.min = 0, .max = 10, .open_min = true};  // s
constexpr NumberRange visca_count_range = {.min = -0x80000, .max = 0x7FFFF};
constexpr std::int64_t most_zoom = 0xFFFF;

template <class Turn>
Table<Turn> visca_turn_table(const char* name, const char* meaning, const char* sign) {
  return Table<Turn>(name, meaning)
      .field("counts_per_degree", &Turn::counts_per_degree,
             {.meaning = fmt::format("Counts per degree. Negative if counts increase {}.", sign),
              .range = between(-1e4, 1e4)})
      .field("zero", &Turn::zero, {.meaning = "Count at the head's angle 0.", .range = visca_count_range})
      .field("limits", &Turn::limits,
             {.meaning = "Smallest and largest count that the program commands.", .range = visca_count_range})
      .field("digits", &Turn::digits,
             {.meaning = "Number of hexadecimal digits of a position in the head's commands.",
              .range = between(4, 5)})
      .field("speed", &Turn::speed,
             {.meaning = "Speed byte of moves, as the head's manual lists it.", .range = between(0, 24)})
      .field("tolerance", &Turn::tolerance,
             {.meaning = "Largest distance from the target at which a move counts as done, in counts.",
              .range = between(0, 1000)});
}

std::string turn_problem(const ViscaTurnConfig& turn, std::string_view name) {
  if (!std::isfinite(turn.counts_per_degree) || turn.counts_per_degree == 0)
    return fmt::format("{}.counts_per_degree: expected a number other than 0", name);
  if (turn.digits != 4 && turn.digits != 5) return fmt::format("{}.digits: expected 4 or 5", name);
  const std::int64_t half = std::int64_t{1} << (4 * turn.digits - 1);
  if (turn.limits[0] < -half || turn.limits[0] > turn.limits[1] || turn.limits[1] >= half)
    return fmt::format("{}.limits: expected the smaller count first, and counts of {} digits", name,
                       turn.digits);
  if (turn.zero < -half || turn.zero >= half)
    return fmt::format("{}.zero: expected a count of {} digits", name, turn.digits);
  if (turn.speed < 0 || turn.speed > 24) return fmt::format("{}.speed: expected 0 to 24", name);
  if (turn.tolerance < 0) return fmt::format("{}.tolerance: expected at least 0", name);
  return {};
}

std::string zoom_problem(const ViscaZoomConfig& zoom) {
  const auto& counts = zoom.counts;
  if (counts.size() < 2 || !std::ranges::is_sorted(counts, std::less_equal<>()) || counts.front() < 0 ||
      counts.back() > most_zoom)
    return "zoom.counts: expected 2 or more ascending counts, 0 to 65535";
  if (zoom.positions) {
    if (zoom.positions->size() != counts.size()) return "zoom.positions: expected one position per count";
    if (!std::ranges::all_of(*zoom.positions, [](double p) { return std::isfinite(p); }) ||
        !std::ranges::is_sorted(*zoom.positions, std::less_equal<>()))
      return "zoom.positions: expected ascending numbers";
  }
  if (zoom.tolerance < 0) return "zoom.tolerance: expected at least 0";
  return {};
}

std::int64_t turn_count(const ViscaTurnConfig& turn, double angle) {
  const double count = static_cast<double>(turn.zero) + angle / degree * turn.counts_per_degree;
  return std::llround(
      std::clamp(count, static_cast<double>(turn.limits[0]), static_cast<double>(turn.limits[1])));
}

double turn_angle(const ViscaTurnConfig& turn, std::int64_t count) {
  return static_cast<double>(count - turn.zero) / turn.counts_per_degree * degree;
}

// Returns y at x of the line through points with ascending x. Outside, the line continues.
double on_line(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  const auto above = std::ranges::upper_bound(xs, x) - xs.begin();
  const auto i = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(above, 1, static_cast<std::ptrdiff_t>(xs.size()) - 1));
  return ys[i - 1] + (x - xs[i - 1]) / (xs[i] - xs[i - 1]) * (ys[i] - ys[i - 1]);
}

std::vector<double> zoom_counts(const ViscaZoomConfig& zoom) {
  return {zoom.counts.begin(), zoom.counts.end()};
}

}  // namespace

const Table<ViscaBusConfig>& fields_of(const ViscaBusConfig*) {
  static const auto table =
      Table<ViscaBusConfig>("visca_bus", "Serial line or network address of one or more VISCA heads.")
          .field("link", &ViscaBusConfig::link,
                 {.meaning = "Address: a serial line such as /dev/ttyUSB0@9600, udp:HOST:PORT or "
                             "tcp:HOST:PORT.",
                  .required = true})
          .field("framing", &ViscaBusConfig::framing,
                 {.meaning = "How packets are sent. `stream`: one after the other. `datagram`: each packet "
                             "in a datagram. `sony`: each packet in a datagram, after Sony's header.",
                  .default_text = "stream for a serial line or TCP, sony for UDP port 52381, datagram for "
                                  "another UDP port"})
          .field(
              "set_addresses", &ViscaBusConfig::set_addresses,
              {.meaning = "Whether the program numbers the heads of a chain at the start, beginning with 1.",
               .default_text = "on a serial line only"})
          .field("reply_timeout", &ViscaBusConfig::reply_timeout,
                 {.meaning = "Longest wait for the answer of a head.",
                  .unit = Unit::second,
                  .range = visca_timeout_range})
          .field("tries", &ViscaBusConfig::tries,
                 {.meaning = "Number of times that a message is sent before a head counts as lost.",
                  .range = between(1, 20)})
          .check([](const ViscaBusConfig& config, Reader& reader) {
            if (const std::string problem = visca_problem(config); !problem.empty())
              reader.problem_at("link", problem);
          });
  return table;
}

const Table<ViscaPanConfig>& fields_of(const ViscaPanConfig*) {
  static const auto table = visca_turn_table<ViscaPanConfig>(
      "visca_pan", "Pan axis of a VISCA head. Positions are in counts, as the head's manual lists them.",
      "to the camera's right");
  return table;
}

const Table<ViscaTiltConfig>& fields_of(const ViscaTiltConfig*) {
  static const auto table = visca_turn_table<ViscaTiltConfig>(
      "visca_tilt", "Tilt axis of a VISCA head. Positions are in counts, as the head's manual lists them.",
      "downwards");
  return table;
}

const Table<ViscaZoomConfig>& fields_of(const ViscaZoomConfig*) {
  static const auto table =
      Table<ViscaZoomConfig>("visca_zoom", "Zoom of a VISCA head.")
          .field("counts", &ViscaZoomConfig::counts,
                 {.meaning = "Zoom counts, ascending. The first and the last count limit the commands.",
                  .range = between(0, most_zoom),
                  .count = {.min = 2}})
          .field("positions", &ViscaZoomConfig::positions,
                 {.meaning = "Zoom position at each of the counts, ascending. Between the counts, the zoom "
                             "position is interpolated linearly.",
                  .range = between(-1e9, 1e9),
                  .default_text = "the counts"})
          .field("tolerance", &ViscaZoomConfig::tolerance,
                 {.meaning = "Largest distance from the target at which zooming counts as done, in counts.",
                  .range = between(0, 1000)});
  return table;
}

const Table<ViscaConfig>& fields_of(const ViscaConfig*) {
  static const auto table =
      Table<ViscaConfig>("visca", "Pan/tilt/zoom head that is moved by VISCA commands.")
          .field("bus", &ViscaConfig::bus,
                 {.meaning = "Connection to the head. Heads with the same link are on one chain.",
                  .required = true})
          .field(
              "address", &ViscaConfig::address,
              {.meaning = "Address of the head: its place in the chain. Over UDP, the address is always 1.",
               .range = between(1, 7)})
          .field("pan", &ViscaConfig::pan, {.meaning = "Pan axis."})
          .field("tilt", &ViscaConfig::tilt, {.meaning = "Tilt axis."})
          .field("zoom", &ViscaConfig::zoom, {.meaning = "Zoom."})
          .field("confirm", &ViscaConfig::confirm,
                 {.meaning = "Whether the program accepts a position only if two answers agree.",
                  .default_text = "true, except with the framing sony"})
          .field("stall_time", &ViscaConfig::stall_time,
                 {.meaning = "Time for which a head may rest away from its target. After this time the "
                             "command is repeated. A head must also stop within this time after a halt.",
                  .unit = Unit::second,
                  .range = above_up_to(0, 100)})
          .check([](const ViscaConfig& config, Reader& reader) {
            if (const std::string problem = visca_problem(config); !problem.empty())
              reader.problem_at(problem.substr(0, problem.find('.')), problem);
          });
  return table;
}

std::string visca_problem(const ViscaBusConfig& config) {
  try {
    (void)parse_link_address(config.link);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  if (!visca_timeout_range.contains(config.reply_timeout))
    return "reply_timeout: expected more than 0 s, at most 10 s";
  if (config.tries < 1 || config.tries > 20) return "tries: expected 1 to 20";
  return {};
}

std::string visca_problem(const ViscaConfig& config) {
  if (config.address < 1 || config.address > 7) return "address: expected 1 to 7";
  if (!std::isfinite(config.stall_time) || config.stall_time <= 0)
    return "stall_time: expected more than 0 s";
  for (const std::string& problem : {visca_problem(config.bus), turn_problem(config.pan, "pan"),
                                     turn_problem(config.tilt, "tilt"), zoom_problem(config.zoom)})
    if (!problem.empty()) return problem;
  if (visca_framing(config.bus) != ViscaFraming::stream && config.address != 1)
    return "address: a head without a serial line has address 1";
  return {};
}

ViscaFraming visca_framing(const ViscaBusConfig& config) {
  if (config.framing) return *config.framing;
  const LinkAddress address = parse_link_address(config.link);
  constexpr std::uint16_t sony_port = 52381;
  if (address.kind != LinkAddress::Kind::udp) return ViscaFraming::stream;
  return address.port == sony_port ? ViscaFraming::sony : ViscaFraming::datagram;
}

bool visca_sets_addresses(const ViscaBusConfig& config) {
  if (config.set_addresses) return *config.set_addresses;
  return parse_link_address(config.link).kind == LinkAddress::Kind::serial;
}

ViscaDigits visca_digits(const ViscaConfig& config) {
  return {static_cast<int>(config.pan.digits), static_cast<int>(config.tilt.digits)};
}

ViscaCounts visca_counts(const ViscaConfig& config, const HeadState& state) {
  const std::vector<double> counts = zoom_counts(config.zoom);
  const double zoom = on_line(config.zoom.positions.value_or(counts), counts, state.zoom);
  return {turn_count(config.pan, state.pan), turn_count(config.tilt, state.tilt),
          std::llround(std::clamp(zoom, counts.front(), counts.back()))};
}

HeadState visca_state(const ViscaConfig& config, const ViscaCounts& counts) {
  const std::vector<double> known = zoom_counts(config.zoom);
  return {turn_angle(config.pan, counts.pan), turn_angle(config.tilt, counts.tilt),
          on_line(known, config.zoom.positions.value_or(known), static_cast<double>(counts.zoom))};
}

HeadConfig with_visca_resolution(HeadConfig head, const ViscaConfig& config) {
  const auto raise = [](double& resolution, double step) { resolution = std::max(resolution, step); };
  raise(head.pan.resolution, degree / std::abs(config.pan.counts_per_degree));
  raise(head.tilt.resolution, degree / std::abs(config.tilt.counts_per_degree));
  const std::vector<double> counts = zoom_counts(config.zoom), zooms = config.zoom.positions.value_or(counts);
  for (std::size_t i = 1; i < counts.size(); ++i)
    raise(head.zoom.resolution, (zooms[i] - zooms[i - 1]) / (counts[i] - counts[i - 1]));
  return head;
}

StopMessages visca_stop(const ViscaConfig& config) {
  const int address = static_cast<int>(config.address);
  const std::string stop_turn = visca_packet(
      address, visca_move_stop(static_cast<int>(config.pan.speed), static_cast<int>(config.tilt.speed)));
  const std::string stop_zoom = visca_packet(address, visca_zoom_stop());
  constexpr double delay = 0.2;  // s. The head has then answered, and its buffers are empty.
  // A head whose sockets are in use refuses to stop. What follows the first stops also empties the sockets.
  if (visca_framing(config.bus) != ViscaFraming::sony)
    return {{stop_turn, stop_zoom, visca_packet(address, visca_clear())}, delay, {stop_turn, stop_zoom}};
  // The guard does not know the next sequence number. A reset makes any valid.
  const auto numbered = [](std::uint32_t number, const std::vector<std::string>& packets) {
    using Kind = SonyMessage::Kind;
    std::vector<std::string> messages{bytes_of(SonyMessage{Kind::control, 0, std::string(sony_reset)})};
    for (const std::string& packet : packets)
      messages.push_back(bytes_of(SonyMessage{Kind::command, number++, packet}));
    return messages;
  };
  constexpr std::uint32_t first = 1, then = 5;
  return {numbered(first, {stop_turn, stop_zoom, visca_packet(address, visca_cancel(1)),
                           visca_packet(address, visca_cancel(2))}),
          delay, numbered(then, {stop_turn, stop_zoom})};
}

}  // namespace flexura
