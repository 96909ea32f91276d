#include "flexura/view/seen_arm.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <iterator>
#include <memory>
#include <string_view>
#include <utility>

#include "flexura/base/image.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/estimate/picture_observation.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_hint.h"
#include "flexura/rig/seeing_config.h"
#include "flexura/view/answers.h"
#include "flexura/view/arm_layers.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/eight_bits.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/picture_hints.h"

namespace flexura {
namespace {

// Returns what the experiment says about the arm's surroundings ([[seeing]]). The files of a recording may be
// missing.
std::shared_ptr<const ArmScene> scene_of(const ViewedRig& rig, std::size_t camera,
                                         std::vector<std::string>& notes) {
  try {
    return arm_scenes(rig.experiment).at(camera);
  } catch (const InputError& error) {
    notes.push_back(fmt::format("[[seeing]] is not used: {}", error.problems().front().what));
    return nullptr;
  }
}

FoundArm find_arm(const ViewedRig& rig, const SeenPicture& seen, const SeeingChoice* choice) {
  FoundArm found{.bytes = eight_bits(*seen.picture, seen.white),
                 .view = rig.nominal_view(seen.camera, seen.reading)};
  ArmFinderConfig config;
  config.base = found.view->project(rig.model.driven().X_WB.position);
  std::vector<std::string> notes;
  found.scene = scene_of(rig, seen.camera, notes);
  if (choice != nullptr) {
    found.scene = chosen_scene(found.scene, *choice);
    if (choice->base) config.base = Eigen::Vector2d(choice->base->data());
  }
  config.scene = found.scene;
  ArmFinder finder(config);
  found.arm = finder.find(*seen.picture, seen.white);
  std::ranges::move(notes, std::back_inserter(found.arm.notes));
  if (auto note = hint_of_exposure(gray_picture(found.bytes))) found.arm.notes.push_back(std::move(*note));
  return found;
}

Node::Table outcome(bool is_found, const std::string& reason, const std::vector<std::string>& notes) {
  return {{"found", {}, {is_found, {}}}, {"reason", {}, text_node(reason)}, {"notes", {}, texts_node(notes)}};
}

// Returns the shape prior from the rig's file.
ShapePrior prior_of(const ViewedRig& rig) {
  ShapePrior prior = described_arm(rig.model.shaped());
  for (const Marker& marker : rig.experiment.arm.look.markers(rig.model.driven()))
    prior.markers.push_back(marker.at);
  std::ranges::sort(prior.markers);
  return prior;
}

Node answer_of(const FoundArm& found, std::int64_t number, const std::vector<std::string>& layers) {
  std::vector<std::string> notes = found.arm.notes;
  Node::Array drawn = arm_layers(found, layers, notes);
  Node::Table answer = outcome(found.arm.is_found(), found.arm.reason, notes);
  answer.push_back({"number", {}, {number, {}}});
  answer.push_back({"layers", {}, {std::move(drawn), {}}});
  return {std::move(answer), {}};
}

}  // namespace

Node measure_answer(const ViewedRig& rig, const SeenPicture& seen, const std::vector<std::string>& layers,
                    const SeeingChoice* choice) {
  return answer_of(find_arm(rig, seen, choice), seen.number, layers);
}

Node measure_answer(const Photograph& photograph, std::int64_t number, const std::vector<std::string>& layers,
                    const SeeingChoice* choice) {
  FoundArm found{.bytes = photograph.bytes};
  ArmFinderConfig config;
  if (choice != nullptr) {
    found.scene = chosen_scene(nullptr, *choice);
    if (choice->base) config.base = Eigen::Vector2d(choice->base->data());
  }
  config.scene = found.scene;
  ArmFinder finder(config);
  found.arm = finder.find(photograph);
  if (!photograph.is_mask)
    if (auto note = hint_of_exposure(gray_picture(found.bytes))) found.arm.notes.push_back(std::move(*note));
  return answer_of(found, number, layers);
}

Node shape_answer(const ViewedRig& rig, std::span<const SeenPicture> seen,
                  std::span<const CameraSeeingChoice> choices) {
  std::vector<Observation> observations;
  Node::Array numbers;
  std::vector<std::string> notes;
  for (const SeenPicture& picture : seen) {
    const std::string& name = rig.cameras[picture.camera].config().name;
    const auto choice = std::ranges::find(choices, name, &CameraSeeingChoice::camera);
    const FoundArm found = find_arm(rig, picture, choice == choices.end() ? nullptr : &*choice);
    observations.push_back(observation_of(found.arm, *found.view, found.bytes));
    const auto report = [&](std::string_view what) {
      notes.push_back(fmt::format("camera {}: {}", name, what));
    };
    if (!found.arm.is_found()) report(found.arm.reason);
    for (const std::string& note : found.arm.notes) report(note);
    if (observations.back().leaves_out) report(rays_lacking);
    numbers.push_back({picture.number, {}});
  }
  const ShapePrior prior = prior_of(rig);
  const ShapeEstimate estimate = ShapeEstimator(prior).estimate(observations);
  notes.insert(notes.end(), estimate.notes.begin(), estimate.notes.end());
  if (auto hint = hint_of(prior, observations, estimate)) notes.push_back(std::move(*hint));
  Node::Table answer = outcome(estimate.is_found, estimate.reason, notes);
  answer.push_back({"numbers", {}, {std::move(numbers), {}}});
  if (estimate.is_found) {
    answer.push_back(
        {"poses", {}, *backbone_answer(Backbone(estimate.shape.arm, estimate.shape.state)).find("poses")});
    answer.push_back({"bends", {}, bends_answer(estimate.shape.state)});
    answer.push_back({"sigma", {}, number_node(estimate.rms_sigma())});
    answer.push_back({"rms_px", {}, number_node(estimate.rms)});
  }
  return {std::move(answer), {}};
}

}  // namespace flexura
