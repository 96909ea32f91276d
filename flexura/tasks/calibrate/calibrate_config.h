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

/// How a task calibrates.
enum class CalibrateMethod {
  bundle,         ///< All poses, lenses and the arm's own errors at once, by least squares
                  ///< (calibrate/rig_session.h).
  bundle_etalon,  ///< The same before the calibration cylinder.
  etalon,         ///< The paper's, with the cylinder, as corrected (calibrate/loop_session.h).
  etalon_paper,   ///< The same as printed.
  arcs,           ///< The paper's, with the simulator, as corrected.
  arcs_paper,     ///< The same as printed.
};

/// Standard deviations of the calibrated rig at which no more pictures are taken.
struct CalibrateRequiredStd {
  double angle = RigSigmas{}.angle;            ///< Angle between the axes, rad.
  double focal = RigSigmas{}.focal[0];         ///< Focal lengths, relative.
  double zoom_ratio = RigSigmas{}.zoom_ratio;  ///< Ratio of the arm's sizes in the images, relative.
  bool operator==(const CalibrateRequiredStd&) const = default;
};

/// Prior standard deviations of the file's camera models.
struct CalibrateCameraPrior {
  double rotation_std = CameraPrior{}.rotation;  ///< Of a mount's orientation, about each axis, rad.
  double position_std = 0.2;               ///< Of a mount's position, along each axis, over its distance.
  double focal_std = CameraPrior{}.focal;  ///< Of the focal length, relative.
  double principal_point_std = CameraPrior{}.principal_point;  ///< px
  double zero_std = CameraPrior{}.tilt_zero;                   ///< Of a head's zero offsets, rad.
  bool exact_heads = false;  ///< Heads are exactly at their counted positions.
  bool operator==(const CalibrateCameraPrior&) const = default;
};

/// How the paper's methods go about it (calibrate/loop_session.h).
struct CalibrateLoopConfig {
  std::optional<double> accepted;             ///< Of every offset in a picture, px.
  std::optional<double> zoom_accepted;        ///< Of the zoom ratio, a share.
  double turn = LoopConfig{}.turn;            ///< As printed: every turn of a head, rad,
  double slide = LoopConfig{}.slide;          ///< every way of a stage, m,
  double zoom_step = LoopConfig{}.zoom_step;  ///< and every change of a zoom, a share.
  std::optional<double> arc;                  ///< By which the arm is bent into an arc, rad.
  bool operator==(const CalibrateLoopConfig&) const = default;
};

/// `kind = "calibrate"`: the arm is shown to two cameras, which are then sent to the wanted configuration.
struct CalibrateTask {
  std::string name;
  CalibrateMethod method = CalibrateMethod::bundle;
  std::vector<std::string> cameras;    ///< Two names; empty: the first two.
  std::vector<ShapeConfig> pose;       ///< What the arm shows; empty: default_poses.
  std::optional<std::int64_t> images;  ///< A camera, at most.
  CalibrateRequiredStd required_std;
  CalibrateCameraPrior camera_prior;
  CalibrateLoopConfig loop;
  std::optional<std::array<double, 3>> target;      ///< What the cameras shall look at, m.
  bool stages = RigSessionConfig{}.may_use_stages;  ///< They may be moved, as far as they travel.
  /// Focal lengths to look with, as factors on that at the start.
  std::vector<double> zooms = RigSessionConfig{}.zooms;
  double move_duration = RigSessionConfig{}.move_duration;  ///< s
  double settle_timeout = RigPatience{}.settle;             ///< s
  double frame_timeout = RigPatience{}.frame;               ///< s
  std::string save;  ///< A file beside the experiment for the rig as found; "": none.
};

const std::vector<std::string>& names_of(const CalibrateMethod*);
const Table<CalibrateRequiredStd>& fields_of(const CalibrateRequiredStd*);
const Table<CalibrateCameraPrior>& fields_of(const CalibrateCameraPrior*);
const Table<CalibrateLoopConfig>& fields_of(const CalibrateLoopConfig*);
const Table<CalibrateTask>& fields_of(const CalibrateTask*);

/// Whether a task's method is one of the paper's loops.
[[nodiscard]] bool is_loop(const CalibrateTask& task);
/// Whether its method is one of those as printed.
[[nodiscard]] bool is_as_printed(const CalibrateTask& task);
/// Whether its method is one that looks at the calibration cylinder.
[[nodiscard]] bool is_before_etalon(const CalibrateTask& task);
/// By how much the arm is bent into an arc, rad.
[[nodiscard]] double arc_bend(const CalibrateTask& task);
/// Pictures a camera, at most.
[[nodiscard]] std::size_t most_images(const CalibrateTask& task);

/// The poses of a task, as states of the arm.
[[nodiscard]] std::vector<ArmState> calibration_poses(const CalibrateTask& task, const Arm& arm);

/// The two cameras of a task that was checked: places among `cameras`.
[[nodiscard]] std::array<std::size_t, 2> calibrated_cameras(const CalibrateTask& task,
                                                            const std::vector<CameraConfig>& cameras);

/// What the task asks of a session.
[[nodiscard]] RigSessionConfig session_config(const CalibrateTask& task, const ArmConfig& arm,
                                              const std::vector<CameraConfig>& cameras,
                                              const StandConfig& stand);
/// How wrong the task takes the rig to be, at most.
[[nodiscard]] RigPrior session_prior(const CalibrateTask& task, const RigModel& nominal,
                                     const StandConfig& stand);

/// What a task by one of the paper's methods asks of its loop; the simulator's pictures are left out.
[[nodiscard]] LoopConfig loop_config(const CalibrateTask& task, const ArmConfig& arm,
                                     const std::vector<CameraConfig>& cameras, const StandConfig& stand);

/// Reports what keeps the calibration at `path` ("task[2]") from being made with this setup.
void check_keys(const CalibrateTask& task, const Setup& setup, const std::string& path, Reader& reader);
/// What does such a task. Both outlive it.
[[nodiscard]] std::unique_ptr<TaskRunner> runner_of(const CalibrateTask& task, const Setup& setup,
                                                    TaskLabel label);

}  // namespace flexura
