#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/experiment_document.h"
#include "flexura/experiment/schedule.h"
#include "flexura/model/obstacle.h"
#include "flexura/sim/deep_start.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"

namespace flexura {
namespace {

constexpr double max_steps = 1e6;
// An hour of two cameras at 30 Hz and more: limits the size of a log.
constexpr double max_frames = 250000;

// Returns the nodes of the document's tasks.
const Node::Array& task_nodes(const Node& document) {
  static const Node::Array none;
  const Node* list = document.find("task");
  const auto* tasks = list == nullptr ? nullptr : list->as<Node::Array>();
  return tasks == nullptr ? none : *tasks;
}

// Returns the file with a task's motion; null if it names none.
const Node* file_of(const Node& task) {
  const Node* file = task.find("file");
  return file == nullptr || file->as<std::string>() == nullptr ? nullptr : file;
}

// Returns the problems of missing files with motions of the document's tasks.
std::vector<Problem> missing_files(const Node& document, const std::filesystem::path& folder) {
  std::vector<Problem> problems;
  const Node::Array& tasks = task_nodes(document);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const Node* file = file_of(tasks[i]);
    if (file == nullptr) continue;
    try {
      (void)file_inside(folder, *file->as<std::string>());
    } catch (const InputError& error) {
      problems.push_back({file->where, fmt::format("task[{}].file: {}", i, error.problems().front().what)});
    }
  }
  return problems;
}

// Returns a table's member, which it creates if missing.
Node& made(Node& table, std::string_view key, Node::Value empty) {
  if (Node* found = table.find(key)) return *found;
  auto& members = *table.as<Node::Table>();
  members.push_back({std::string(key), table.where, {std::move(empty), table.where}});
  return members.back().node;
}

template <class T>
Node entries_of(const std::vector<T>& values) {
  Node::Array entries;
  for (const T& value : values) entries.push_back(Codec<T>::write(value));
  return {std::move(entries), {}};
}

// Returns the document with the default cameras and screens written out if a truth overlays them.
Node with_defaults_below(const Node& truth, Node document) {
  const auto is_left_out = [](const Node* table, std::string_view key) {
    return table == nullptr || table->find(key) == nullptr;
  };
  const Node* true_stand = truth.find("stand");
  const bool needs_cameras = truth.find("camera") != nullptr && is_left_out(&document, "camera");
  const bool needs_screens = true_stand != nullptr && true_stand->find("screen") != nullptr &&
                             is_left_out(document.find("stand"), "screen");
  if (!needs_cameras && !needs_screens) return document;
  Node nominal = document;
  std::erase_if(*nominal.as<Node::Table>(), [](const Node::Member& member) { return member.key == "truth"; });
  const auto experiment = read_as<Experiment>(nominal);
  if (needs_cameras) made(document, "camera", Node::Array{}) = entries_of(experiment.cameras());
  if (needs_screens) {
    made(made(document, "stand", Node::Table{}), "screen", Node::Array{}) =
        entries_of(*experiment.true_stand().screen);
  }
  return document;
}

// Returns the document with each table of [truth] completed by the rest of the file.
Node with_whole_truth(Node document) {
  Node* truth = document.find("truth");
  if (truth == nullptr || truth->as<Node::Table>() == nullptr) return document;
  const Node world = truth_of(with_defaults_below(*truth, document));
  for (Node::Member& member : *truth->as<Node::Table>()) {
    const Node* whole = world.find(member.key);
    if (whole != nullptr &&
        fields_of(static_cast<const TruthConfig*>(nullptr)).info().find(member.key) != nullptr)
      member.node = *whole;
  }
  return document;
}

void append(std::vector<Problem>& problems, const InputError& error) {
  problems.insert(problems.end(), error.problems().begin(), error.problems().end());
}

// Removes repeated problems: values that the truth inherits from the rest of the file have equal errors
// there.
void drop_inherited(std::vector<Problem>& problems) {
  constexpr std::string_view truth = "truth.";
  const std::vector<Problem> all = problems;
  std::erase_if(problems, [&](const Problem& problem) {
    if (!problem.what.starts_with(truth)) return false;
    const std::string_view inherited = std::string_view(problem.what).substr(truth.size());
    return std::ranges::any_of(all, [&](const Problem& other) {
      return other.what == inherited && other.where.line == problem.where.line &&
             other.where.column == problem.where.column;
    });
  });
}

// Returns the document's experiment. Throws all its problems at once, after the given ones.
Experiment read_document(const Node& document, std::vector<Problem> problems) {
  Experiment experiment;
  try {
    experiment = read_as<Experiment>(with_whole_truth(document));
  } catch (const InputError& error) {
    append(problems, error);
    drop_inherited(problems);
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return experiment;
}

// Returns the document's experiment with the content of its tasks' files in `folder`.
Experiment read_with_files(const Node& document, const std::filesystem::path& folder,
                           std::vector<Problem> problems) {
  std::ranges::move(missing_files(document, folder), std::back_inserter(problems));
  auto experiment = read_document(document, std::move(problems));
  experiment.folder = folder;
  problems = seeing_file_problems(experiment, document);
  for (std::size_t i = 0; i < experiment.task.size(); ++i)
    read_task_files(experiment.task[i], experiment, task_nodes(document).at(i), fmt::format("task[{}]", i),
                    problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  return experiment;
}

// Returns the place of the value `table`.`key`, or of the nearest enclosing value.
SourcePosition place_of(const Node& document, std::string_view table, std::string_view key) {
  const Node* outer = document.find(table);
  const Node* inner = outer == nullptr ? nullptr : outer->find(key);
  if (inner != nullptr) return inner->where;
  return outer == nullptr ? document.where : outer->where;
}

// Returns the place of an obstacle, or of the document.
SourcePosition place_of_obstacle(const Node& document, std::size_t index) {
  const Node* list = document.find("obstacle");
  const auto* entries = list == nullptr ? nullptr : list->as<Node::Array>();
  return entries == nullptr || index >= entries->size() ? document.where : (*entries)[index].where;
}

// Refuses an arm in motion that starts so deep in an obstacle that contact cannot push it out.
void check_start(const Experiment& experiment, const Node& document) {
  const RigConfig truth = experiment.true_rig();
  std::optional<DeepStart> deep;
  try {
    deep = deep_start(experiment.model_rig(), truth);
  } catch (const std::invalid_argument&) {
    return;  // Reported where the arm is simulated.
  }
  if (!deep) return;
  throw InputError(std::vector<Problem>{
      {place_of_obstacle(document, deep->obstacle),
       fmt::format("obstacle[{}]: at the start, the arm's centerline is inside {} (the arm is {:.3g} mm deep "
                   "at {:.4g} m from its base), and contact cannot push it out: expected the centerline "
                   "outside (change the obstacle's position, its ignore_base, arm.base or arm.initial)",
                   deep->obstacle, obstacles(truth.obstacles).at(deep->obstacle).name, 1e3 * deep->depth,
                   deep->s_rest)}});
}

// Makes the checks that need every file; reports them at places in `document`.
void check_whole(const Experiment& experiment, const Node& document) {
  const double duration = Schedule(experiment).duration();
  const auto refuse = [&](std::string_view table, std::string_view key, const std::string& what) {
    throw InputError(std::vector<Problem>{
        {place_of(document, table, key), fmt::format("{}.{}: makes {}", table, key, what)}});
  };
  if (duration / experiment.clock.step > max_steps) {
    refuse("clock", "step",
           fmt::format("{:.3g} steps in {:.6g} s: expected at most {:.0e}", duration / experiment.clock.step,
                       duration, max_steps));
  }
  double frames = 0;
  for (const CameraConfig& camera : experiment.true_rig().cameras)
    frames += duration * camera.sensor.frame_rate;
  if (experiment.record.cameras && frames > max_frames) {
    refuse("record", "cameras",
           fmt::format("{:.3g} images in {:.6g} s at the cameras' frame rates: expected at most {:.6g}",
                       frames, duration, max_frames));
  }
  check_start(experiment, document);
}

// Stores the value of `set` (path=value) in `document`.
void set_value(Node& document, const std::string& set) {
  const std::string source = "--set " + set.substr(0, set.find('\n'));
  const std::size_t equals = set.find('=');
  if (equals == std::string::npos) throw input_error(source, "expected path=value");
  if (set.find('\n') != std::string::npos)
    throw input_error(source, "expected a single value on a single line");
  std::string_view path = std::string_view(set).substr(0, equals);
  path.remove_prefix(std::min(path.find_first_not_of(' '), path.size()));
  path = path.substr(0, path.find_last_not_of(' ') + 1);
  if (path.substr(0, path.find('.')) == "include")
    throw input_error(
        source, "include: cannot be set, because files are included first: write it into the file", 1, 1);
  Node value =
      parse_toml_value(std::string_view(set).substr(equals + 1), source, 1, static_cast<int>(equals) + 2);
  const std::string error = set_at_path(document, path, std::move(value));
  if (!error.empty()) throw input_error(source, error, 1, 1);
}

// Returns the checked experiment of a document in `folder`. `title`: title if the document has none.
Experiment experiment_of(const Node& document, const std::filesystem::path& folder, const std::string& title,
                         std::vector<Problem> problems) {
  auto experiment = read_with_files(document, folder, std::move(problems));
  if (experiment.title.empty()) experiment.title = title;
  check_whole(experiment, document);
  return experiment;
}

}  // namespace

Node with_overrides(Node document, const Overrides& overrides) {
  std::vector<Problem> problems;
  for (const std::string& set : overrides.sets) {
    try {
      set_value(document, set);
    } catch (const InputError& error) {
      append(problems, error);
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  if (overrides.seed) {
    const auto source = std::make_shared<const std::string>("--seed");
    const std::string error = set_at_path(document, "seed", {*overrides.seed, {source, 0, 0}});
    if (!error.empty()) throw input_error("--seed", error);
  }
  return document;
}

namespace {

// Only the text of an experiment has no folder.
std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.parent_path().empty() ? "." : file.parent_path();
}

}  // namespace

Experiment load_experiment(const std::filesystem::path& file, const Overrides& overrides) {
  std::vector<Problem> repeated;
  const Node document = with_overrides(read_toml_file(file, &repeated), overrides);
  return experiment_of(document, folder_of(file), file.stem().string(), std::move(repeated));
}

ExperimentDocument::ExperimentDocument(const std::filesystem::path& file, const Overrides& overrides)
    : ExperimentDocument(with_overrides(read_toml_file(file), overrides), folder_of(file),
                         file.stem().string()) {}

ExperimentDocument::ExperimentDocument(Node document, std::filesystem::path folder, std::string title)
    : document_(std::move(document)), folder_(std::move(folder)), title_(std::move(title)) {}

Experiment ExperimentDocument::experiment(std::span<const Setting> settings) const {
  Node changed = document_;
  std::vector<Problem> problems;
  for (const Setting& setting : settings) {
    const std::string error = set_at_path(changed, setting.path, setting.value);
    if (!error.empty()) problems.push_back({setting.value.where, error});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return experiment_of(changed, folder_, title_, {});
}

Experiment parse_experiment(std::string_view text, const std::string& source, const Overrides& overrides) {
  std::vector<Problem> repeated;
  const Node document = with_overrides(parse_toml(text, source, &repeated), overrides);
  auto experiment = read_document(document, std::move(repeated));
  const auto names_file = [](const Node& task) {
    const Node* file = file_of(task);
    return file != nullptr && !file->as<std::string>()->empty();
  };
  if (std::ranges::any_of(task_nodes(document), names_file))
    throw input_error(source, "an experiment given as text cannot refer to a file of keyframes");
  check_whole(experiment, document);
  return experiment;
}

std::string experiment_toml(const Experiment& experiment) {
  return fmt::format("# As run by Flexura {}: every value and default, in base units.\n",
                     experiment.flexura) +
         write_toml(Codec<Experiment>::write(experiment), fields_of(&experiment).info());
}

}  // namespace flexura
