#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/calibrate/rig_prior.h"
#include "flexura/calibrate/rig_response.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Slots of the variables of a camera's model, in order. One variable per row of a zoom table follows: the
/// logarithm of the factor on the row's focal lengths.
enum CameraSlot : Eigen::Index {
  mount_position_slot = 0,  // 3: m, in W
  mount_rotation_slot = 3,  // 3: rotation vector in W, from the guess, rad
  pan_zero_slot = 6,
  tilt_zero_slot = 7,
  tilt_axis_slot = 8,  // 3
  pupil_slot = 11,     // 3
  pupil_shift_slot = 14,
  focal_slot = 15,            // logarithm of the factor on fx and fy at every zoom
  aspect_slot = 16,           // logarithm of the factor on fy alone
  principal_point_slot = 17,  // 2: px, at every zoom
  distortion_slot = 19,       // 8: added at every zoom; those that the lens model does not have are fixed
  zoom_row_slot = distortion_slot + static_cast<Eigen::Index>(Distortion::most),
};

/// Number of slots of a stance. The slots are offsets from the measured positions: pan, tilt (rad), zoom (in
/// its own unit), and the stage's x, y and z (m).
inline constexpr Eigen::Index stance_slots = 6;

/// The unknown errors of a rig and of its measured positions as one vector x, where x = 0 is the guess. Each
/// variable is an offset from the guess in its own unit. Variables that the prior fixes have no entry in x.
/// The first variables are those of each camera and of the arm (logarithms of the lengths, bend gains, errors
/// of the response). Next are the variables of each pose (bend offsets from the command) and of each stance.
/// If the prior has errors of the response, poses with equal commands share their variables. The variables of
/// cameras and arm are called the rig's own variables; globals() is their number.
class RigVariables {
 public:
  /// Throws std::invalid_argument if there is not one prior per camera, or if a prior is negative or NaN.
  /// Also throws std::invalid_argument if observations refer to missing cameras, stances or poses, do not fit
  /// the arm, or are in a wrong order. Throws std::out_of_range for a marker beyond the arm's end.
  RigVariables(const RigModel& guess, const RigPrior& prior, const RigObservations& seen);

  /// A variable of the rig.
  struct Variable {
    std::string name;  ///< Name, such as "front: mount, x".
    double sigma = 0;  ///< Prior standard deviation.
    double scale =
        0;  ///< Typical size, in the variable's unit: sigma, or a similar size if sigma is infinite.
    Eigen::Index column = -1;  ///< Index in x; -1: fixed.
  };

  /// Returns the number of variables in x.
  [[nodiscard]] Eigen::Index count() const { return count_; }
  /// Returns the number of the rig's own variables, which are the first variables in x.
  [[nodiscard]] Eigen::Index globals() const { return globals_; }
  /// Returns the variable with this index in x.
  [[nodiscard]] const Variable& variable(Eigen::Index column) const {
    return slots_[slot_of_[static_cast<std::size_t>(column)]];
  }
  /// Returns the rig at x = 0.
  [[nodiscard]] const RigModel& guess() const { return guess_; }

  /// Returns the index of a camera's first slot, for column() and value().
  [[nodiscard]] std::size_t camera_slots(std::size_t camera) const { return cameras_.at(camera); }
  /// Returns the arm's first slot.
  [[nodiscard]] std::size_t arm_slots() const { return arm_; }
  /// Returns the first slot of a pose of the arm.
  [[nodiscard]] std::size_t pose_slots(std::size_t pose) const { return poses_.at(pose); }
  /// Returns the number of slots of the arm.
  [[nodiscard]] Eigen::Index slots_of_arm() const;
  /// Returns the number of slots of each pose.
  [[nodiscard]] Eigen::Index slots_a_pose() const;
  /// Returns the error model of the arm's response; without inputs if the prior has no such errors.
  [[nodiscard]] const RigResponse& response() const { return response_; }
  /// Returns the first slot of a stance of a camera.
  [[nodiscard]] std::size_t stance_slots_of(std::size_t stance) const { return stances_.at(stance); }
  /// Returns a camera's number of slots.
  [[nodiscard]] Eigen::Index slots_a_camera(std::size_t camera) const;
  /// Returns the index of a slot's variable in x; -1 for a fixed variable.
  [[nodiscard]] Eigen::Index column(std::size_t slot) const { return slots_[slot].column; }
  /// Returns the value of a slot's variable in x; 0 for a fixed variable.
  [[nodiscard]] double value(const Eigen::VectorXd& x, std::size_t slot) const {
    return slots_[slot].column < 0 ? 0.0 : x[slots_[slot].column];
  }
  /// Returns the values of the variables in `slot` and in the slot after it.
  [[nodiscard]] Eigen::Vector2d value2(const Eigen::VectorXd& x, std::size_t slot) const {
    return {value(x, slot), value(x, slot + 1)};
  }
  /// Returns the values of the variables in `slot` and in the two slots after it.
  [[nodiscard]] Eigen::Vector3d value3(const Eigen::VectorXd& x, std::size_t slot) const {
    return {value(x, slot), value(x, slot + 1), value(x, slot + 2)};
  }

  /// Returns whether x describes a valid rig: each variable is within a thousand times its prior, and focal
  /// lengths increase with the zoom.
  [[nodiscard]] bool is_rig(const Eigen::VectorXd& x) const;
  /// Returns the rig described by x.
  [[nodiscard]] RigModel model(const Eigen::VectorXd& x) const;
  /// Returns the commanded arm poses of the observations.
  [[nodiscard]] const std::vector<ArmState>& commanded() const { return commanded_; }
  /// Returns the measured camera stances of the observations.
  [[nodiscard]] const std::vector<RigStance>& read() const { return read_; }
  /// Returns the estimated arm pose.
  [[nodiscard]] ArmState pose(const Eigen::VectorXd& x, std::size_t pose) const;
  /// Returns the estimated camera stance.
  [[nodiscard]] RigStance stance(const Eigen::VectorXd& x, std::size_t stance) const;

 private:
  void check(const RigPrior& prior) const;
  void add(std::string name, double sigma, double scale);
  void add3(const std::string& name, double sigma, double scale);
  void add_camera(const CameraConfig& camera, const CameraPrior& prior);
  void add_arm(const ArmPrior& prior);
  void add_pose(std::size_t number, const ArmState& pose, const ArmPrior& prior);
  void add_bend(const std::string& name, const std::array<double, 2>& sigmas);
  void add_stance(std::size_t number, const RigStance& stance, const CameraPrior& prior);
  [[nodiscard]] CameraConfig camera(const Eigen::VectorXd& x, std::size_t number) const;

  RigModel guess_;
  RigResponse response_;
  std::vector<ArmState> commanded_;
  std::vector<RigStance> read_;
  std::vector<Variable> slots_;
  std::vector<std::size_t> slot_of_;  // Slot of each variable in x.
  std::vector<std::size_t> cameras_, poses_, stances_;
  std::size_t arm_ = 0;
  Eigen::Index count_ = 0, globals_ = 0;
};

}  // namespace flexura
