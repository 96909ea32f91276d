#include "flexura/tasks/calibrate/calibrate_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/base/table.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"

namespace flexura {
namespace {

Node whole(std::size_t value) { return {static_cast<std::int64_t>(value), {}}; }

Node remainder_node(const RigRemainder& left) {
  const auto pair = [](double a, double b) { return Node{Node::Array{number_node(a), number_node(b)}, {}}; };
  return {Node::Table{{"angle_from_square", {}, number_node(left.angle)},
                      {"aim", {}, pair(left.aim[0].norm(), left.aim[1].norm())},
                      {"zoom_ratio", {}, number_node(left.zoom_ratio)},
                      {"roll", {}, pair(left.roll[0], left.roll[1])}},
          {}};
}

Node sigma_node(const RigSigmas& sigmas) {
  return {Node::Table{
              {"angle", {}, number_node(sigmas.angle)},
              {"focal", {}, {Node::Array{number_node(sigmas.focal[0]), number_node(sigmas.focal[1])}, {}}},
              {"zoom_ratio", {}, number_node(sigmas.zoom_ratio)}},
          {}};
}

// Returns the errors of the estimated results, divided by their estimated standard deviations.
Node error_over_sigma_node(const RigRemainder& estimated, const RigRemainder& truth,
                           const RigSigmas& sigmas) {
  const double angle = estimated.angle - truth.angle;
  const double zoom_ratio = std::log(estimated.zoom_ratio / truth.zoom_ratio);
  return {Node::Table{{"angle", {}, number_node(angle / sigmas.angle)},
                      {"zoom_ratio", {}, number_node(zoom_ratio / sigmas.zoom_ratio)}},
          {}};
}

Node step_nodes(const std::vector<RigStep>& steps) {
  Node::Array list;
  for (const RigStep& step : steps) {
    Node::Table entry{{"time", {}, number_node(step.time)},
                      {"looks", {}, whole(step.looks)},
                      {"found", {}, {step.is_found, {}}},
                      {"rms", {}, number_node(step.rms)}};
    if (!step.is_found) entry.push_back({"reason", {}, {step.reason, {}}});
    if (step.is_found) entry.push_back({"sigma", {}, sigma_node(step.sigmas)});
    if (step.remainder) entry.push_back({"would_remain", {}, remainder_node(*step.remainder)});
    list.push_back({std::move(entry), {}});
  }
  return {std::move(list), {}};
}

Node undetermined_nodes(const RigObservability& seen) {
  Node::Array list;
  for (const UnobservableDirection& blind : seen.unobservable)
    list.push_back(
        {Node::Table{{"share_left", {}, number_node(blind.share)}, {"what", {}, {blind.words, {}}}}, {}});
  return {std::move(list), {}};
}

Node stance_node(const std::string& name, const RigStance& stance) {
  return {Node::Table{{"camera", {}, {name, {}}},
                      {"pan", {}, number_node(stance.head.pan)},
                      {"tilt", {}, number_node(stance.head.tilt)},
                      {"zoom", {}, number_node(stance.head.zoom)},
                      {"stage", {}, point_node(stance.stage.offset)}},
          {}};
}

Node decision_nodes(const LoopResult& result, const CalibrationRun& run) {
  Node::Array list;
  for (const LoopDecision& step : result.steps)
    list.push_back({Node::Table{{"time", {}, number_node(step.time)},
                                {"looks", {}, whole(step.looks)},
                                {"camera", {}, {run.nominal.cameras[step.camera].name, {}}},
                                {"step", {}, {step.step, {}}},
                                {"offset", {}, number_node(step.offset)},
                                {"accepted", {}, number_node(step.accepted)},
                                {"unit", {}, {step.unit, {}}},
                                {"next", {}, {step.next, {}}}},
                    {}});
  return {std::move(list), {}};
}

Node arc_nodes(const CalibrationRun& run) {
  Node::Array list;
  for (const CommandedArc& arc : run.arcs) {
    Node::Array rotations, positions;
    for (const double rotation : arc.rotations) rotations.push_back(number_node(rotation));
    Node::Table entry{{"camera", {}, {run.nominal.cameras[arc.ideal.camera].name, {}}},
                      {"plane", {}, {arc.ideal.plane, {}}},
                      {"bends", {}, bends_node(arc.ideal.state)},
                      {"rotations", {}, {std::move(rotations), {}}}};
    if (arc.positions) {
      for (const std::int64_t position : *arc.positions) positions.push_back({position, {}});
      entry.push_back({"positions", {}, {std::move(positions), {}}});
    }
    list.push_back({std::move(entry), {}});
  }
  return {std::move(list), {}};
}

// Returns the members of a calibration by one of the paper's methods.
Node::Table loop_members(const CalibrationRun& run) {
  const LoopResult& result = *run.loop;
  Node::Table members{
      {"name", {}, {run.name, {}}},
      {"done", {}, {result.is_done, {}}},
      {"pictures", {}, {Node::Array{whole(result.pictures[0]), whole(result.pictures[1])}, {}}}};
  const auto add = [&](const char* key, Node node) { members.push_back({key, {}, std::move(node)}); };
  if (!result.is_done) add("reason", {result.reason, {}});
  if (!run.arcs.empty()) add("arcs", arc_nodes(run));
  add("steps", decision_nodes(result, run));
  Node::Array notes;
  for (const std::string& note : result.notes) notes.push_back({note, {}});
  add("notes", {std::move(notes), {}});
  if (!result.is_done) return members;
  add("target", point_node(result.target));
  if (result.angle) add("angle_from_square_as_seen", number_node(*result.angle));
  if (result.zoom_ratio) add("zoom_ratio_as_seen", number_node(*result.zoom_ratio));
  if (result.roll[0] && result.roll[1])
    add("roll_as_seen", {Node::Array{number_node(*result.roll[0]), number_node(*result.roll[1])}, {}});
  Node::Array points;
  for (const auto& by : result.principal_point)
    points.push_back(by ? Node{Node::Array{number_node(by->x()), number_node(by->y())}, {}} : Node{});
  if (result.principal_point[0] || result.principal_point[1])
    add("principal_point_off_as_seen", {std::move(points), {}});
  if (run.truth) add("remainder_in_truth", remainder_node(*run.truth));
  add("commanded", {Node::Array{stance_node(run.cameras[0], result.stances[0]),
                                stance_node(run.cameras[1], result.stances[1])},
                    {}});
  return members;
}

Node::Table run_members(const CalibrationRun& run) {
  if (run.loop) return loop_members(run);
  const RigSessionResult& result = run.result;
  Node::Table members{
      {"name", {}, {run.name, {}}},
      {"done", {}, {result.is_done, {}}},
      {"looks", {}, whole(result.looks)},
      {"pictures", {}, {Node::Array{whole(result.pictures[0]), whole(result.pictures[1])}, {}}},
      {"markers", {}, whole(result.markers)},
      {"points", {}, whole(result.points)}};
  if (result.etalon_points > 0) members.push_back({"etalon_points", {}, whole(result.etalon_points)});
  if (!result.is_done) members.push_back({"reason", {}, {result.reason, {}}});
  const auto add = [&](const char* key, Node node) { members.push_back({key, {}, std::move(node)}); };
  add("steps", step_nodes(result.steps));
  if (!result.is_done) return members;
  add("rms", number_node(result.found.rms));
  add("sigma", sigma_node(result.steps.back().sigmas));
  add("target", point_node(result.target));
  add("at_start", remainder_node(*result.start_remainder));
  add("remainder", remainder_node(result.remainder));
  if (run.truth) {
    add("remainder_in_truth", remainder_node(*run.truth));
    add("error_over_sigma", error_over_sigma_node(result.remainder, *run.truth, result.steps.back().sigmas));
  }
  add("verified_px", {Node::Array{number_node(result.verified[0]), number_node(result.verified[1])}, {}});
  add("commanded", {Node::Array{stance_node(run.cameras[0], result.desired.stances[0]),
                                stance_node(run.cameras[1], result.desired.stances[1])},
                    {}});
  Node::Array notes, gains;
  for (const std::string& note : result.desired.notes) notes.push_back({note, {}});
  for (const double gain : result.found.model.bend_gains) gains.push_back(number_node(gain));
  add("notes", {std::move(notes), {}});
  add("bend_gains", {std::move(gains), {}});
  add("untold", undetermined_nodes(result.observability));
  return members;
}

// Returns a numbered file name: rig.toml, rig-2.toml, ...
std::filesystem::path numbered(const std::filesystem::path& file, int number) {
  std::filesystem::path result = file;
  result.replace_filename(fmt::format("{}-{}{}", file.stem().string(), number, file.extension().string()));
  return result;
}

bool is_there(const std::filesystem::path& file) {
  return std::filesystem::exists(std::filesystem::symlink_status(file));
}

std::filesystem::path free_name(const std::filesystem::path& file) {
  for (int number = 1;; ++number)
    if (std::filesystem::path other = numbered(file, number); !is_there(other)) return other;
}

bool is_found_rig(const std::filesystem::path& file) {
  constexpr std::size_t most_bytes = 1 << 24;
  try {
    (void)read_as<FoundRigFile>(parse_toml(read_text_file(file, most_bytes), file.string()));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// Writes a file. A previous rig is kept under another name, the oldest under the first number. A file that is
// no rig keeps its name. At any time there is a rig with this name.
void save(const std::filesystem::path& file, const std::string& text) {
  if (!is_there(file)) {
    write_new_file(file, text);
    return;
  }
  if (!is_found_rig(file)) {
    write_new_file(free_name(file), text);
    return;
  }
  const std::filesystem::path kept = free_name(file);
  std::filesystem::copy_file(file, kept);
  try {
    replace_file(file, text);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(kept, ignored);
    throw;
  }
}

}  // namespace

const Table<FoundRigFile>& fields_of(const FoundRigFile*) {
  static const auto table =
      Table<FoundRigFile>("rig", "A calibrated rig that experiments can include.")
          .field("arm", &FoundRigFile::arm, {.meaning = "The arm.", .required = true})
          .field("camera", &FoundRigFile::camera, {.meaning = "The cameras.", .required = true});
  return table;
}

namespace {

void start_at(const std::array<RigStance, 2>& stances, FoundRigFile& file) {
  for (const RigStance& stance : stances) {
    CameraStartConfig& start = file.camera[stance.camera].initial;
    start.pan = stance.head.pan, start.tilt = stance.head.tilt, start.zoom = stance.head.zoom;
    const Eigen::Vector3d& offset = stance.stage.offset;
    start.stage = {offset.x(), offset.y(), offset.z()};
  }
}

std::string file_text(const FoundRigFile& file) {
  return write_toml(Codec<FoundRigFile>::write(file), fields_of(&file).info());
}

// A loop finds no rig. Writes the file's rig, with the cameras' initial positions where they were sent, and
// principal points.
std::string loop_rig_toml(const Setup& setup, const CalibrationRun& run) {
  const LoopResult& result = *run.loop;
  FoundRigFile file{setup.arm, run.found().cameras};
  start_at(result.stances, file);
  return fmt::format(
             "# The rig of the experiment's file. The cameras start at the positions found by a calibration "
             "with {} pictures{}.\n",
             result.pictures[0] + result.pictures[1],
             result.principal_point[0] || result.principal_point[1]
                 ? ", and have the measured principal points"
                 : "") +
         file_text(file);
}

// Sets the lengths as found. For a section of several arcs, a file assumes equal lengths and gives their
// shares of its bend. Their bends and total length are as found.
void set_sections(const RigModel& found, std::vector<Section>& sections) {
  const Actuation actuation = found.arm_model().actuation();
  for (Section& section : sections) {
    section.length = 0;
    if (section.bend_profile) section.bend_profile->clear();
  }
  for (std::size_t arc = 0; arc < actuation.arcs(); ++arc) {
    Section& section = sections[actuation.section_of()[arc]];
    section.length += found.arm.sections[arc].length;
    if (section.bend_profile) section.bend_profile->push_back(std::max(0.0, actuation.share_of(arc)));
  }
}

}  // namespace

std::string found_rig_toml(const Setup& setup, const CalibrationRun& run) {
  if (run.loop) return loop_rig_toml(setup, run);
  FoundRigFile file;
  file.arm = setup.arm;
  const RigModel& found = run.result.found.model;
  // Markers keep their position on each section, whose length differs from the nominal one.
  const Arm nominal = setup.arm_model().shaped();
  const auto moved = [&](double s) {
    const ArmState straight = ArmState::straight(found.arm.sections.size());
    return arc_length_of(found.arm, straight, material_point(nominal, s));
  };
  for (Marker& marker : file.arm.look.marker) marker.at = moved(marker.at);
  for (Disk& disk : file.arm.look.disk) disk.at = moved(disk.at);
  set_sections(found, file.arm.section);
  for (const CameraConfig& camera : found.cameras) file.camera.push_back(camera);
  start_at(run.result.desired.stances, file);
  const RigSigmas& sigmas = run.result.steps.back().sigmas;
  return fmt::format(
             "# Result of a calibration with {} pictures. Standard deviations: {:.3g} deg for the angle "
             "between the axes, {:.2g} %\n# and {:.2g} % for the focal lengths.\n",
             run.result.pictures[0] + run.result.pictures[1], sigmas.angle / degree, 100 * sigmas.focal[0],
             100 * sigmas.focal[1]) +
         file_text(file);
}

void write_rig_file(const Setup& setup, const CalibrationRun& run, const std::string& saved_as,
                    const std::filesystem::path& results) {
  const std::string text = found_rig_toml(setup, run);
  std::filesystem::path file = results / rig_file_name;
  for (int number = 2; is_there(file); ++number) file = numbered(results / rig_file_name, number);
  write_new_file(file, text);
  if (!saved_as.empty()) save(setup.folder / saved_as, text);
}

Node calibration_node(const CalibrationRun& run) { return {run_members(run), {}}; }

}  // namespace flexura
