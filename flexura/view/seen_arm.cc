#include "flexura/view/seen_arm.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
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
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/axis_points.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/conic.h"
#include "flexura/vision/eight_bits.h"
#include "flexura/vision/markers.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/picture_hints.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"

namespace flexura {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

constexpr std::array<std::string_view, 5> names = {"mask", "silhouette", "axis", "markers", "circle"};

// A picture in 8 bits, in which markers are searched, and the detected arm.
struct FoundArm {
  Image<std::uint8_t> bytes;
  View view;
  ArmObservation arm;
};

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

FoundArm find_arm(const ViewedRig& rig, const SeenPicture& seen) {
  FoundArm found{eight_bits(*seen.picture, seen.white), rig.nominal_view(seen.camera, seen.reading), {}};
  ArmFinderConfig config;
  config.base = found.view.project(rig.model.driven().X_WB.position);
  std::vector<std::string> notes;
  config.scene = scene_of(rig, seen.camera, notes);
  ArmFinder finder(config);
  found.arm = finder.find(*seen.picture, seen.white);
  std::ranges::move(notes, std::back_inserter(found.arm.notes));
  if (auto note = hint_of_exposure(gray_picture(found.bytes))) found.arm.notes.push_back(std::move(*note));
  return found;
}

// Rounds to a hundredth of a pixel: a picture on a screen shows no more.
Node shown(double pixels) { return {std::round(100 * pixels) / 100, {}}; }
Node shown(const Vector2d& pixel) { return {Node::Array{shown(pixel.x()), shown(pixel.y())}, {}}; }

Node layer(const char* id, const char* kind, Node::Table members) {
  Node::Table table{{"id", {}, text_node(id)}, {"kind", {}, text_node(kind)}};
  for (Node::Member& member : members) table.push_back(std::move(member));
  return {std::move(table), {}};
}

Node line(const char* id, const Points& points) {
  Node::Array list;
  for (const Vector2d& point : points) list.push_back(shown(point));
  return layer(id, "polyline", {{"points", {}, {std::move(list), {}}}, {"closed", {}, {false, {}}}});
}

// Returns the component that contains most of the centerline.
std::optional<std::uint32_t> component_of(const Components& components, const ArmObservation& arm) {
  std::vector<std::size_t> votes(components.list.size());
  for (const AxisSample& sample : arm.axis) {
    const Run* run = components.run_at(static_cast<int>(std::lround(sample.pixel.x())),
                                       static_cast<int>(std::lround(sample.pixel.y())));
    if (run != nullptr) ++votes[run->component];
  }
  const auto most = std::ranges::max_element(votes);
  if (most == votes.end() || *most == 0) return std::nullopt;
  return static_cast<std::uint32_t>(most - votes.begin());
}

void add_mask(const FoundArm& found, Node::Array& layers) {
  Components components;
  BlockThresholds blocks;
  (void)segment(gray_picture(found.bytes), {}, components, blocks);
  const auto component = component_of(components, found.arm);
  if (!component) return;
  Node::Array rows;
  for (const Run& run : components.runs) {
    if (run.component != *component) continue;
    const auto number = [](int value) { return Node{static_cast<std::int64_t>(value), {}}; };
    rows.push_back({Node::Array{number(run.v), number(run.first), number(run.last - 1)}, {}});
  }
  layers.push_back(layer("mask", "runs", {{"rows", {}, {std::move(rows), {}}}}));
}

// Adds both borders, where they are visible without a gap.
void add_silhouette(const ArmObservation& arm, Node::Array& layers) {
  for (const double side : {0.5, -0.5}) {
    Points points;
    const auto finish = [&] {
      if (points.size() > 1) layers.push_back(line("silhouette", points));
      points.clear();
    };
    for (const AxisSample& sample : arm.axis) {
      if (!sample.is_seen)
        finish();
      else
        points.emplace_back(sample.pixel + side * sample.width * sample.normal);
    }
    finish();
  }
}

void add_markers(const FoundArm& found, const std::vector<AxisSample>& axis, Node::Array& layers,
                 std::vector<std::string>& notes) {
  ArmObservation corrected = found.arm;
  corrected.axis = axis;
  const MarkerObservations markers = find_markers(found.bytes, corrected);
  notes.insert(notes.end(), markers.notes.begin(), markers.notes.end());
  Node::Array points;
  for (const MarkerObservation& marker : markers.markers) points.push_back(shown(marker.pixel));
  layers.push_back(layer("markers", "points", {{"points", {}, {std::move(points), {}}}}));
}

// Adds the circle through the centerline, unless it is so large that it looks like a straight line.
void add_circle(const FoundArm& found, const BackboneAxis& axis, Node::Array& layers) {
  constexpr double largest = 20;  // Multiple of the picture's width.
  const std::vector<AxisSample> known = axis.known();
  const AxisPoints points = independent_points(known.empty() ? axis.samples : known);
  const std::optional<CircleFit> circle = fit_circle(points.pixels, points.sigma);
  if (!circle || !circle->is_curved() || circle->radius > largest * found.view.width) return;
  layers.push_back(layer("circle", "ellipse",
                         {{"center", {}, shown(circle->center)},
                          {"axes", {}, {Node::Array{shown(circle->radius), shown(circle->radius)}, {}}},
                          {"angle", {}, {0.0, {}}},
                          {"rms", {}, number_node(circle->rms)},
                          {"verified", {}, {circle->is_circle(), {}}}}));
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

}  // namespace

std::span<const std::string_view> layer_names() { return names; }

Node measure_answer(const ViewedRig& rig, const SeenPicture& seen, const std::vector<std::string>& layers) {
  const FoundArm found = find_arm(rig, seen);
  const auto is_requested = [&](std::string_view name) { return std::ranges::count(layers, name) > 0; };
  Node::Array drawn;
  std::vector<std::string> notes = found.arm.notes;
  if (found.arm.is_found()) {
    const BackboneAxis backbone = backbone_axis(found.view.lens, found.arm.axis);
    const std::vector<AxisSample>& axis = backbone.samples;
    if (!backbone.is_whole()) notes.emplace_back(middle_in_places);
    Points points;
    for (const AxisSample& sample : axis) points.push_back(sample.pixel);
    if (is_requested("mask")) add_mask(found, drawn);
    if (is_requested("silhouette")) add_silhouette(found.arm, drawn);
    if (is_requested("axis")) drawn.push_back(line("axis", points));
    if (is_requested("circle")) add_circle(found, backbone, drawn);
    if (is_requested("markers")) add_markers(found, axis, drawn, notes);
  }
  Node::Table answer = outcome(found.arm.is_found(), found.arm.reason, notes);
  answer.push_back({"number", {}, {seen.number, {}}});
  answer.push_back({"layers", {}, {std::move(drawn), {}}});
  return {std::move(answer), {}};
}

Node shape_answer(const ViewedRig& rig, std::span<const SeenPicture> seen) {
  std::vector<Observation> observations;
  Node::Array numbers;
  std::vector<std::string> notes;
  for (const SeenPicture& picture : seen) {
    const FoundArm found = find_arm(rig, picture);
    observations.push_back(observation_of(found.arm, found.view, found.bytes));
    const auto report = [&](std::string_view what) {
      notes.push_back(fmt::format("camera {}: {}", rig.cameras[picture.camera].config().name, what));
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
