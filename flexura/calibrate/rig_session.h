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

/// Wanted or achieved standard deviations of a rig's quantities.
struct RigSigmas {
  double angle = 0.02 * degree;                  ///< Angle between the axes, rad.
  std::array<double, 2> focal = {0.003, 0.003};  ///< Focal length of each camera, relative.
  double zoom_ratio = 0.003;                     ///< Ratio of the two magnifications, relative.
};

/// Settings of a calibration of two cameras.
struct RigSessionConfig {
  std::array<std::size_t, 2> cameras = {0, 1};  ///< Indices of the front and the side camera in the rig.
  std::vector<ArmState> poses;                  ///< Poses of the arm; at least one.
  ArmPictureConfig picture;                     ///< Includes the arm's markers.
  std::size_t images =
      12;  ///< Maximum number of looks, with one picture per camera each; the last look verifies the result.
  std::size_t first = 3;   ///< Number of looks from the initial head positions.
  std::size_t fewest = 5;  ///< Fewest markers in a useful picture.
  RigSigmas desired;       ///< Standard deviations at which the session takes no further looks.
  std::optional<Eigen::Vector3d> target;  ///< Target of the cameras in W, m; default: the arm's middle.
  /// If set, the session observes the calibration cylinder instead of the arm. It then needs no markers, the
  /// only pose is the arm's present one, and the default target is the cylinder's middle. Looks begin with
  /// the shortest focal length.
  std::optional<EtalonConfig> etalon;
  /// Bright screens behind the cylinder. Looks whose pictures are filled by a screen are preferred.
  std::vector<ScreenConfig> screens = {};
  bool may_use_stages = true;            ///< Whether stages may move; if not, they stay in place.
  std::vector<double> zooms = {1, 2.5};  ///< Focal lengths of the looks, relative to that at the start.
  double slide = 0.15;  ///< Range of stage positions to both sides, as a share of the camera's distance from
                        ///< the target, within the stage's travel.
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
  std::size_t look = 0;  ///< Number of the look, from 1; 0 during the search for the arm.
  RigStance stance;      ///< Camera stance as read.
  ArmState pose;         ///< Arm pose as measured by the drives.
  Frame frame;           ///< The picture and its time.
  SeenArm seen;
  std::vector<SeenValue> values;    ///< Measurements of the paper's methods (loop_session.h).
  std::optional<CircleFit> circle;  ///< Circle through the points; only for LoopMethod::arcs_paper.
};

/// State of the estimate after a look.
struct RigStep {
  double time = 0;           ///< Time, s.
  std::size_t looks = 0;     ///< Number of looks so far.
  bool is_found = false;     ///< Whether a rig explains the observations so far.
  std::string reason;        ///< Why there is no rig.
  double rms = 0;            ///< Root mean square of the residuals, in standard deviations.
  std::size_t outliers = 0;  ///< Number of excluded outliers (RigCalibration::outliers).
  double angle = 0;          ///< Estimated angle between the axes in the `desired` positions, rad.
  std::array<double, 2> focal = {0, 0};  ///< Estimated focal lengths at ratio 1, px.
  RigSigmas sigmas;                      ///< Present standard deviations.
  std::array<RigStance, 2> desired;      ///< Positions that would be commanded with this estimate.
  /// Deviation in the `desired` positions, according to the final estimate.
  std::optional<RigRemainder> remainder;
  std::string next;  ///< The next look and its reason.
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

/// The ideal arc of the arm, computed with the simulator (steps 1, 2 and 7 of section 3.4). A camera's
/// pictures are compared with this arc.
struct IdealArc {
  double time = 0;              ///< Time of the computation, s.
  std::size_t camera = 0;       ///< Index of the camera in the rig.
  std::string plane;            ///< "XOY" or "ZOY".
  ArmState state;               ///< Bends of the sections.
  View view;                    ///< The ideal camera.
  Image<std::uint8_t> picture;  ///< The ideal image, gray.
};

/// Receives the events of a session. It does not influence the session, except by cancelling it.
class RigSessionWatcher {
 public:
  virtual ~RigSessionWatcher() = default;
  RigSessionWatcher() = default;
  RigSessionWatcher(const RigSessionWatcher&) = delete;
  RigSessionWatcher& operator=(const RigSessionWatcher&) = delete;

