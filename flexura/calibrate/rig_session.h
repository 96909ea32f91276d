#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/image.h"
#include "flexura/calibrate/arm_picture.h"
#include "flexura/calibrate/rig_aim.h"
#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_commander.h"
#include "flexura/calibrate/rig_observability.h"
#include "flexura/camera/view.h"
#include "flexura/model/stand.h"
#include "flexura/port/rig_ports.h"
#include "flexura/vision/conic.h"

namespace flexura {

/// Required or achieved standard deviations of a rig's quantities.
struct RigSigmas {
  double angle = 0.02 * degree;                  ///< Angle between the axes, rad.
  std::array<double, 2> focal = {0.003, 0.003};  ///< Focal length of each camera, relative.
  double zoom_ratio = 0.003;                     ///< Ratio of the two magnifications, relative.
};

/// Settings of a calibration of two cameras.
struct RigSessionConfig {
  std::array<std::size_t, 2> cameras = {0, 1};  ///< Indices of the front and the side camera in the rig.
  std::vector<ArmState> poses;                  ///< Poses of the arm; at least one.
  ArmPictureConfig picture;  ///< Known properties of the arm's pictures, including its markers.
  std::size_t images =
      /// Maximum number of views. Each view has one picture per camera. The last view verifies the result.
      12;
  std::size_t first = 3;   ///< Number of views from the initial head positions.
  std::size_t fewest = 5;  ///< Smallest number of markers in a useful picture.
  RigSigmas desired;       ///< Standard deviations below which the session takes no further views.
  std::optional<Eigen::Vector3d> target;  ///< Target of the cameras in W, m; default: the arm's middle.
  /// If set, the session observes the calibration cylinder instead of the arm. The session then needs no
  /// markers, and `poses` must have only the arm's present pose. The default target is then the cylinder's
  /// middle. Views begin with the shortest focal length.
  std::optional<EtalonConfig> etalon;
  /// Bright screens behind the cylinder. The session prefers views in which a screen fills the pictures.
  std::vector<ScreenConfig> screens = {};
  bool may_use_stages = true;  ///< Whether stages may move.
  /// Focal lengths of the views, relative to the initial focal length.
  std::vector<double> zooms = {1, 2.5};
  /// Range of stage positions in each direction, as a share of the camera's distance from the target. The
  /// stage's travel also limits this range.
  double slide = 0.15;
  double move_duration = 2;  ///< Duration of a move of the arm to a pose or back, s.
  double search = 0.2;  ///< Range of head turns in the search for an arm that is not visible at first, rad.
  RigPatience patience;
};

/// A quantity measured in a picture.
struct SeenValue {
  std::string name;  ///< Name with unit, such as "white left, px".
  double value = 0;
};

/// One picture and its observations.
struct CameraObservation {
  std::size_t look = 0;  ///< Number of the view, from 1; 0 during the search for the arm.
  RigStance stance;      ///< Measured camera stance.
  ArmState pose;         ///< Arm pose as measured by the drives.
  Frame frame;           ///< The picture and its time.
  SeenArm seen;
  std::vector<SeenValue> values;    ///< Measurements of the paper's methods (loop_session.h).
  std::optional<CircleFit> circle;  ///< Circle through the points; only for LoopMethod::arcs_paper.
};

/// State of the estimate after a view.
struct RigStep {
  double time = 0;           ///< Time, s.
  std::size_t looks = 0;     ///< Number of views so far.
  bool is_found = false;     ///< Whether a rig was found that explains the observations so far.
  std::string reason;        ///< Why no rig was found.
  double rms = 0;            ///< Root mean square of the residuals, in standard deviations.
  std::size_t outliers = 0;  ///< Number of excluded outliers (RigCalibration::outliers).
  double angle = 0;          ///< Estimated angle between the axes in the `desired` positions, rad.
  std::array<double, 2> focal = {0, 0};  ///< Estimated focal lengths at ratio 1, px.
  RigSigmas sigmas;                      ///< Present standard deviations.
  std::array<RigStance, 2> desired;      ///< Positions that would be commanded with this estimate.
  /// Deviation in the `desired` positions, according to the final estimate.
  std::optional<RigRemainder> remainder;
  std::string next;  ///< Next view and its reason.
};

/// Result of a picture in one of the paper's methods (loop_session.h).
struct LoopDecision {
  double time = 0;                  ///< Time, s.
  std::size_t looks = 0;            ///< Number of pictures of all cameras so far.
  std::size_t camera = 0;           ///< Index in the rig.
  std::string step;                 ///< "horizontal orientation", ...
  double offset = 0, accepted = 0;  ///< Measured offset and its tolerance.
  std::string unit;                 ///< Unit of `offset` and `accepted`.
  std::string next;                 ///< Next action in words.
};

/// The ideal arc of the arm for a camera, computed with the simulator (steps 1, 2 and 7 of section 3.4 of the
/// paper). The camera's pictures are compared with this arc.
struct IdealArc {
  double time = 0;              ///< Time of the computation, s.
  std::size_t camera = 0;       ///< Index of the camera in the rig.
  std::string plane;            ///< "XOY" or "ZOY".
  ArmState state;               ///< Bends of the sections.
  View view;                    ///< The ideal camera.
  Image<std::uint8_t> picture;  ///< The ideal image, gray.
};

/// Receives the events of a session. A receiver cannot change the session, but can cancel it.
class RigSessionWatcher {
 public:
  virtual ~RigSessionWatcher() = default;
  RigSessionWatcher() = default;
  RigSessionWatcher(const RigSessionWatcher&) = delete;
  RigSessionWatcher& operator=(const RigSessionWatcher&) = delete;

