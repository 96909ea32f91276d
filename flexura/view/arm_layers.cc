#include "flexura/view/arm_layers.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "flexura/vision/axis_points.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/conic.h"
#include "flexura/vision/markers.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"

namespace flexura {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

constexpr std::array<std::string_view, 5> layer_ids = {"mask", "silhouette", "axis", "markers", "circle"};

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
std::optional<std::uint32_t> component_of(const Components& components, const ArmObservation& arm,
                                          const PixelBox& box) {
  std::vector<std::size_t> votes(components.list.size());
  for (const AxisSample& sample : arm.axis) {
    const Run* run = components.run_at(static_cast<int>(std::lround(sample.pixel.x())) - box.left,
                                       static_cast<int>(std::lround(sample.pixel.y())) - box.top);
    if (run != nullptr) ++votes[run->component];
  }
  const auto most = std::ranges::max_element(votes);
  if (most == votes.end() || *most == 0) return std::nullopt;
  return static_cast<std::uint32_t>(most - votes.begin());
}

// Finds the figures of a picture in the part in which the arm was searched.
PixelBox find_figures(const FoundArm& found, Components& components) {
  BlockThresholds blocks;
  if (found.scene == nullptr) {
    (void)segment(gray_picture(found.bytes), {}, components, blocks);
    return {};
  }
  const ScenePart part = part_in_scene(*found.scene, found.bytes);
  ThresholdConfig config;
  if (part.has_matte) config.figure = Figure::bright;
  constexpr std::size_t all = 1U << 30U;
  const Image<std::uint8_t>* inside = part.inside.values().empty() ? nullptr : &part.inside;
  (void)segment(part.has_matte ? part.figures : part.filled, config, components, blocks, all, inside);
  return part.box;
}

void add_mask(const FoundArm& found, Node::Array& layers) {
  Components components;
  const PixelBox box = find_figures(found, components);
  const auto component = component_of(components, found.arm, box);
  if (!component) return;
  Node::Array rows;
  for (const Run& run : components.runs) {
    if (run.component != *component) continue;
    const auto number = [](int value) { return Node{static_cast<std::int64_t>(value), {}}; };
    rows.push_back(
        {Node::Array{number(run.v + box.top), number(run.first + box.left), number(run.last - 1 + box.left)},
         {}});
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

// The centerline as it is drawn, and its samples for the circle.
struct DrawnAxis {
  std::vector<AxisSample> shown, fitted;
};

DrawnAxis axis_of(const FoundArm& found, std::vector<std::string>& notes) {
  if (!found.view) return {found.arm.axis, found.arm.axis};
  BackboneAxis axis = backbone_axis(found.view->lens, found.arm.axis);
  if (!axis.is_whole()) notes.emplace_back(middle_in_places);
  std::vector<AxisSample> known = axis.known();
  if (known.empty()) known = axis.samples;
  return {std::move(axis.samples), std::move(known)};
}

// Adds the circle through the centerline, unless it is so large that it looks like a straight line.
void add_circle(const FoundArm& found, const std::vector<AxisSample>& axis, Node::Array& layers) {
  constexpr double largest = 20;  // Multiple of the picture's width.
  const AxisPoints points = independent_points(axis);
  const std::optional<CircleFit> circle = fit_circle(points.pixels, points.sigma);
  if (!circle || !circle->is_curved() || circle->radius > largest * found.bytes.width()) return;
  layers.push_back(layer("circle", "ellipse",
                         {{"center", {}, shown(circle->center)},
                          {"axes", {}, {Node::Array{shown(circle->radius), shown(circle->radius)}, {}}},
                          {"angle", {}, {0.0, {}}},
                          {"rms", {}, number_node(circle->rms)},
                          {"verified", {}, {circle->is_circle(), {}}}}));
}

}  // namespace

std::span<const std::string_view> layer_names() { return layer_ids; }

Node::Array arm_layers(const FoundArm& found, const std::vector<std::string>& layers,
                       std::vector<std::string>& notes) {
  Node::Array drawn;
  if (!found.arm.is_found()) return drawn;
  const auto is_requested = [&](std::string_view name) { return std::ranges::count(layers, name) > 0; };
  const DrawnAxis axis = axis_of(found, notes);
  Points points;
  for (const AxisSample& sample : axis.shown) points.push_back(sample.pixel);
  if (is_requested("mask")) add_mask(found, drawn);
  if (is_requested("silhouette")) add_silhouette(found.arm, drawn);
  if (is_requested("axis")) drawn.push_back(line("axis", points));
  if (is_requested("circle")) add_circle(found, axis.fitted, drawn);
  if (is_requested("markers")) add_markers(found, axis.shown, drawn, notes);
  return drawn;
}

}  // namespace flexura
