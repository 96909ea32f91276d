#include "flexura/experiment/export_csv.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "flexura/base/table.h"
#include "flexura/experiment/messages.h"
#include "flexura/experiment/results.h"
#include "flexura/experiment/results_log.h"
#include "flexura/servo/servo_step.h"
#include "flexura/store/csv.h"
#include "flexura/store/json.h"
#include "flexura/store/mcap_reader.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

// "base_1_x" and so on: sections are counted from 1, as people count them.
void name_columns(CsvText& csv, std::string_view stem, std::size_t count) {
  for (std::size_t i = 1; i <= count; ++i) csv.cell(fmt::format("{}_{}", stem, i));
}

// The places of the base of each `part`, and of the tip, and how that is turned.
void name_places(CsvText& csv, std::string_view part, std::size_t count) {
  for (std::size_t i = 0; i <= count; ++i) {
    const std::string stem = i < count ? fmt::format("{}_{}", part, i + 1) : "tip";
    for (const char axis : {'x', 'y', 'z'}) csv.cell(fmt::format("{}_{}", stem, axis));
  }
  for (const char axis : {'w', 'x', 'y', 'z'}) csv.cell(fmt::format("tip_q{}", axis));
}

void add_places(CsvText& csv, const PosesMessage& poses) {
  for (const PoseMessage& pose : poses.poses)
    csv.cells(std::array{pose.position.x, pose.position.y, pose.position.z});
  const QuaternionMessage& q = poses.poses.back().orientation;
  csv.cells(std::array{q.w, q.x, q.y, q.z});
}

void name_columns(CsvText& csv, const ArmStateMessage& state) {
  const std::size_t sections = state.bends.size();
  csv.cell("time");
  if (state.archings) name_columns(csv, "arching", sections);
  if (state.cord_angles) name_columns(csv, "cord_angle", sections);
  for (std::size_t i = 1; i <= sections; ++i) {
    csv.cell(fmt::format("bend_x_{}", i));
    csv.cell(fmt::format("bend_y_{}", i));
  }
  name_columns(csv, "stretch", sections);
  name_places(csv, "base", sections);
  csv.end_row();
}

void add_row(CsvText& csv, const ArmStateMessage& state, const PosesMessage& poses) {
  csv.cell(state.time);
  if (state.archings) csv.cells(*state.archings);
  if (state.cord_angles) csv.cells(*state.cord_angles);
  for (const auto& bend : state.bends) csv.cells(bend);
  csv.cells(state.stretches);
  add_places(csv, poses);
  csv.end_row();
}

// The arm as it truly was; as many arcs in each row.
void add_truth(std::optional<CsvText>& csv, std::size_t& arcs, double time, const PosesMessage& poses) {
  if (!csv) {
    arcs = poses.poses.size() - 1;
    csv.emplace().cell("time");
    name_places(*csv, "arc", arcs);
    csv->end_row();
  }
  if (poses.poses.size() != arcs + 1)
    throw std::runtime_error(fmt::format("the log's true arm at {} s has other arcs than before", time));
  csv->cell(time);
  add_places(*csv, poses);
  csv->end_row();
}

// A column is a number of the arm; one log has one arm.
void check_sizes(const ArmStateMessage& state, std::size_t sections, const PosesMessage& poses) {
  const bool fits = state.bends.size() == sections && state.stretches.size() == sections &&
                    (!state.archings || state.archings->size() == sections) &&
                    (!state.cord_angles || state.cord_angles->size() == sections) &&
                    poses.poses.size() == sections + 1;
  if (!fits)
    throw std::runtime_error(fmt::format("the log's state at {} s does not fit its arm", state.time));
}

// The energies and errors of distributed arms; where they are along the arm is the log's to tell.
void name_dynamics_columns(CsvText& csv) {
  for (const char* title : {"time", "kinetic_energy", "gravity_energy", "elastic_energy", "potential",
                            "lyapunov", "taken_by_law", "taken_by_medium", "azimuth_error", "elevation_error",
                            "spatial_error", "tip_error", "tip_x", "tip_y", "tip_z"})
    csv.cell(std::string_view(title));
  csv.end_row();
}

void add_row(CsvText& csv, const DynamicsSampleMessage& sample) {
  csv.cells(std::array{sample.time, sample.kinetic_energy, sample.gravity_energy, sample.elastic_energy,
                       sample.potential, sample.lyapunov, sample.taken_by_law, sample.taken_by_medium,
                       sample.azimuth_error, sample.elevation_error, sample.spatial_error, sample.tip_error});
  if (sample.points.empty())
    throw std::runtime_error(fmt::format("the log's sample of dynamics at {} s has no points", sample.time));
  csv.cells(sample.points.back());
  csv.end_row();
}

