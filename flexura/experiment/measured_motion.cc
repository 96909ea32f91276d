#include "flexura/experiment/measured_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/sim/rod_tube.h"
#include "flexura/store/csv_reader.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

constexpr std::size_t most_table_bytes = std::size_t{1} << 28;
// Tolerance between the base positions of the log's arm and the file's arm, relative to the arm's length.
constexpr double same_base = 1e-6;

Eigen::Vector3d position_of(const PoseMessage& pose) {
  return {pose.position.x, pose.position.y, pose.position.z};
}

struct Logged {
  std::vector<std::pair<double, PosesMessage>> truth;
  std::map<std::uint64_t, std::vector<double>> tensions;  // Keyed by the log's time.
  std::vector<std::uint64_t> times;                       // Times of `truth`.
};

Logged read_messages(const McapReader& log, const std::string& name, const TimeSpan& span) {
  Logged logged;
  for (const McapMessage& message : log.messages()) {
    const double time = static_cast<double>(message.log_time) * 1e-9;
    if (!span.has(time)) continue;
    const std::string& topic = message.channel->topic;
    if (topic == arm_truth_topic) {
      logged.truth.emplace_back(time, read_as<PosesMessage>(parse_json(message.text(), name)));
      logged.times.push_back(message.log_time);
    } else if (topic == arm_tensions_topic) {
      logged.tensions[message.log_time] = read_as<TensionsMessage>(parse_json(message.text(), name)).tensions;
    } else if (topic == arm_contacts_topic) {
      const auto touching = read_as<ContactsMessage>(parse_json(message.text(), name));
      if (!touching.contacts.empty())
        throw input_error(
            name, fmt::format("the arm touches {} at {} s, but the identification does not support contact: "
                              "expected a part of the motion without contact (--from, --to)",
                              touching.contacts[0].with, time));
    }
  }
  return logged;
}

MeasuredMotion motion_of(const Logged& logged, const std::string& name, const Experiment& experiment,
                         const Rod& rod, std::vector<std::string> notes) {
  if (logged.truth.empty())
    throw input_error(name,
                      "has no true arm states (/arm/truth): expected the log of a run of an arm with "
                      "model = \"dynamic\"");
  const Pose X_BW = experiment.arm.arm().X_WB.inverse();
  MeasuredMotion motion{
      .places = tube_places(rod), .samples = {}, .is_logged = true, .notes = std::move(notes)};
  const std::size_t poses = 2 * motion.places.size() - 1;
  for (std::size_t k = 0; k < logged.truth.size(); ++k) {
    const auto& [time, truth] = logged.truth[k];
    if (truth.poses.size() != poses)
      throw input_error(
          name,
          fmt::format("has a true arm of {} arcs at {} s: expected {} arcs for an elastic arm of {} sections",
                      truth.poses.size() - std::min<std::size_t>(1, truth.poses.size()), time, poses - 1,
                      rod.sections.size()));
    const auto pulls = logged.tensions.find(logged.times[k]);
    // A log that was cut short may lack the tensions of its last state.
    if (pulls == logged.tensions.end() && !motion.notes.empty() && k + 1 == logged.truth.size()) break;
    if (pulls == logged.tensions.end() && !rod.tendons.empty())
      throw input_error(name, fmt::format("has no tensions (/arm/tensions) at {} s", time));
    RodPlaceSample sample{.time = time, .positions = {}};
    if (pulls != logged.tensions.end()) sample.tensions = pulls->second;
    if (sample.tensions.size() != rod.tendons.size())
      throw input_error(name, fmt::format("has {} tendons at {} s: expected {}, as the experiment's arm has",
                                          sample.tensions.size(), time, rod.tendons.size()));
    // Each segment of the rod is logged as two arcs; every second arc starts at one of its places.
    for (std::size_t i = 0; i < poses; i += 2) sample.positions.push_back(X_BW * position_of(truth.poses[i]));
    if (!(sample.positions[0].norm() <= same_base * rod.length()))
      throw input_error(name,
                        fmt::format("has an arm whose base is {:.3g} m from the base of the experiment's arm",
                                    sample.positions[0].norm()));
    motion.samples.push_back(std::move(sample));
  }
  // The base does not move.
  motion.places.erase(motion.places.begin());
  for (RodPlaceSample& sample : motion.samples) sample.positions.erase(sample.positions.begin());
  return motion;
}

