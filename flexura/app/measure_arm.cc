#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/app/measure_job.h"
#include "flexura/base/table.h"
#include "flexura/vision/axis_points.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/markers.h"
#include "flexura/vision/picture_hints.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

Node end_node(const AxisEnd& end) {
  return TableMaker()
      .add("kind", text_node(name_of(end.kind)))
      .add("at", pixel_pair(end.pixel))
      .add("bulge", number_node(px(end.bulge)))
      .take();
}

Node marker_node(const MarkerObservation& marker) {
  Node::Array color;
  for (int c = 0; c < 3; ++c) color.push_back(number_node(std::round(marker.color[c])));
  return TableMaker()
      .add("at", pixel_pair(marker.pixel))
      .add("along", number_node(px(marker.along)))
      .add("aside", number_node(px(marker.aside)))
      .add("length", number_node(px(marker.length)))
      .add("sigma", number_node(marker.sigma))
      .add("kind", text_node(marker.is_band ? "band" : "spot"))
      .add("color", {std::move(color), {}})
      .add("may_be_merged", {marker.may_be_merged, {}})
      .take();
}

// The centerline of the arm in a picture. With a lens it is the image of the backbone, elsewhere the middle
// of the tube.
struct MeasuredAxis {
  // `fitted`: the samples for circles and ellipses; only the backbone's image if it is known.
  std::vector<AxisSample> shown, fitted;
  std::vector<bool> is_backbone;  // Whether a sample is the backbone's image; empty: none is.

  // Returns whether a sample has a known error. Bridged samples between visible ones do not, nor do those
  // where the lens has no rays.
  [[nodiscard]] bool is_known(std::size_t i) const {
    return shown[i].is_seen && (is_backbone.empty() || is_backbone[i]);
  }
};

MeasuredAxis axis_of(const ArmObservation& arm, const std::optional<Lens>& lens,
                     std::vector<std::string>& notes) {
  if (!lens || !arm.is_found()) return {arm.axis, arm.axis, {}};
  BackboneAxis axis = backbone_axis(*lens, arm.axis);
  if (!axis.is_whole()) notes.emplace_back(middle_in_places);
  std::vector<AxisSample> known = axis.known();
  if (known.empty()) return {arm.axis, arm.axis, {}};
  return {std::move(axis.samples), std::move(known), std::move(axis.is_backbone)};
}

void add_axis(const Job& job, const MeasuredAxis& axis, const std::optional<Lens>& lens) {
  Node::Array points, widths, sigmas, seen;
  for (std::size_t i = 0; i < axis.shown.size(); ++i) {
    const AxisSample& sample = axis.shown[i];
    points.push_back(pixel_pair(sample.pixel));
    widths.push_back(number_node(px(sample.width)));
    sigmas.push_back(axis.is_known(i) ? number_node(rounded(sample.sigma, 1e4)) : Node{});
    seen.push_back({sample.is_seen, {}});
  }
  job.answer.add("axis_kind", text_node(axis.is_backbone.empty() ? "middle" : "backbone"))
      .add("axis", {std::move(points), {}})
      .add("width", {std::move(widths), {}})
      .add("sigma", {std::move(sigmas), {}})
      .add("seen", {std::move(seen), {}});
  if (axis.is_backbone.empty() || !job.config.radius) return;
  const std::vector<double> found = backbone_depths(*lens, axis.shown, *job.config.radius);
  Node::Array depths;
  for (std::size_t i = 0; i < found.size(); ++i)
    depths.push_back(axis.is_backbone[i] ? number_node(rounded(found[i], 1e6)) : Node{});
  job.answer.add("depth", {std::move(depths), {}});
}

void draw_arm(Canvas& canvas, const ArmObservation& arm, const std::vector<AxisSample>& axis,
              const std::vector<MarkerObservation>& markers) {
  for (std::size_t i = 0; i + 1 < arm.axis.size(); ++i) {
    const AxisSample &a = arm.axis[i], &b = arm.axis[i + 1];
    canvas.line(axis[i].pixel, axis[i + 1].pixel, axis_color);
    if (!a.is_seen || !b.is_seen) continue;
    for (const double side : {0.5, -0.5})
      canvas.line(a.pixel + side * a.width * a.normal, b.pixel + side * b.width * b.normal, border_color);
  }
  for (const MarkerObservation& marker : markers) canvas.cross(marker.pixel, 4, marker_color);
  canvas.cross(arm.ends[0].pixel, 7, fit_color);
}

}  // namespace

bool measure_arm(const Job& job) {
  ArmFinder finder(job.config.finder);
  const ArmObservation& arm = finder.find(job.photograph);
  add_threshold(arm.threshold, job.answer);
  std::optional<Lens> lens;
  if (job.config.camera) lens = job.config.camera->lens();
  std::vector<std::string> notes = arm.notes;
  const MeasuredAxis axis = axis_of(arm, lens, notes);
  ArmObservation corrected = arm;
  corrected.axis = axis.shown;
  MarkerObservations markers;
  if (arm.is_found()) markers = find_markers(job.photograph.bytes, corrected);
  const bool is_found = arm.is_found() && (job.config.what == MeasureTarget::arm || !markers.markers.empty());
  job.answer.add("found", {is_found, {}});
  if (arm.is_found()) job.answer.add("trusted", {!arm.contradicts, {}});
  if (!is_found) job.answer.add("reason", text_node(arm.is_found() ? "the arm has no markers" : arm.reason));
  if (!job.photograph.is_mask)
    if (auto note = hint_of_exposure(job.gray)) notes.push_back(std::move(*note));
  // A camera with a given size has already been checked against the picture.
  if (lens && !job.config.camera->size)
    if (auto note = hint_of_size(*lens, job.gray.width(), job.gray.height()))
      notes.push_back(std::move(*note));
  notes.insert(notes.end(), markers.notes.begin(), markers.notes.end());
  job.answer.add("notes", texts_node(notes));
  if (!arm.is_found()) return false;
  job.answer.add("base", end_node(arm.ends[0])).add("tip", end_node(arm.ends[1]));
  job.answer.add("blur", number_node(arm.blur))
      .add("noise", number_node(arm.noise))
      .add("contrast", number_node(arm.contrast));
  Node::Array marker_nodes;
  for (const MarkerObservation& marker : markers.markers) marker_nodes.push_back(marker_node(marker));
  if (job.config.what == MeasureTarget::arm) {
    add_axis(job, axis, lens);
    const AxisPoints points = independent_points(axis.fitted);
    job.answer.add("markers", {std::move(marker_nodes), {}})
        .add("circle", circle_node(fit_circle(points.pixels, points.sigma)))
        .add("ellipse", ellipse_node(fit_ellipse(points.pixels)));
  } else {
    job.answer.add("markers", {std::move(marker_nodes), {}});
  }
  if (job.canvas != nullptr) draw_arm(*job.canvas, arm, axis.shown, markers.markers);
  return is_found;
}

}  // namespace flexura