  /// The arm was commanded to reach `state` after `duration` s. `time`: time of the command, s of the rig's
  /// clock.
  virtual void arm_sent(double time, const ArmState& state, double duration) = 0;
  /// A head and a stage were commanded to reach a stance. `time`: time of the command, s of the rig's clock.
  virtual void camera_sent(double time, const RigStance& stance) = 0;
  /// A picture was taken and measured.
  virtual void seen(const CameraObservation& observed) = 0;
  /// The least-squares estimate was updated after a look (calibrate_rig_in_session).
  virtual void known(const RigStep& step) = 0;
  /// A loop of the paper's methods computed an ideal arc (calibrate_by_loop).
  virtual void planned(const IdealArc& /*arc*/) {}
  /// A loop of the paper's methods made a decision (calibrate_by_loop).
  virtual void decided(const LoopDecision& /*decision*/) {}
  /// Returns true to end the session early.
  virtual bool is_cancelled() { return false; }
};

/// Result of a session.
struct RigSessionResult {
  bool is_done = false;
  std::string reason;          ///< Why the session failed, and the final state of the rig.
  std::vector<RigStep> steps;  ///< One step for each look after which an estimate was made.
  std::size_t looks = 0;       ///< Number of looks, counted as in RigSessionConfig::images.
  /// Number of pictures by camera, including those of the search.
  std::array<std::size_t, 2> pictures = {0, 0};
  RigCalibration found;                                    ///< Estimate from all pictures.
  std::size_t markers = 0, points = 0, etalon_points = 0;  ///< Numbers of observations in all pictures.
  RigObservability observability;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< Target of the cameras in W, m.
  std::array<RigStance, 2> start;                    ///< Initial positions.
  /// Deviation that commands by the initial model would have left, and deviation of the initial positions.
  std::optional<RigRemainder> nominal_remainder, start_remainder;
  DesiredRig desired;      ///< Required configuration as commanded.
  RigRemainder remainder;  ///< Deviation after the command, as estimated.
  /// Prediction errors in the last look by camera, root mean square, px. The prediction does not use the
  /// pictures of this look.
  std::array<double, 2> verified = {0, 0};
  std::array<std::optional<CameraObservation>, 2> before,
      after;  ///< The first and the last picture of each camera.
};

/// Calibrates two cameras of a rig and moves them to the required configuration (section 3.4 of the paper;
/// docs/calibration.md). The arm moves into several poses, and each camera takes pictures of the arm.
/// Alternatively, the cameras take pictures of the calibration cylinder. The rig is estimated from these
/// pictures. The next look is the most informative one within the limits of heads, stages and lenses. When
/// the estimate is accurate enough, heads and stages move once to the required configuration. There both
/// cameras look at the target along orthogonal axes with equal zoom. A last look verifies the configuration.
/// Between poses the arm passes through its initial shape. An error ends the session: heads, stages and arm
/// return to the start, and the result holds the reason. The session uses only the ports. Equal rigs,
/// readings and pictures give equal results. Throws std::invalid_argument if poses or markers are missing, if
/// there are fewer than 3 images, or none from the initial head positions. Also throws it if both cameras are
/// the same, or the ports are for other cameras than the model's.
[[nodiscard]] RigSessionResult calibrate_rig_in_session(const RigPorts& ports, const RigModel& nominal,
                                                        const RigPrior& prior, const RigSessionConfig& config,
                                                        RigSessionWatcher& watcher);

}  // namespace flexura
