#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/image.h"
#include "flexura/calibrate/arm_picture.h"
#include "flexura/calibrate/rig_session.h"
#include "flexura/camera/view.h"
#include "flexura/model/stand.h"

namespace flexura {

/// The paper's two ways to calibrate (section 3.4), each as printed and as corrected.
enum class LoopMethod {
  etalon,        ///< With the calibration cylinder: borders to a part of a pixel, steps that shrink.
  etalon_paper,  ///< The same as printed: pixels are counted, steps are all alike.
  arcs,          ///< With the simulator: both cameras see arcs of the arm in two planes, by its markers.
  arcs_paper,    ///< The same as printed: each sees one arc, and tests whether it is a circle's.
};

/// What a loop does, and what it knows of the rig beforehand.
struct LoopConfig {
  LoopMethod method = LoopMethod::etalon;
  std::array<std::size_t, 2> cameras = {0, 1};  ///< Places among the rig's: front and side.
  std::size_t images = 60;                      ///< Pictures a camera, at most.
  double accepted = 0.05;                       ///< Of every offset in the picture, px.
  double zoom_accepted = 0.001;                 ///< Share by which the two may show the target unlike.
  double turn = 0.2 * degree;                   ///< As printed: each turn of a head, rad,
  double slide = 0.005;                         ///< and each way of a stage, m,
  double zoom_step = 0.02;                      ///< and the share by which a zoom changes.
  EtalonConfig etalon;                          ///< Where it stands, and how large it is.
  /// By which the arm is bent into an arc, rad. Beyond a quarter of a circle an arm seen from within its
  /// plane lies before itself.
  double arc = 90 * degree;
  ArmPictureConfig picture;       ///< With the arm's markers.
  std::optional<RigPrior> prior;  ///< How wrong the rig may be (`arcs`); none: as rough_prior() says.
  /// The simulator's picture of the arm in a state, gray: the ideal image.
  std::function<Image<std::uint8_t>(const View&, const ArmState&)> draw;
  double move_duration = 2;  ///< Of the arm to a shape or back, s.
  RigPatience patience;
};

/// How a loop went.
struct LoopResult {
  bool is_done = false;
  std::string reason;                                ///< Why it is not, and where the rig was left.
  std::vector<LoopDecision> steps;                   ///< What was decided, in order.
  std::array<std::size_t, 2> pictures = {0, 0};      ///< By camera.
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< What the cameras look at, m.
  std::array<RigStance, 2> start, stances;           ///< How they stood at first, and at the end, as read.
  std::array<std::optional<double>, 2> roll;         ///< As seen, rad: no head can correct it.
  /// By which each principal point is seen to the right of and below where the model has it, px.
  std::array<std::optional<Eigen::Vector2d>, 2> principal_point;
  std::optional<double> angle;       ///< Between the axes beyond 90 degrees, as seen, rad.
  std::optional<double> zoom_ratio;  ///< How much larger the first shows it, as seen.
  std::vector<std::string> notes;    ///< What else there is to know.
  std::array<std::optional<RigSight>, 2> before, after;  ///< The first and the last picture of each camera.
};

/// Calibrates two cameras by a loop of looking, measuring, deciding and moving (docs/calibration-paper.md),
/// at the ports alone. `believed` tells what heads, stages and lenses can do and how long the lenses are.
/// What goes wrong (also a loop that goes on for ever, or runs away) ends it: heads, stages and arm are sent
/// back to where they began, and the result says why. The same rig, readings and pictures give the same
/// result. std::invalid_argument: ports for other cameras than the model's, one camera given for both.
[[nodiscard]] LoopResult calibrate_by_loop(const RigPorts& ports, const RigModel& believed,
                                           const LoopConfig& config, RigSessionWatcher& watcher);

}  // namespace flexura
