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
#include "flexura/calibrate/rig_hands.h"
#include "flexura/calibrate/rig_observability.h"
#include "flexura/camera/view.h"
#include "flexura/model/stand.h"
#include "flexura/port/rig_ports.h"
#include "flexura/vision/conic.h"

namespace flexura {

/// How well a rig's numbers shall be known (or are): standard deviations.
struct RigSigmas {
  double angle = 0.02 * degree;                  ///< Between the axes, rad.
  std::array<double, 2> focal = {0.003, 0.003};  ///< Of each camera, shares.
  double zoom_ratio = 0.003;                     ///< Share.
};

/// What a calibration of two cameras does.
struct RigSessionConfig {
  std::array<std::size_t, 2> cameras = {0, 1};  ///< Places among the rig's: front and side.
  std::vector<ArmState> poses;                  ///< What the arm shows; at least one.
  ArmPictureConfig picture;                     ///< With the arm's markers.
  std::size_t images = 12;  ///< Looks at the arm, each a picture a camera, at most; the last one verifies.
  std::size_t first = 3;    ///< Of them from where the heads stand.
  std::size_t fewest = 5;   ///< Markers that make a picture of use.
  RigSigmas wanted;         ///< When they are reached, no more looks are needed.
  std::optional<Eigen::Vector3d> target;  ///< What the cameras shall look at, m; the arm's middle.
  /// Look at the calibration cylinder, which stands there alone, and not at the arm: no markers are needed
  /// then, the one pose is the arm's own, the target is the cylinder's middle unless there is another, and
  /// looks begin with the shortest focal length.
  std::optional<EtalonConfig> etalon;
  /// What is bright behind it: pictures that they fill are chosen where there are such.
  std::vector<ScreenConfig> screens = {};
  bool may_use_stages = true;            ///< Else they stay where they stand.
  std::vector<double> zooms = {1, 2.5};  ///< Ratios of focal length to that at the start, to look with.
  double slide = 0.15;       ///< To both sides, of the camera's distance, as far as the stage travels.
  double move_duration = 2;  ///< Of the arm to a pose or back, s.
  double search = 0.2;       ///< How far heads turn to look for an arm that they do not see at first, rad.
  RigPatience patience;
};

/// A number that was read off a picture.
struct SeenValue {
  std::string name;  ///< With its unit: "white left, px".
  double value = 0;
};

/// One picture and what was seen in it.
struct RigSight {
  std::size_t look = 0;  ///< From 1; 0 while the arm is looked for.
  RigStance stance;      ///< As read.
  ArmState pose;         ///< As the drives say.
  Frame frame;           ///< The picture, and when it was taken.
  SeenArm seen;
  std::vector<SeenValue> values;    ///< What the methods of the paper measure (loop_session.h),
  std::optional<CircleFit> circle;  ///< and the one of arcs as printed through the points.
};

/// What was known after a look.
struct RigStep {
  double time = 0;                       ///< s
  std::size_t looks = 0;                 ///< Up to now.
  bool is_found = false;                 ///< A rig explains what was seen so far.
  std::string reason;                    ///< Why not.
  double rms = 0;                        ///< Of residuals, in standard deviations.
  std::size_t doubts = 0;                ///< Things seen that were left out (RigCalibration::doubts).
  double angle = 0;                      ///< Between the axes where the cameras would be sent, rad, as
  std::array<double, 2> focal = {0, 0};  ///< the rig is believed then; focal lengths at ratio 1, px.
  RigSigmas sigmas;                      ///< Of what is known so far.
  std::array<RigStance, 2> wanted;       ///< Where the cameras would be sent.
  /// What would have remained if they had been sent there, by all that is known at the end.
  std::optional<RigRemainder> remainder;
  std::string next;  ///< What is looked at next, and why.
};

/// What a method of the paper makes of a picture (loop_session.h).
struct LoopDecision {
  double time = 0;                  ///< s
  std::size_t looks = 0;            ///< Pictures of all cameras up to now.
  std::size_t camera = 0;           ///< Whose, a place among the rig's.
  std::string step;                 ///< "horizontal orientation", ...
  double offset = 0, accepted = 0;  ///< How far off it is, and how much of that is accepted.
  std::string unit;                 ///< Of both.
  std::string next;                 ///< What is done, in words.
};

/// What the simulator has of an arc of the arm (steps 1, 2 and 7 of section 3.4): what a camera's pictures
/// are compared with.
struct IdealArc {
  double time = 0;              ///< When it was worked out, s.
  std::size_t camera = 0;       ///< Whose, a place among the rig's.
  std::string plane;            ///< "XOY" or "ZOY".
  ArmState state;               ///< The sections' bends, each with its rotation about their base's axis.
  View view;                    ///< The ideal camera,
  Image<std::uint8_t> picture;  ///< and what it sees: the ideal image, gray.
};

/// Sees a session as it goes. What it does with that changes nothing of the session.
class RigSessionWatcher {
 public:
  virtual ~RigSessionWatcher() = default;
  RigSessionWatcher() = default;
  RigSessionWatcher(const RigSessionWatcher&) = delete;
  RigSessionWatcher& operator=(const RigSessionWatcher&) = delete;