// Parses a column name such as "x@0.25": a coordinate of the place at an arc length at rest, m.
std::optional<double> place_in(std::string_view column, char axis) {
  if (!column.starts_with(axis) || column.substr(1, 1) != "@") return {};
  double s = 0;
  const char* end = column.data() + column.size();
  const auto [rest, error] = std::from_chars(column.data() + 2, end, s);
  if (error != std::errc{} || rest != end || !std::isfinite(s)) return {};
  return s;
}

MeasuredMotion motion_in_table(const std::string& name, const Experiment& experiment, const Rod& rod,
                               const TimeSpan& span) {
  const NumberTable table = parse_csv(read_text_file(name, most_table_bytes), name);
  const auto refuse = [&](const std::string& what) { return input_error(name, what, table.header_line, 1); };
  const std::size_t tendons = rod.tendons.size(), columns = table.columns.size();
  if (columns < 4 + tendons || (columns - 1 - tendons) % 3 != 0 || table.columns[0] != "time")
    throw refuse(
        fmt::format("{} columns: expected time, tension_1 to tension_{}, and x@S, y@S, z@S of each position, "
                    "where S is its arc length in m",
                    columns, tendons));
  for (std::size_t i = 0; i < tendons; ++i)
    if (const std::string desired = fmt::format("tension_{}", i + 1); table.columns[1 + i] != desired)
      throw refuse(fmt::format("column {} is \"{}\": expected \"{}\"", 2 + i, table.columns[1 + i], desired));
  MeasuredMotion motion;
  for (std::size_t c = 1 + tendons; c < columns; c += 3) {
    const auto s = place_in(table.columns[c], 'x');
    if (!s || place_in(table.columns[c + 1], 'y') != s || place_in(table.columns[c + 2], 'z') != s)
      throw refuse(fmt::format(
          "columns {} to {} are not a position: expected x@S, y@S and z@S, where S is an arc length in m",
          c + 1, c + 3));
    const auto place = place_at(rod, *s);
    if (!place)
      throw refuse(fmt::format("\"{}\" is not on the arm: expected an arc length above 0 and at most {} m",
                               table.columns[c], rod.length()));
    motion.places.push_back(*place);
  }
  const Pose X_BW = experiment.arm.arm().X_WB.inverse();
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const std::vector<double>& row = table.rows[r];
    if (!span.has(row[0])) continue;
    if (!motion.samples.empty() && !(row[0] > motion.samples.back().time))
      throw input_error(name,
                        fmt::format("time {}: expected a time after {}", row[0], motion.samples.back().time),
                        table.lines[r], 1);
    RodPlaceSample sample{.time = row[0], .positions = {}};
    for (std::size_t i = 0; i < tendons; ++i) {
      if (row[1 + i] < 0)
        throw input_error(name, fmt::format("tension_{} = {}: expected 0 or more", i + 1, row[1 + i]),
                          table.lines[r], 1);
      sample.tensions.push_back(row[1 + i]);
    }
    for (std::size_t c = 1 + tendons; c < columns; c += 3)
      sample.positions.push_back(X_BW * Eigen::Vector3d(row[c], row[c + 1], row[c + 2]));
    motion.samples.push_back(std::move(sample));
  }
  return motion;
}

}  // namespace

std::optional<RodPlace> place_at(const Rod& rod, double s) {
  if (!(s > 0) || !(s <= rod.length() * (1 + 1e-9))) return std::nullopt;
  std::size_t section = 0;
  while (section + 1 < rod.sections.size() && s > rod.sections[section].length) {
    s -= rod.sections[section].length;
    ++section;
  }
  return RodPlace{.section = section, .at = std::min(s / rod.sections[section].length, 1.0)};
}

MeasuredMotion read_motion(const std::filesystem::path& file, const Experiment& experiment, const Rod& rod,
                           const TimeSpan& span) {
  if (file.extension() == ".csv") return motion_in_table(file.string(), experiment, rod, span);
  const bool is_folder = std::filesystem::is_directory(file);
  if (!is_folder && is_missing(file))
    throw input_error(
        file.string(),
        "no such file: expected a folder made by `flexura run`, a log (.mcap), or measured points (.csv)");
  const McapReader log = is_folder ? open_log(file) : open_log_file(file);
  const std::string name = is_folder ? (file / log_file_name).string() : file.string();
  for (const McapDamage& damage : log.damage())
    if ((!span.to || *span.to >= 1e-9 * static_cast<double>(damage.from)) &&
        (!span.from || *span.from <= 1e-9 * static_cast<double>(damage.to)))
      throw input_error(name, log_notes(log).front() + ": choose a part without them by --from and --to");
  return from_log([&] {
    const Logged logged = read_messages(log, name, span);
    return motion_of(logged, name, experiment, rod, log_notes(log));
  });
}

}  // namespace flexura