void name_servo_columns(CsvText& csv) {
  for (const char* title :
       {"time", "seen_at", "rms", "most", "tip", "true_rms", "true_most", "true_tip", "potential", "limited"})
    csv.cell(std::string_view(title));
  csv.end_row();
}

// How far a servo's arm was from what is wanted; the shapes themselves are the log's to tell.
void add_row(CsvText& csv, const ServoStep& step) {
  const auto add_cells = [&](const auto& numbers, bool are_known) {
    for (const double number : numbers) {
      if (are_known)
        csv.cell(number);
      else
        csv.cell(std::string_view());
    }
  };
  const auto add_error = [&](const ServoError& error, bool is_known) {
    add_cells(std::array{error.rms, error.most, error.tip}, is_known);
  };
  csv.cell(step.time);
  add_cells(std::array{step.seen_at.value_or(0)}, step.seen_at.has_value());
  add_error(step.error.value_or(ServoError{}), step.error.has_value());
  add_error(step.truth ? step.truth->error : ServoError{}, step.truth.has_value());
  csv.cell(step.potential);
  csv.cell(std::string_view(step.limited));
  csv.end_row();
}

struct Tables {
  CsvText states;
  std::optional<CsvText> truth;  // Of runs that play a rig.
  CsvText events;
  std::optional<CsvText> dynamics;  // Of runs with such a task.
  std::optional<CsvText> servo;     // Likewise.
};

Tables tables_of(const McapReader& log, const std::string& name) {
  Tables tables;
  for (const char* title : {"time", "level", "name", "message"}) tables.events.cell(std::string_view(title));
  tables.events.end_row();
  std::optional<ArmStateMessage> state;  // waiting for its poses, which follow it
  std::optional<std::size_t> sections;
  std::size_t true_arcs = 0;
  for (const McapMessage& message : log.messages()) {
    const std::string& topic = message.channel->topic;
    if (topic == arm_state_topic) {
      state = read_as<ArmStateMessage>(parse_json(message.text(), name));
      if (!sections) name_columns(tables.states, *state);
      sections = sections.value_or(state->bends.size());
    } else if (topic == arm_poses_topic && state) {
      const auto poses = read_as<PosesMessage>(parse_json(message.text(), name));
      check_sizes(*state, *sections, poses);
      add_row(tables.states, *state, poses);
      state.reset();
    } else if (topic == arm_truth_topic) {
      const auto poses = read_as<PosesMessage>(parse_json(message.text(), name));
      if (!poses.poses.empty())
        add_truth(tables.truth, true_arcs, static_cast<double>(message.log_time) * 1e-9, poses);
    } else if (topic == dynamics_samples_topic) {
      if (!tables.dynamics) name_dynamics_columns(tables.dynamics.emplace());
      add_row(*tables.dynamics, read_as<DynamicsSampleMessage>(parse_json(message.text(), name)));
    } else if (topic == servo_steps_topic) {
      if (!tables.servo) name_servo_columns(tables.servo.emplace());
      add_row(*tables.servo, read_as<ServoStep>(parse_json(message.text(), name)));
    } else if (topic == events_topic) {
      const auto event = read_as<EventMessage>(parse_json(message.text(), name));
      tables.events.cell(static_cast<double>(message.log_time) * 1e-9);
      tables.events.cell(level_name(event.level));
      tables.events.cell(event.name);
      tables.events.cell(event.message);
      tables.events.end_row();
    }
  }
  if (!sections) {
    tables.states.cell(std::string_view("time"));  // Of a run that was stopped at once.
    tables.states.end_row();
  }
  return tables;
}

}  // namespace

ExportResult export_csv(const std::filesystem::path& results) {
  const McapReader log = open_log(results);
  const Tables tables = from_log([&] { return tables_of(log, (results / log_file_name).string()); });
  ExportResult result{make_new_folder(results / "csv"), log.truncated()};
  write_new_file(result.folder / "states.csv", tables.states.text());
  if (tables.truth) write_new_file(result.folder / "truth.csv", tables.truth->text());
  write_new_file(result.folder / "events.csv", tables.events.text());
  if (tables.dynamics) write_new_file(result.folder / "dynamics.csv", tables.dynamics->text());
  if (tables.servo) write_new_file(result.folder / "servo.csv", tables.servo->text());
  return result;
}

}  // namespace flexura