  /// The arm is sent to `state`, to arrive `duration` s later; at `time`, s of the rig's clock.
  virtual void arm_sent(double time, const ArmState& state, double duration) = 0;
  /// A head and a stage are sent to where the stance has them; at `time`, s of the rig's clock.
  virtual void camera_sent(double time, const RigStance& stance) = 0;
  /// A picture was taken and measured.
  virtual void seen(const RigSight& sight) = 0;
  /// What the least squares know after a look (calibrate_rig_in_session).
  virtual void known(const RigStep& step) = 0;
  /// What a loop of the paper's has the simulator work out beforehand (calibrate_by_loop).
  virtual void planned(const IdealArc& /*arc*/) {}
  /// What such a loop decides.
  virtual void decided(const LoopDecision& /*decision*/) {}
  /// Whether the session shall end early.
  virtual bool is_cancelled() { return false; }
};

/// How a session went.
struct RigSessionResult {
  bool is_done = false;
  std::string reason;                            ///< Why it is not, and where the rig was left.
  std::vector<RigStep> steps;                    ///< After each look from which a rig was sought.
  std::size_t looks = 0;                         ///< As RigSessionConfig::images counts them.
  std::array<std::size_t, 2> pictures = {0, 0};  ///< By camera, those that looked for the arm among them.
  RigCalibration found;                          ///< By all pictures.
  std::size_t markers = 0, points = 0, etalon_points = 0;  ///< In all pictures.
  RigObservability observability;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< What the cameras look at, m.
  std::array<RigStance, 2> start;                    ///< How they stood at first.
  /// What would have remained if they had been sent where the rig as believed has them, and as they stood.
  std::optional<RigRemainder> believed_remainder, start_remainder;
  WantedRig wanted;        ///< As commanded.
  RigRemainder remainder;  ///< As found afterwards.
  /// How far from where they were foretold the things of the last look were seen, root mean square, px: its
  /// pictures have no part in the foretelling.
  std::array<double, 2> verified = {0, 0};
  std::array<std::optional<RigSight>, 2> before, after;  ///< The first and the last picture of each camera.
};

/// Calibrates two cameras of a rig and drives them to the wanted configuration (section 3.4 of the paper;
/// docs/calibration.md): the arm is shown in some poses (or the calibration cylinder stands), each camera
/// looks; the rig that explains everything is found; what tells most is looked at next, within the limits of
/// heads, stages and lenses; when enough is known, heads and stages are sent to where both cameras look at
/// the arm along orthogonal axes with equal zoom, in one move, and a last look verifies it. The arm goes from
/// pose to pose by way of the shape in which it began. What goes wrong ends the session: heads, stages and
/// arm are sent back to where they began, and the result says why. Everything happens through the ports. The
/// same rig, readings and pictures give the same result. std::invalid_argument: no poses, no markers, fewer
/// than 3 images, none from where the heads stand, one camera given for both, or ports for other cameras than
/// the model's.
[[nodiscard]] RigSessionResult calibrate_rig_in_session(const RigPorts& ports, const RigModel& believed,
                                                        const RigPrior& prior, const RigSessionConfig& config,
                                                        RigSessionWatcher& watcher);

}  // namespace flexura
