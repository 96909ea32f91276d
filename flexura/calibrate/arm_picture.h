#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/calibrate/marker_match.h"
#include "flexura/calibrate/marker_vote.h"
#include "flexura/camera/view.h"
#include "flexura/estimate/observation.h"
#include "flexura/model/arm.h"
#include "flexura/port/camera_port.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/markers.h"

namespace flexura {

/// Known properties of an arm and its pictures.
struct ArmPictureConfig {
  std::vector<KnownMarker> markers;  ///< Markers of the arm, ordered from base to tip.
  int white = 255;                   ///< Largest pixel value.
  /// What separates the arm from its surroundings, by index of the camera in the rig; empty or null:
  /// brightness alone.
  std::vector<std::shared_ptr<const ArmScene>> scenes = {};
};

/// The measured arm in one picture, before its markers are identified.
struct ArmFigure {
  std::vector<AxisSample> axis;
  std::vector<MarkerObservation> markers;  ///< Markers in order along the centerline.
  MarkerScene scene;                       ///< Markers and arm ends that can be identified.
  std::array<int, 2> size = {0, 0};        ///< Size of the picture, px.
  std::string reason;                      ///< Why no arm was found, or "".
};

/// The measured arm in one picture, with its markers identified.
struct SeenArm {
  std::vector<SeenMarker> markers;
  std::vector<CurvePoint> points;  ///< Points of the backbone, base to tip, with independent errors.
  std::size_t unknown = 0;         ///< Number of detected markers that were not identified.
  std::string reason;              ///< Why no markers were identified, or "".
};

/// Predicts where the markers and ends of an arm appear, for the modelled arm and view. Marker positions are
/// arc lengths on `marked`: the arm with nominal section lengths, which may differ from those of `arm`.
[[nodiscard]] MarkerPicture marker_picture(const Arm& arm, const ArmState& state,
                                           const std::vector<KnownMarker>& markers, const View& view,
                                           const Arm& marked);
/// Returns the predicted markers and ends as a MarkerScene.
[[nodiscard]] MarkerScene expected_markers(const Arm& arm, const ArmState& state,
                                           const std::vector<KnownMarker>& markers, const View& view,
                                           const Arm& marked);
[[nodiscard]] inline MarkerScene expected_markers(const Arm& arm, const ArmState& state,
                                                  const std::vector<KnownMarker>& markers, const View& view) {
  return expected_markers(arm, state, markers, view, arm);
}

/// Returns the number of markers inside the picture, at least `margin` px from its border.
[[nodiscard]] std::size_t markers_inside(const MarkerScene& scene, const View& view, double margin);

/// Returns markers and centerline points of a picture whose markers are matched. `lens` is needed to correct
/// the centerline of a wide tube (vision/backbone_image.h).
[[nodiscard]] SeenArm recognised(const ArmFigure& look, const MarkerMatch& match, const Lens& lens,
                                 const ArmPictureConfig& config);

/// Measures pictures of an arm. A result does not depend on earlier pictures.
class ArmPicture {
 public:
  /// `camera`: index of the camera in the rig.
  ArmPicture(ArmPictureConfig config, std::size_t camera);

  [[nodiscard]] ArmFigure look(const Picture& picture);
  /// Finds the arm, and identifies its markers by comparison with the expected scene.
  [[nodiscard]] SeenArm see(const Picture& picture, const Lens& lens, const MarkerScene& expected);

 private:
  ArmPictureConfig config_;
  ArmFinder finder_;
};

}  // namespace flexura