  /// Called after the arm was commanded to reach `state` in `duration` s. `time`: time of the command, s of
  /// the rig's clock.
  virtual void arm_sent(double time, const ArmState& state, double duration) = 0;
  /// Called after the head and stage of a camera were commanded to a stance. `time`: time of the command, s
  /// of the rig's clock.
  virtual void camera_sent(double time, const RigStance& stance) = 0;
  /// Called after a picture was taken and measured.
  virtual void seen(const CameraObservation& observed) = 0;
  /// Called after a view, with the updated least-squares estimate (calibrate_rig_in_session).
  virtual void known(const RigStep& step) = 0;
  /// Called after one of the paper's methods computed an ideal arc (calibrate_by_loop).
  virtual void planned(const IdealArc& /*arc*/) {}
  /// Called after one of the paper's methods made a decision (calibrate_by_loop).
  virtual void decided(const LoopDecision& /*decision*/) {}
  /// Returns true to end the session early.
  virtual bool is_cancelled() { return false; }
};

/// Result of a session.
struct RigSessionResult {
  bool is_done = false;
  std::string reason;          ///< Why the session failed, and the final state of the rig.
  std::vector<RigStep> steps;  ///< One step for each view after which an estimate was made.
  std::size_t looks = 0;       ///< Number of views, counted as in RigSessionConfig::images.
  /// Number of pictures by camera, including those of the search.
  std::array<std::size_t, 2> pictures = {0, 0};
  RigCalibration found;  ///< Estimate from all pictures.
  /// Numbers of markers, axis points and cylinder points in all pictures.
  std::size_t markers = 0, points = 0, etalon_points = 0;
  RigObservability observability;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< Target of the cameras in W, m.
  std::array<RigStance, 2> start;                    ///< Initial positions.
  /// Deviation that would have remained after commands computed with the initial model, and deviation of the
  /// initial positions.
  std::optional<RigRemainder> nominal_remainder, start_remainder;
  DesiredRig desired;      ///< Commands for the required configuration.
  RigRemainder remainder;  ///< Estimated deviation after these commands.
  /// Prediction error of each camera in the last view, root mean square, px. The prediction does not use the
  /// pictures of this view.
  std::array<double, 2> verified = {0, 0};
  std::array<std::optional<CameraObservation>, 2> before,
      after;  ///< The first and the last picture of each camera.
};

/// Calibrates two cameras of a rig and moves them to the required configuration (section 3.4 of the paper;
/// docs/calibration.md). The arm moves into several poses, and each camera takes pictures of the arm.
/// Alternatively, the cameras take pictures of the calibration cylinder. The rig is estimated from these
/// pictures. Each next view is the most informative one within the limits of heads, stages and lenses. When
/// the estimate is accurate enough, heads and stages move once to the required configuration. There both
/// cameras look at the target along orthogonal axes with equal zoom. A last view verifies the configuration.
/// Between poses, the arm passes through its initial shape. An error ends the session: heads, stages and arm
/// return to the start, and the result states the reason. The session uses only the ports. Equal rigs,
/// readings and pictures give equal results. Throws std::invalid_argument if poses or markers are missing, if
/// `images` is below 3, or if `first` is 0. Also throws std::invalid_argument if both cameras are the same,
/// or if the ports lack cameras of the model.
[[nodiscard]] RigSessionResult calibrate_rig_in_session(const RigPorts& ports, const RigModel& nominal,
                                                        const RigPrior& prior, const RigSessionConfig& config,
                                                        RigSessionWatcher& watcher);

}  // namespace flexura
