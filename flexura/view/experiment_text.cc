#include "flexura/view/experiment_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>

#include "flexura/base/node.h"
#include "flexura/model/arm_difference.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"
#include "flexura/view/session.h"

namespace flexura {
namespace {

// Nine digits: finer than any motor.
std::string digits(double value) { return fmt::format("{:.9g}", value + 0.0); }
double rounded_to_digits(double value) { return std::strtod(digits(value).c_str(), nullptr); }

ShapeConfig shape_of_state(const ArmState& state) {
  ShapeConfig shape;
  shape.bends.emplace();
  for (const auto& bend : state.bends) shape.bends->push_back({bend.x(), bend.y()});
  if (std::ranges::any_of(state.stretches, [](double stretch) { return stretch != 1; }))
    shape.stretches = state.stretches;
  return shape;
}

CameraStartConfig start_of_camera(const HeadState& head, const StageState& stage) {
  return {head.pan, head.tilt, head.zoom, {stage.offset.x(), stage.offset.y(), stage.offset.z()}};
}

// Sets where the axes of a camera and of the true one start. The experiment must have its cameras written
// out.
void set_camera_start(const ViewedRig& rig, std::size_t camera, const CameraReading& reading,
                      Experiment& experiment) {
  experiment.camera.at(camera).initial = start_of_camera(reading.head, reading.stage);
  if (!experiment.truth || experiment.truth->camera.empty()) return;
  const CameraStance truth = rig.stance(camera, reading);
  experiment.truth->camera.at(camera).initial = start_of_camera(truth.head, truth.stage);
}

// Writes out the default cameras.
void write_out_cameras(Experiment& experiment) {
  if (!experiment.camera.empty()) return;
  experiment.camera = experiment.cameras();
  experiment.stand.camera_distances.reset();
  if (experiment.truth && experiment.truth->stand) experiment.truth->stand->camera_distances.reset();
}

std::string whole_text(const Experiment& experiment) {
  const std::string text = experiment_toml(experiment);
  return "# Every value and default, in base units.\n" + text.substr(text.find('\n') + 1);
}

// Returns whether the text gives this experiment. A title that the text omits does not matter.
bool gives(const std::string& text, const Experiment& experiment) {
  try {
    Experiment read = parse_experiment(text, "");
    if (!read.include.empty()) return false;
    if (read.title.empty()) read.title = experiment.title;
    read.flexura = experiment.flexura;
    return experiment_toml(read) == experiment_toml(experiment);
  } catch (const InputError&) {
    return false;
  }
}

std::string name_of_pose(const Experiment& experiment) {
  std::set<std::string> names;
  for (const TaskConfig& task : experiment.task) names.insert(task_name(task));
  int number = 1;
  while (names.contains(fmt::format("pose {}", number))) ++number;
  return fmt::format("pose {}", number);
}

template <class List>
std::string list_text(const List& list) {
  std::string text;
  for (const double value : list) text += (text.empty() ? "" : ", ") + digits(value);
  return '[' + text + ']';
}

std::string move_text(const MoveTask& task) {
  std::string bends;
  for (const auto& bend : *task.to.bends) bends += (bends.empty() ? "" : ", ") + list_text(bend);
  const std::string stretches =
      task.to.stretches ? fmt::format(", stretches = {}", list_text(*task.to.stretches)) : "";
  return fmt::format("\n[[task]]\nkind = \"move\"\nname = \"{}\"\nduration = {}\nto = {{ bends = [{}]{} }}\n",
                     task.name, digits(task.duration.value()), bends, stretches);
}

std::string start_text(const CameraStartConfig& start) {
  const bool has_stage = start.stage != std::array<double, 3>{};
  return fmt::format("initial = {{ pan = {}, tilt = {}, zoom = {}{} }}", digits(start.pan),
                     digits(start.tilt), digits(start.zoom.value()),
                     has_stage ? fmt::format(", stage = {}", list_text(start.stage)) : "");
}

// Replaces a line of the text, counted from 1, or adds one after it.
std::string with_line(const std::string& text, int line, const std::string& content, bool is_added) {
  std::size_t begin = 0;
  for (int i = 1; i < line && begin != std::string::npos; ++i) {
    const std::size_t end = text.find('\n', begin);
    begin = end == std::string::npos ? end : end + 1;
  }
  if (begin == std::string::npos) return text;
  const std::size_t end = std::min(text.find('\n', begin), text.size());
  const std::size_t from = is_added ? end : begin;
  return text.substr(0, from) + (is_added ? "\n" : "") + content + text.substr(end);
}

// Returns the text with the start of a camera in its table [[camera]]; the text itself if there is no place.
std::string with_start_line(const std::string& text, std::size_t camera, const std::string& content) {
  Node document;
  try {
    document = parse_toml(text, "");
  } catch (const InputError&) {
    return text;
  }
  const Node* list = document.find("camera");
  const auto* cameras = list == nullptr ? nullptr : list->as<Node::Array>();
  if (cameras == nullptr || camera >= cameras->size()) return text;
  const Node* initial = cameras->at(camera).find("initial");
  const Node* name = cameras->at(camera).find("name");
  if (initial != nullptr) return with_line(text, initial->where.line, content, false);
  return name == nullptr ? text : with_line(text, name->where.line, content, true);
}

bool is_plain_name(const std::string& name) {
  constexpr std::string_view ending = ".toml";
  constexpr std::size_t longest = 100;
  const auto is_usual = [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_' || c == ' ');
  };
  return name.size() > ending.size() && name.size() <= longest && name.ends_with(ending) &&
         std::isalnum(static_cast<unsigned char>(name.front())) != 0 && std::ranges::all_of(name, is_usual);
}

}  // namespace

Experiment started_at(const ViewedRig& rig, const RigInstant& instant) {
  Experiment experiment = rig.experiment;
  const ArmDifference off =
      minus(ArmSetup(experiment.true_rig()).initial, ArmSetup(experiment.model_rig()).initial);
  experiment.arm.initial = shape_of_state(instant.arm);
  if (experiment.truth && experiment.truth->arm)
    experiment.truth->arm->initial = shape_of_state(plus(instant.arm, off));
  for (std::size_t i = 0; i < instant.cameras.size(); ++i) {
    if (rig.stance(i, instant.cameras[i]) == rig.first_stance(i)) continue;
    write_out_cameras(experiment);
    set_camera_start(rig, i, instant.cameras[i], experiment);
  }
  return experiment;
}

std::vector<Problem> experiment_problems(const std::string& text) {
  try {
    const Experiment experiment = parse_experiment(text, "");
    if (experiment.include.empty()) return {};
    return {{{}, "include: an experiment that is edited here cannot refer to another file"}};
  } catch (const InputError& error) {
    return error.problems();
  }
}

std::string editable_text(const std::string& file_text, const Experiment& experiment) {
  return !file_text.empty() && gives(file_text, experiment) ? file_text : whole_text(experiment);
}

std::string with_move(const std::string& text, const ViewedRig& rig, const ArmState& to) {
  constexpr double duration = 2;  // In s.
  ArmState rounded = to;
  for (auto& bend : rounded.bends) bend = {rounded_to_digits(bend.x()), rounded_to_digits(bend.y())};
  for (double& stretch : rounded.stretches) stretch = rounded_to_digits(stretch);
  Experiment experiment = rig.experiment;
  MoveTask task;
  task.name = name_of_pose(experiment), task.duration = duration;
  static_cast<ShapeConfig&>(task.to) = shape_of_state(rounded);
  experiment.task.emplace_back(task);
  const std::string longer = text + (text.ends_with('\n') ? "" : "\n") + move_text(task);
  return gives(longer, experiment) ? longer : whole_text(experiment);
}

std::string with_camera_start(const std::string& text, const ViewedRig& rig, std::size_t camera,
                              const CameraReading& reading) {
  CameraReading rounded = reading;
  for (double* value : {&rounded.head.pan, &rounded.head.tilt, &rounded.head.zoom})
    *value = rounded_to_digits(*value);
  for (double& offset : rounded.stage.offset) offset = rounded_to_digits(offset);
  Experiment experiment = rig.experiment;
  write_out_cameras(experiment);
  set_camera_start(rig, camera, rounded, experiment);
  const std::string changed = with_start_line(text, camera, start_text(experiment.camera[camera].initial));
  return gives(changed, experiment) ? changed : whole_text(experiment);
}

std::string free_name(const std::filesystem::path& folder, const std::string& stem) {
  for (int number = 2;; ++number) {
    std::string name = fmt::format("{}-{}.toml", stem, number);
    if (is_missing(folder / name)) return name;
  }
}

std::filesystem::path save_new_experiment(const std::filesystem::path& folder, const std::string& name,
                                          const std::string& text) {
  if (!is_plain_name(name))
    throw ViewRefusal(
        fmt::format("name = {}: expected a name made of letters, digits, spaces, \".\", \"-\" and \"_\" that "
                    "ends with .toml",
                    text_node(name).brief()));
  const std::filesystem::path file = folder / name;
  if (!is_missing(file))
    throw ViewRefusal(fmt::format("{} already exists: expected a new name", file.string()));
  try {
    write_new_file(file, text);
  } catch (const std::runtime_error& error) {
    throw ViewRefusal(error.what());
  }
  return file;
}

}  // namespace flexura
