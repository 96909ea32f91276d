#include "flexura/calibrate/arm_picture.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "flexura/kinematics/spatial.h"
#include "flexura/model/backbone.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

// Standard deviation of band positions along the arm without noise, px: nine of ten lie within 0.36
// (docs/studies/seeing.md).
constexpr double least_marker_sigma = 0.2;

MarkerScene scene_of(const ArmObservation& arm, const std::vector<MarkerObservation>& markers) {
  MarkerScene scene;
  for (const MarkerObservation& marker : markers) {
    auto& place = scene.markers.emplace_back();
    if (marker.determines_place()) place = MarkerScene::Place{marker.pixel, marker.color};
  }
  if (!arm.is_whole()) return scene;
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
    if (arm.ends[i].kind == AxisEndKind::free) scene.ends[i] = arm.ends[i].pixel;
  return scene;
}

// Samples the centerline so far apart that errors are independent: one arm width, and at least a minimum in
// px. No point is more precise than the lens is.
std::vector<CurvePoint> spaced_points(const std::vector<AxisSample>& axis) {
  constexpr double spacing = 10, least_sigma = 0.05;
  std::vector<CurvePoint> points;
  double way = 0, next = 0;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (i > 0) way += (axis[i].pixel - axis[i - 1].pixel).norm();
    const double pitch = std::max(spacing, axis[i].width);
    if (i == 0) next = pitch;
    if (way < next || !axis[i].is_seen) continue;
    points.push_back({axis[i].pixel, std::max(axis[i].sigma, least_sigma)});
    next = way + pitch;
  }
  // Keeps the last point as far from the end as the first one.
  if (!points.empty() && (points.back().pixel - axis.back().pixel).norm() < spacing) points.pop_back();
  return points;
}

// Returns the finder's settings for a camera.
ArmFinderConfig finder_config(const ArmPictureConfig& config, std::size_t camera) {
  ArmFinderConfig finding;
  if (camera < config.scenes.size()) finding.scene = config.scenes[camera];
  return finding;
}

}  // namespace

ArmPicture::ArmPicture(ArmPictureConfig config, std::size_t camera)
    : config_(std::move(config)), finder_(finder_config(config_, camera)) {}

MarkerPicture marker_picture(const Arm& arm, const ArmState& state, const std::vector<KnownMarker>& markers,
                             const View& view, const Arm& marked) {
  const Backbone backbone(arm, state);
  MarkerPicture picture{
      .view = view, .markers = {}, .ends = {backbone.pose(0).position, backbone.tip().position}, .seen = {}};
  for (const KnownMarker& marker : markers) {
    const double s = arc_length_of(arm, state, material_point(marked, marker.s));
    picture.markers.push_back({backbone.pose(s).position, marker.color});
  }
  return picture;
}

MarkerScene expected_markers(const Arm& arm, const ArmState& state, const std::vector<KnownMarker>& markers,
                             const View& view, const Arm& marked) {
  return expected_scene(marker_picture(arm, state, markers, view, marked), {});
}

std::size_t markers_inside(const MarkerScene& scene, const View& view, double margin) {
  return static_cast<std::size_t>(std::ranges::count_if(scene.markers, [&](const auto& place) {
    return place && place->pixel.minCoeff() >= margin && place->pixel.x() <= view.width - 1 - margin &&
           place->pixel.y() <= view.height - 1 - margin;
  }));
}

ArmFigure ArmPicture::look(const Picture& picture) {
  const ArmObservation& arm = finder_.find(picture, config_.white);
  ArmFigure look;
  if (!arm.is_found()) {
    look.reason = arm.reason;
    return look;
  }
  const Image<std::uint8_t> bytes = eight_bits(picture, config_.white);
  look.axis = arm.axis;
  // Along the centerline as seen: the lens that would correct it is known only after identification.
  look.markers = find_markers(bytes, arm).markers;
  look.scene = scene_of(arm, look.markers);
  look.size = {bytes.width(), bytes.height()};
  return look;
}

SeenArm recognised(const ArmFigure& look, const MarkerMatch& match, const Lens& lens,
                   const ArmPictureConfig& config) {
  SeenArm seen;
  seen.reason = look.reason;
  if (!look.reason.empty()) return seen;
  for (std::size_t i = 0; i < look.markers.size(); ++i) {
    const MarkerObservation& marker = look.markers[i];
    // Where the lens has no ray there is no point of the arm and no usable marker.
    if (!lens.unproject(marker.pixel)) continue;
    if (match.markers[i]) {
      seen.markers.push_back(
          {marker.pixel, config.markers[*match.markers[i]].s, std::max(marker.sigma, least_marker_sigma)});
    } else {
      ++seen.unknown;
    }
  }
  if (seen.markers.empty()) seen.reason = "no marker of the arm was identified";
  std::vector<AxisSample> axis = backbone_axis(lens, look.axis).known();
  if (match.is_reversed) std::ranges::reverse(axis);
  seen.points = spaced_points(axis);
  return seen;
}

SeenArm ArmPicture::see(const Picture& picture, const Lens& lens, const MarkerScene& expected) {
  const ArmFigure seen = look(picture);
  return recognised(seen, match_markers(expected, seen.scene, seen.size), lens, config_);
}

}  // namespace flexura
