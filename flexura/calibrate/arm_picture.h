#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/calibrate/marker_match.h"
#include "flexura/calibrate/marker_vote.h"
#include "flexura/camera/view.h"
#include "flexura/estimate/sighting.h"
#include "flexura/model/arm.h"
#include "flexura/port/camera_port.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/markers.h"

namespace flexura {

/// What is known of an arm and of its pictures beforehand.
struct ArmPictureConfig {
  std::vector<KnownMarker> markers;  ///< Of the arm, base first.
  int white = 255;                   ///< The largest value of a picture.
};

/// What is seen of an arm in one picture before anybody asks which of its markers is which.
struct ArmFigure {
  std::vector<AxisSample> axis;
  std::vector<MarkerSighting> markers;  ///< Along the axis.
  MarkerScene scene;                    ///< Those of them, and those ends of the arm, that can be recognised.
  std::array<int, 2> size = {0, 0};     ///< Of the picture, px.
  std::string reason;                   ///< Why there is no arm; "" when there is.
};

/// What is seen of an arm in one picture, its markers recognised.
struct SeenArm {
  std::vector<SeenMarker> markers;
  std::vector<CurvePoint> points;  ///< Of the backbone, from base to tip, independent of each other.
  std::size_t unknown = 0;         ///< Markers that were seen and not recognised.
  std::string reason;              ///< Why there are no markers; "" when there are.
};

/// Where an arm's markers and ends are if the arm and the view are as believed; nothing is seen yet. The
/// markers' places are told along `marked`: the same arm, whose sections may have been taken for longer or
/// shorter.
[[nodiscard]] MarkerPicture marker_picture(const Arm& arm, const ArmState& state,
                                           const std::vector<KnownMarker>& markers, const View& view,
                                           const Arm& marked);
/// Where they are to be seen.
[[nodiscard]] MarkerScene expected_markers(const Arm& arm, const ArmState& state,
                                           const std::vector<KnownMarker>& markers, const View& view,
                                           const Arm& marked);
[[nodiscard]] inline MarkerScene expected_markers(const Arm& arm, const ArmState& state,
                                                  const std::vector<KnownMarker>& markers, const View& view) {
  return expected_markers(arm, state, markers, view, arm);
}

/// How many of them are inside the picture, so many px from its border at least.
[[nodiscard]] std::size_t markers_inside(const MarkerScene& scene, const View& view, double margin);

/// Markers and axis points of a look, when it is known which marker is which. `lens` corrects for what a wide
/// tube shows of itself (vision/backbone_image.h).
[[nodiscard]] SeenArm recognised(const ArmFigure& look, const MarkerMatch& match, const Lens& lens,
                                 const ArmPictureConfig& config);

/// Measures pictures of an arm. The same picture and expectation give the same answer, whatever was seen
/// before.
class ArmPicture {
 public:
  explicit ArmPicture(ArmPictureConfig config) : config_(std::move(config)) {}

  [[nodiscard]] ArmFigure look(const Picture& picture);
  /// The same, and which marker is which by what is expected in this picture alone.
  [[nodiscard]] SeenArm see(const Picture& picture, const Lens& lens, const MarkerScene& expected);

 private:
  ArmPictureConfig config_;
  ArmFinder finder_;
};

}  // namespace flexura
