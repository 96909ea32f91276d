#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_observations.h"
#include "flexura/calibrate/rig_prior.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// The numbers that a camera's description may be wrong by, in the order of their slots. A zoom table's rows
/// follow, one number each: the logarithm of the factor on their focal lengths.
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
  distortion_slot = 19,       // 5: added at every zoom
  zoom_row_slot = 24,
};

/// Of a stance: pan, tilt (rad), zoom (its own unit), the stage's x, y and z (m), beside what was read.
inline constexpr Eigen::Index stance_slots = 6;

/// All that may be wrong with a rig and with what it says of itself while it is looked at, as one vector x:
/// how far each number is from the guess, in its own unit; the guess is x = 0. What the prior holds has no
/// place in x. In this order: each camera's numbers, the arm's (logarithms of the lengths, bend gains), each
/// pose's (bends beside those commanded), each stance's. The first two are the rig's own, `globals()` of
/// them; the others belong to the pictures.
class RigVariables {
 public:
  /// std::invalid_argument: another number of priors than cameras, a prior that is negative or no number,
  /// observations that speak of cameras, stances or poses which there are not, or of another arm, or in
  /// another order; std::out_of_range: of a marker beyond its end.
  RigVariables(const RigModel& guess, const RigPrior& prior, const RigObservations& seen);

  /// A number of the rig.
  struct Variable {
    std::string name;  ///< What it is, in words: "front: mount, x".
    double sigma = 0;  ///< The prior's.
    double scale = 0;  ///< A size that matters, in its unit: sigma, or something like it if that is infinite.
    Eigen::Index column = -1;  ///< In x; -1: held.
  };

  /// Numbers in x; those of them, the first, that are the rig's own.
  [[nodiscard]] Eigen::Index count() const { return count_; }
  [[nodiscard]] Eigen::Index globals() const { return globals_; }
  /// In the order of x.
  [[nodiscard]] const Variable& variable(Eigen::Index column) const {
    return slots_[slot_of_[static_cast<std::size_t>(column)]];
  }
  /// The rig at x = 0.
  [[nodiscard]] const RigModel& guess() const { return guess_; }

  /// Where a camera's slots begin, to be looked up in `column` and `value`.
  [[nodiscard]] std::size_t camera_slots(std::size_t camera) const { return cameras_.at(camera); }
  /// The same of the arm.
  [[nodiscard]] std::size_t arm_slots() const { return arm_; }
  /// Of a pose of the arm.
  [[nodiscard]] std::size_t pose_slots(std::size_t pose) const { return poses_.at(pose); }
  /// Of a stance of a camera.
  [[nodiscard]] std::size_t stance_slots_of(std::size_t stance) const { return stances_.at(stance); }
  /// How many slots a camera has.
  [[nodiscard]] Eigen::Index slots_a_camera(std::size_t camera) const;
  /// Where a slot's number stands in x; -1: held.
  [[nodiscard]] Eigen::Index column(std::size_t slot) const { return slots_[slot].column; }
  /// A slot's number in x; 0 where it is held.
  [[nodiscard]] double value(const Eigen::VectorXd& x, std::size_t slot) const {
    return slots_[slot].column < 0 ? 0.0 : x[slots_[slot].column];
  }
  /// Those of three slots that follow each other.
  [[nodiscard]] Eigen::Vector3d value3(const Eigen::VectorXd& x, std::size_t slot) const {
    return {value(x, slot), value(x, slot + 1), value(x, slot + 2)};
  }

  /// Whether x means a rig at all: its numbers within a thousand times what they may be wrong by, focal
  /// lengths that rise with the zoom.
  [[nodiscard]] bool is_rig(const Eigen::VectorXd& x) const;
  /// The rig that x means.
  [[nodiscard]] RigModel model(const Eigen::VectorXd& x) const;
  /// The observations' poses, the shapes as commanded, and stances, as read.
  [[nodiscard]] const std::vector<ArmState>& commanded() const { return commanded_; }
  [[nodiscard]] const std::vector<RigStance>& read() const { return read_; }
  /// How the arm stood in a pose.
  [[nodiscard]] ArmState pose(const Eigen::VectorXd& x, std::size_t pose) const;
  /// How a camera stood in a stance.
  [[nodiscard]] RigStance stance(const Eigen::VectorXd& x, std::size_t stance) const;

 private:
  void check(const RigPrior& prior) const;
  void add(std::string name, double sigma, double scale);
  void add3(const std::string& name, double sigma, double scale);
  void add_camera(const CameraConfig& camera, const CameraPrior& prior);
  void add_arm(const ArmPrior& prior);
  void add_pose(std::size_t number, const ArmState& pose, const ArmPrior& prior);
  void add_stance(std::size_t number, const RigStance& stance, const CameraPrior& prior);
  [[nodiscard]] CameraConfig camera(const Eigen::VectorXd& x, std::size_t number) const;

  RigModel guess_;
  std::vector<ArmState> commanded_;
  std::vector<RigStance> read_;
  std::vector<Variable> slots_;
  std::vector<std::size_t> slot_of_;  // by column
  std::vector<std::size_t> cameras_, poses_, stances_;
  std::size_t arm_ = 0;
  Eigen::Index count_ = 0, globals_ = 0;
};

}  // namespace flexura
