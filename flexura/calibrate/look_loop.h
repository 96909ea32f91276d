#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flexura/calibrate/loop_session.h"
#include "flexura/calibrate/rig_aim.h"
#include "flexura/calibrate/rig_excursion.h"
#include "flexura/camera/camera.h"

namespace flexura {

/// Common part of the paper's loops. A loop repeatedly takes a picture, measures it, decides and moves. The
/// number of pictures is limited. After an error, the loop returns everything to the start. Cameras have the
/// numbers 0 and 1, in the order of LoopConfig::cameras.
class LookLoop {
 public:
  using Error = RigCommander::Error;
  /// Measures a picture and fills in its observation.
  using Measure = std::function<void(CameraObservation&)>;

  /// Throws std::invalid_argument if the ports do not have the cameras of the model.
  LookLoop(const RigPorts& ports, const RigModel& nominal, const LoopConfig& config,
           RigSessionWatcher& watcher);
  LookLoop(const LookLoop&) = delete;
  LookLoop& operator=(const LookLoop&) = delete;

  /// Waits until nothing moves, and stores all positions. Returns an error if both modelled cameras look from
  /// about the same direction.
  Error begin();
  /// Returns an error if the optical axes of cameras in these positions are more than 45 degrees from a right
  /// angle. `how`: source of the angle, for the message.
  [[nodiscard]] static Error look_from_one_side(const RigModel& rig, const std::array<RigStance, 2>& stances,
                                                const char* how);
  /// Takes a new picture after the last motion. Returns an error if the limit of pictures is reached.
  Error look(std::size_t i, const Measure& measure);
  /// Reports the simulator's plan for a camera's arc.
  void plan(std::size_t i, const std::string& plane, const ArmState& arc, const View& ideal,
            const Image<std::uint8_t>& picture);
  /// Reports the result of a picture and the next action.
  void decide(std::size_t i, const std::string& step, double offset, double accepted, const std::string& unit,
              const std::string& next);
  /// Moves a camera, or moves the arm via its initial shape, and waits until nothing moves.
  Error go(std::size_t i, const RigStance& stance);
  Error show(const ArmState& pose) { return excursion_.show(pose); }
  /// Moves a camera's zoom to the position `zoom` before the loop begins, unless the zoom is already there.
  /// `why`: format string of the reason, with the zoom.
  Error begin_zoomed(std::size_t i, double zoom, const char* step, const char* why);
  /// Turns a camera towards the visible part `seen` of its target, after a picture could not be measured.
  /// `what`: name of the target. `reason`: why the picture could not be measured. Returns an error if nothing
  /// is visible, if `seen` is less than `near` px from the middle, or if the camera cannot turn. `in_vain`:
  /// format string of this error, with the camera's name and the reason.
  Error turn_towards(std::size_t i, const char* what, const std::optional<Eigen::Vector2d>& seen, double near,
                     const Intrinsics& lens, const char* in_vain, const std::string& reason);
  /// Smallest zoom factor from which a principal point is estimated. At this factor, the principal point's
  /// noise is eight times that of the pictures.
  static constexpr double least_longer = 1.2;
  /// Moves a camera to the position with the longer focal length.
  Error go_longer(std::size_t i, const RigStance& stance);
  /// Returns the stance nearest to `stance` that can be commanded to camera `i`.
  [[nodiscard]] RigStance commandable_stance(std::size_t i, const RigStance& stance) const {
    return commanded(cameras_[i], stance);
  }
  /// Returns whether the commandable stance nearest to `stance` equals the last command to camera `i`.
  [[nodiscard]] bool stands_there(std::size_t i, const RigStance& stance) const;
  /// Returns the camera's stance with the focal length multiplied by `ratio`.
  [[nodiscard]] RigStance zoomed(std::size_t i, double ratio) const;
  /// Returns the result with the final positions. After an error, first moves everything back to the start.
  LoopResult finish(const Error& error);

  [[nodiscard]] const LoopConfig& config() const { return config_; }
  [[nodiscard]] const RigModel& nominal() const { return nominal_; }
  [[nodiscard]] const Camera& camera(std::size_t i) const { return cameras_[i]; }
  [[nodiscard]] const CameraConfig& model(std::size_t i) const {
    return nominal_.cameras[config_.cameras[i]];
  }
  [[nodiscard]] const std::string& name(std::size_t i) const { return model(i).name; }
  /// Returns the last commanded stance of camera `i`.
  [[nodiscard]] const RigStance& stance(std::size_t i) const { return excursion_.stances()[i]; }
  /// Returns the modelled lens at the commanded zoom.
  [[nodiscard]] Intrinsics lens(std::size_t i) const { return cameras_[i].lens().at(stance(i).head.zoom); }
  [[nodiscard]] LoopResult& result() { return result_; }
  [[nodiscard]] const CameraObservation& observed() const { return observed_; }

 private:
  const RigModel& nominal_;
  const LoopConfig& config_;
  RigSessionWatcher& watcher_;
  RigExcursion excursion_;
  std::array<Camera, 2> cameras_;
  LoopResult result_;
  CameraObservation observed_;
};

/// Returns the pair of head positions with the least cost, as offsets of -1, 0 or 1 step.
[[nodiscard]] std::array<int, 2> best_steps(const std::function<double(int, int)>& cost);

}  // namespace flexura
