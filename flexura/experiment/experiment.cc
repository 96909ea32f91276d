#include "flexura/experiment/experiment.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>

#include "flexura/store/toml.h"

namespace flexura {
namespace {

constexpr double max_duration = 1e6;  // s
constexpr double max_steps = 1e6;
constexpr std::size_t max_tasks = 10000;

void check_experiment(const Experiment& experiment, Reader& reader) {
  double total = 0;
  for (std::size_t i = 0; i < experiment.task.size(); ++i) {
    total += duration(experiment.task[i]);
    if (const auto* move = std::get_if<MoveTask>(&experiment.task[i])) {
      check_shape(move->to, experiment.arm.kind, experiment.arm.section.size(), fmt::format("task[{}].to", i),
                  reader);
    }
  }
  if (total / experiment.clock.step > max_steps) {
    reader.problem_at("clock.step", fmt::format("makes {:.3g} steps of {:.6g} s: expected at most {:.0e}",
                                                total / experiment.clock.step, total, max_steps));
  }
}

Node resolved_overrides(Node document, const Overrides& overrides) {
  for (const std::string& set : overrides.sets) {
    const std::string source = "--set " + set;
    const std::size_t equals = set.find('=');
    if (equals == std::string::npos) throw input_error(source, "expected path=value");
    Node value =
        parse_toml_value(std::string_view(set).substr(equals + 1), source, 1, static_cast<int>(equals) + 2);
    const std::string error =
        set_at_path(document, std::string_view(set).substr(0, equals), std::move(value));
    if (!error.empty()) throw input_error(source, error, 1, 1);
  }
  if (overrides.seed) {
    const auto source = std::make_shared<const std::string>("--seed");
    const std::string error = set_at_path(document, "seed", {*overrides.seed, {source, 0, 0}});
    if (!error.empty()) throw input_error("--seed", error);
  }
  return document;
}

}  // namespace

const Table<MoveTask>& fields_of(const MoveTask*) {
  static const auto table =
      Table<MoveTask>(
          "move",
          "The arm goes from where it is to another shape, every bend and stretch linearly in time. "
          "In a plane that is the same motion in cord angles, archings and bends.")
          .field("name", &MoveTask::name,
                 {.meaning = "What to call the task in results.", .default_text = "its kind"})
          .field("duration", &MoveTask::duration,
                 {.meaning = "How long the motion takes.",
                  .unit = Unit::second,
                  .range = above_up_to(0, max_duration)})
          .field("to", &MoveTask::to,
                 {.meaning = "The shape to reach, as `to.archings_deg = [...]`.", .required = true});
  return table;
}

const Table<HoldTask>& fields_of(const HoldTask*) {
  static const auto table =
      Table<HoldTask>("hold", "The arm stays as it is.")
          .field("name", &HoldTask::name,
                 {.meaning = "What to call the task in results.", .default_text = "its kind"})
          .field(
              "duration", &HoldTask::duration,
              {.meaning = "How long it stays.", .unit = Unit::second, .range = above_up_to(0, max_duration)});
  return table;
}

const Table<ClockConfig>& fields_of(const ClockConfig*) {
  static const auto table = Table<ClockConfig>("clock", "How time runs in the experiment.")
                                .field("step", &ClockConfig::step,
                                       {.meaning = "Time between two states of the experiment.",
                                        .unit = Unit::second,
                                        .range = between(1e-6, 1e3)});
  return table;
}

const Table<RecordConfig>& fields_of(const RecordConfig*) {
  static const auto table =
      Table<RecordConfig>("record", "What is kept of a run.")
          .field("every", &RecordConfig::every,
                 {.meaning = "Steps from one state in the log to the next; the last one is always kept.",
                  .range = between(1, 1e9)})
          .field("report", &RecordConfig::report, {.meaning = "Write report.html and figures/."});
  return table;
}

const Table<Experiment>& fields_of(const Experiment*) {
  static const auto table =
      Table<Experiment>(
          "Flexura experiment file",
          "A rig and the tasks it does, one after another. An arm alone is a file with [arm] only.")
          .field("flexura", &Experiment::flexura,
                 {.meaning = "Version that ran the file; written into results.", .default_text = "not set"})
          .field("title", &Experiment::title,
                 {.meaning = "A title for the report.", .default_text = "the file's name"})
          .field(
              "seed", &Experiment::seed,
              {.meaning = "Seed of every random number of the run.", .range = between(0, 9007199254740992.0)})
          .field("include", &Experiment::include,
                 {.meaning = "Files in this file's folder or below upon whose values this file's are laid.",
                  .count = {0, 100},
                  .default_text = "none"})
          .field("clock", &Experiment::clock, {.meaning = "How time runs."})
          .field("record", &Experiment::record, {.meaning = "What is kept of a run."})
          .field("arm", &Experiment::arm, {.meaning = "The arm.", .required = true})
          .field("task", &Experiment::task,
                 {.meaning = "What is done, in this order.", .count = {0, max_tasks}, .default_text = "none"})
          .check(check_experiment);
  return table;
}

double duration(const TaskConfig& task) {
  return std::visit([](const auto& one) { return one.duration; }, task);
}

std::string task_name(const TaskConfig& task) {
  return std::visit(
      [&](const auto& one) { return one.name.empty() ? std::string(task_kind(task)) : one.name; }, task);
}

std::string_view task_kind(const TaskConfig& task) {
  return std::visit(
      []<class T>(const T&) -> std::string_view {
        return fields_of(static_cast<const T*>(nullptr)).info().name;
      },
      task);
}

Experiment load_experiment(const std::filesystem::path& file, const Overrides& overrides) {
  auto experiment = read_as<Experiment>(resolved_overrides(read_toml_file(file), overrides));
  if (experiment.title.empty()) experiment.title = file.stem().string();
  return experiment;
}

Experiment parse_experiment(std::string_view text, const std::string& source) {
  return read_as<Experiment>(parse_toml(text, source));
}

std::string experiment_toml(const Experiment& experiment) {
  return fmt::format("# As run by Flexura {}: every value and default, in base units.\n",
                     experiment.flexura) +
         write_toml(Codec<Experiment>::write(experiment), fields_of(&experiment).info());
}

}  // namespace flexura
