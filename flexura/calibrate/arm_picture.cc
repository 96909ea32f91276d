#include "flexura/calibrate/arm_picture.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <variant>

#include "flexura/calibrate/eight_bits.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/model/backbone.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/markers.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

// Of where bands are found along the arm, whatever the noise, px: nine of ten within 0.36
// (docs/studies/seeing.md).
constexpr double least_marker_sigma = 0.2;

MarkerScene scene_of(const ArmSighting& arm, const std::vector<MarkerSighting>& markers) {
  MarkerScene scene;
  for (const MarkerSighting& marker : markers) {
    // What is no band has no middle that is known well, and what may be two is neither.
    auto& place = scene.markers.emplace_back();
    if (marker.is_band && !marker.may_be_merged) place = MarkerScene::Place{marker.pixel, marker.color};
  }
  constexpr double whole = 0.95;  // Of the silhouette: what explains less may end at a fold.
  if (arm.covered < whole) return scene;
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
    if (arm.ends[i].kind == AxisEndKind::free) scene.ends[i] = arm.ends[i].pixel;
  return scene;
}

std::vector<CurvePoint> independent_points(const std::vector<AxisSample>& axis,
                                           const ArmPictureConfig& config) {
  std::vector<CurvePoint> points;
  double way = 0, next = 0;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (i > 0) way += (axis[i].pixel - axis[i - 1].pixel).norm();
    const double pitch = std::max(config.spacing, config.spacing_widths * axis[i].width);
    if (i == 0) next = pitch;
    if (way < next || !axis[i].is_seen) continue;
    points.push_back({axis[i].pixel, std::max(axis[i].sigma, config.least_sigma)});
    next = way + pitch;
  }
  // The last one keeps away from the end as the first one does.
  if (!points.empty() && (points.back().pixel - axis.back().pixel).norm() < config.spacing) points.pop_back();
  return points;
}

}  // namespace

MarkerScene expected_markers(const Arm& arm, const ArmState& state, const std::vector<KnownMarker>& markers,
                             const View& view, const Arm& marked) {
  const Backbone backbone(arm, state);
  MarkerScene scene;
  for (const KnownMarker& marker : markers) {
    const double s = arc_length_of(arm, state, material_point(marked, marker.s));
    const auto pixel = view.project(backbone.pose(s).position);
    auto& place = scene.markers.emplace_back();
    if (pixel) place = MarkerScene::Place{*pixel, marker.color};
  }
  scene.ends = {view.project(backbone.pose(0).position), view.project(backbone.tip().position)};
  return scene;
}

SeenArm ArmPicture::see(const Picture& picture, const Lens& lens, const MarkerScene& expected) {
  SeenArm seen;
  const auto find = [&]<typename Value>(const Image<Value>& image) -> const ArmSighting& {
    const Image<Value> gray = image.channels() == 1 ? image : gray_picture(image);
    if constexpr (sizeof(Value) == 1) {
      return finder_.find(gray);
    } else {
      return finder_.find(gray, config_.white);
    }
  };
  ArmSighting arm = std::visit(find, picture);
  if (!arm.is_found()) {
    seen.reason = arm.reason;
    return seen;
  }
  to_backbone_image(lens, arm.axis);
  const Image<std::uint8_t> bytes = eight_bits(picture, config_.white);
  const std::vector<MarkerSighting> markers = find_markers(bytes, arm).markers;
  const MarkerMatch match = match_markers(expected, scene_of(arm, markers), {bytes.width(), bytes.height()});
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (!match.markers[i]) {
      ++seen.unknown;
      continue;
    }
    seen.markers.push_back({markers[i].pixel, config_.markers[*match.markers[i]].s,
                            std::max(markers[i].sigma, least_marker_sigma)});
  }
  if (seen.markers.empty()) seen.reason = "none of the arm's markers is recognised";
  if (match.is_reversed) std::ranges::reverse(arm.axis);
  seen.points = independent_points(arm.axis, config_);
  return seen;
}

}  // namespace flexura
