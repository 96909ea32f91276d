#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flexura/calibrate/loop_session.h"
#include "flexura/calibrate/rig_aim.h"
#include "flexura/calibrate/rig_trip.h"
#include "flexura/camera/camera.h"

namespace flexura {

/// What the paper's loops have in common: look, tell, decide, move, within a number of pictures; and the way
/// back when something is wrong. Cameras are counted 0 and 1 here, as in LoopConfig::cameras.
class LookLoop {
 public:
  using Trouble = RigHands::Trouble;
  /// Fills in what is seen.
  using Measure = std::function<void(RigSight&)>;

  /// std::invalid_argument: ports for other cameras than the model's.
  LookLoop(const RigPorts& ports, const RigModel& believed, const LoopConfig& config,
           RigSessionWatcher& watcher);
  LookLoop(const LookLoop&) = delete;
  LookLoop& operator=(const LookLoop&) = delete;

  /// Waits for rest, remembers where everything stands, and refuses cameras that are believed to look from
  /// one side.
  Trouble begin();
  /// Why the axes of a rig whose cameras stand so make no right angle: they are more than 45 degrees from
  /// one; `how` that is known.
  [[nodiscard]] static Trouble look_from_one_side(const RigModel& rig,
                                                  const std::array<RigStance, 2>& stances, const char* how);
  /// A fresh picture of what stands; trouble when there were too many.
  Trouble look(std::size_t i, const Measure& measure);
  /// What the simulator has of a camera's arc.
  void plan(std::size_t i, const std::string& plane, const ArmState& arc, const View& ideal,
            const Image<std::uint8_t>& picture);
  /// What was made of a picture, and what follows.
  void decide(std::size_t i, const std::string& step, double offset, double accepted, const std::string& unit,
              const std::string& next);
  /// Sends a camera, or the arm by way of the shape in which it began, and waits.
  Trouble go(std::size_t i, const RigStance& stance);
  Trouble show(const ArmState& pose) { return trip_.show(pose); }
  /// Sends a camera's zoom there before the loop begins, unless it stands there; `why` in words, of the zoom.
  Trouble begin_zoomed(std::size_t i, double zoom, const char* step, const char* why);
  /// Turns a camera towards where something is `seen` of `what` it looks for, in which there is nothing to
  /// measure for a `reason`. Trouble where nothing is, or less than `near` px from the middle, or it cannot
  /// be turned: `in_vain`, of the camera's name and the reason.
  Trouble turn_towards(std::size_t i, const char* what, const std::optional<Eigen::Vector2d>& seen,
                       double near, const Intrinsics& lens, const char* in_vain, const std::string& reason);
  /// A principal point shows by a focal length that is so many times as long at least, where noise counts
  /// eight times.
  static constexpr double least_longer = 1.2;
  /// Sends a camera to where it has it.
  Trouble go_longer(std::size_t i, const RigStance& stance);
  /// What the camera can be sent to that is nearest, and whether that is where it was sent already.
  [[nodiscard]] RigStance commandable_stance(std::size_t i, const RigStance& stance) const {
    return commanded(cameras_[i], stance);
  }
  [[nodiscard]] bool stands_there(std::size_t i, const RigStance& stance) const;
  /// Such a stance by a focal length that is `ratio` times as long.
  [[nodiscard]] RigStance zoomed(std::size_t i, double ratio) const;
  /// The result, with how things stand at the end; in trouble everything is sent back first.
  LoopResult finish(const Trouble& trouble);

  [[nodiscard]] const LoopConfig& config() const { return config_; }
  [[nodiscard]] const RigModel& believed() const { return believed_; }
  [[nodiscard]] const Camera& camera(std::size_t i) const { return cameras_[i]; }
  [[nodiscard]] const CameraConfig& model(std::size_t i) const {
    return believed_.cameras[config_.cameras[i]];
  }
  [[nodiscard]] const std::string& name(std::size_t i) const { return model(i).name; }
  /// As sent.
  [[nodiscard]] const RigStance& stance(std::size_t i) const { return trip_.stances()[i]; }
  /// The believed lens at the zoom as it stands.
  [[nodiscard]] Intrinsics lens(std::size_t i) const { return cameras_[i].lens().at(stance(i).head.zoom); }
  [[nodiscard]] LoopResult& result() { return result_; }
  [[nodiscard]] const RigSight& sight() const { return sight_; }

 private:
  const RigModel& believed_;
  const LoopConfig& config_;
  RigSessionWatcher& watcher_;
  RigTrip trip_;
  std::array<Camera, 2> cameras_;
  LoopResult result_;
  RigSight sight_;
};

/// Of the positions of two heads, each a step or none beside where it stands, the pair of least cost.
[[nodiscard]] std::array<int, 2> best_steps(const std::function<double(int, int)>& cost);

}  // namespace flexura
