#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/calibrate/loop_session.h"
#include "flexura/calibrate/rig_commander.h"
#include "flexura/calibrate/rig_prior.h"
#include "flexura/calibrate/rig_session.h"
#include "flexura/camera/camera_config.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/stand.h"
#include "flexura/tasks/task_label.h"

namespace flexura {

/// Calibration method of a task.
enum class CalibrateMethod {
  /// Least squares fit of camera poses, lenses and the arm's errors to pictures of the arm
  /// (calibrate/rig_session.h).
  bundle,
  bundle_etalon,  ///< Least squares fit to pictures of the calibration cylinder.
  etalon,  ///< The paper's iterative method with the cylinder, with corrections (calibrate/loop_session.h).
  etalon_paper,  ///< The iterative method with the cylinder, exactly as printed in the paper.
  arcs,          ///< The paper's iterative method with arcs of the arm and the simulator, with corrections.
  arcs_paper,    ///< The iterative method with arcs and the simulator, exactly as printed in the paper.
};

/// Standard deviations of the calibrated rig below which no more pictures are taken.
struct CalibrateRequiredStd {
  double angle = RigSigmas{}.angle;            ///< Angle between the optical axes, rad.
  double focal = RigSigmas{}.focal[0];         ///< Focal lengths, relative.
  double zoom_ratio = RigSigmas{}.zoom_ratio;  ///< Ratio of the arm's sizes in the two images, relative.
  bool operator==(const CalibrateRequiredStd&) const = default;
};

/// Prior standard deviations of the file's camera models.
struct CalibrateCameraPrior {
  /// Standard deviation of a mount's orientation about each axis, rad.
  double rotation_std = CameraPrior{}.rotation;
  /// Standard deviation of a mount's position along each axis, as a fraction of its distance from the arm's
  /// base or the calibration cylinder.
  double position_std = 0.2;
  double focal_std = CameraPrior{}.focal;  ///< Relative standard deviation of the focal length.
  /// Standard deviation of the principal point, px.
  double principal_point_std = CameraPrior{}.principal_point;
  double zero_std = CameraPrior{}.tilt_zero;  ///< Standard deviation of a head's zero offsets, rad.
  bool exact_heads = false;                   ///< Whether heads are exactly at their reported positions.
  bool operator==(const CalibrateCameraPrior&) const = default;
};

/// Prior standard deviations of the file's model of the arm, for the method `bundle` (docs/calibration.md,
/// "An arm unlike its model").
struct CalibrateArmPrior {
  double length_std = ArmPrior{}.length;  ///< Relative standard deviation of each section's length.
  /// ArmPrior::response; default: 0.2 if the arm's model is an elastic rod, otherwise 0.
  std::optional<double> response_std = {};
  /// ArmPrior::pose_response; default: a quarter of response_std.
  std::optional<double> pose_response_std = {};
  bool operator==(const CalibrateArmPrior&) const = default;
};

/// Parameters of the paper's iterative methods (calibrate/loop_session.h).
struct CalibrateLoopConfig {
  std::optional<double> accepted;             ///< Tolerance of every offset in a picture, px.
  std::optional<double> zoom_accepted;        ///< Relative tolerance of the zoom ratio.
  double turn = LoopConfig{}.turn;            ///< Fixed rotation step of a head for etalon-paper, rad.
  double slide = LoopConfig{}.slide;          ///< Fixed translation step of a stage for etalon-paper, m.
  double zoom_step = LoopConfig{}.zoom_step;  ///< Fixed relative step of a zoom for etalon-paper.
  std::optional<double> arc;                  ///< Bend of the arm in an arc, rad.
  bool operator==(const CalibrateLoopConfig&) const = default;
};

/// `kind = "calibrate"`: calibrates two cameras from their pictures. Then points the cameras along orthogonal
/// axes at the arm, with equal zoom.
struct CalibrateTask {
  std::string name;
  CalibrateMethod method = CalibrateMethod::bundle;
  std::vector<std::string> cameras;    ///< Names of two cameras; empty: the first two cameras.
  std::vector<ShapeConfig> pose;       ///< Shapes of the arm in the pictures; empty: default poses.
  std::optional<std::int64_t> images;  ///< Largest number of pictures per camera.
  CalibrateRequiredStd required_std;
  CalibrateCameraPrior camera_prior;
  CalibrateArmPrior arm_prior;
  CalibrateLoopConfig loop;
  /// Point at which the calibrated cameras look, in the world frame W, m.
  std::optional<std::array<double, 3>> target;
  bool stages = RigSessionConfig{}.may_use_stages;  ///< Whether stages may move, within their travel.
  /// Focal lengths for the pictures, as factors on the initial focal length.
  std::vector<double> zooms = RigSessionConfig{}.zooms;
  double move_duration = RigSessionConfig{}.move_duration;  ///< Duration of a move of the arm, s.
  double pause = 0;  ///< Time to wait after each motion of the arm, until it stops swinging, s.
  double settle_timeout = RigPatience{}.settle;  ///< Time limit for motions to end, s.
  double frame_timeout = RigPatience{}.frame;    ///< Longest wait for a picture, s.
  std::string save;  ///< File in the experiment's folder for the calibrated rig; "": not saved.
};

const std::vector<std::string>& names_of(const CalibrateMethod*);
const Table<CalibrateRequiredStd>& fields_of(const CalibrateRequiredStd*);
const Table<CalibrateCameraPrior>& fields_of(const CalibrateCameraPrior*);
const Table<CalibrateArmPrior>& fields_of(const CalibrateArmPrior*);
const Table<CalibrateLoopConfig>& fields_of(const CalibrateLoopConfig*);
const Table<CalibrateTask>& fields_of(const CalibrateTask*);

/// Returns whether a task uses one of the paper's iterative methods, corrected or not.
[[nodiscard]] bool is_loop(const CalibrateTask& task);
/// Returns whether the method is exactly as printed in the paper, without corrections.
[[nodiscard]] bool is_as_printed(const CalibrateTask& task);
/// Returns whether the method uses the calibration cylinder.
[[nodiscard]] bool is_before_etalon(const CalibrateTask& task);
/// Returns the bend of the arm in an arc, rad.
[[nodiscard]] double arc_bend(const CalibrateTask& task);
/// Returns the largest number of pictures per camera.
[[nodiscard]] std::size_t most_images(const CalibrateTask& task);

/// Returns the poses of a task as states of the arm.
[[nodiscard]] std::vector<ArmState> calibration_poses(const CalibrateTask& task, const Arm& arm);

/// Returns the indices among `cameras` of the two cameras of a checked task.
[[nodiscard]] std::array<std::size_t, 2> calibrated_cameras(const CalibrateTask& task,
                                                            const std::vector<CameraConfig>& cameras);

/// Returns the session configuration for a task.
[[nodiscard]] RigSessionConfig session_config(const CalibrateTask& task, const ArmConfig& arm,
                                              const std::vector<CameraConfig>& cameras,
                                              const StandConfig& stand);
/// Returns the prior standard deviations that a task assumes for the rig.
[[nodiscard]] RigPrior session_prior(const CalibrateTask& task, const RigModel& nominal,
                                     const StandConfig& stand);

/// Returns the configuration of a LoopSession for a task with one of the paper's methods. The caller must add
/// the function that renders the simulator's pictures.
[[nodiscard]] LoopConfig loop_config(const CalibrateTask& task, const ArmConfig& arm,
                                     const std::vector<CameraConfig>& cameras, const StandConfig& stand);

/// Reports as errors why the calibration at `path` ("task[2]") is not possible with this setup.
void check_keys(const CalibrateTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// Returns the runner of a calibration. `task` and `setup` must outlive the runner.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const CalibrateTask& task, const Setup& setup,
                                                    TaskLabel label);

}  // namespace flexura
