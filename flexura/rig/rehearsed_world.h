#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "flexura/camera/head.h"
#include "flexura/model/backbone.h"
#include "flexura/port/motion_ports.h"
#include "flexura/port/rig_model.h"
#include "flexura/rig/filming.h"
#include "flexura/rig/setup.h"

namespace flexura {

/// The simulated rig of an experiment in real time. Simulated controllers outside this object turn its
/// motors, with the limits of the controllers, not of the drive. Several threads may use one RehearsedWorld.
class RehearsedWorld {
 public:
  /// Function that returns the present position of each motor, microsteps, as the motor's controller counts.
  using Positions = std::function<std::vector<double>()>;

  /// Time 0 is the time of construction. `positions` is called in any thread that advances the world.
  /// Requires a drive.
  RehearsedWorld(const Setup& setup, Positions positions);

  /// Returns the time, s.
  [[nodiscard]] double now() const;
  /// Converts a time of this world to the clock steady_seconds(), s.
  [[nodiscard]] double steady(double time) const { return start_ + time; }
  /// Advances the simulation to the present. Since the last call, each motor is assumed to have turned at
  /// constant speed.
  void advance();

  /// Commands a camera's head.
  void turn(std::size_t camera, const HeadState& to);
  /// Stops all axes of a camera's head.
  void halt(std::size_t camera);
  /// Returns the present reading of a camera's head.
  [[nodiscard]] HeadReading head(std::size_t camera);

  /// Returns whether the camera loses a frame (SensorConfig::drop, SensorConfig::silent).
  [[nodiscard]] bool is_lost(std::size_t camera, std::int64_t frame);
  /// Renders a frame whose exposure is over. Only one thread at a time may render a frame of the same camera.
  [[nodiscard]] Picture picture(std::size_t camera, std::int64_t frame);
  [[nodiscard]] const SensorConfig& sensor(std::size_t camera) const { return sensors_.at(camera); }

  /// Returns why the simulation has ended, for example an elastic arm that collapsed; "" while it goes on.
  [[nodiscard]] std::string failure() const;
  /// Returns the arm's true backbone now.
  [[nodiscard]] Backbone backbone();
  /// Returns the true axis positions of a camera now.
  [[nodiscard]] RigStance stance(std::size_t camera);

 private:
  void advance_locked();

  Setup setup_;  // With motors that follow at once.
  std::vector<SensorConfig> sensors_;
  Positions positions_;
  double start_;
  mutable std::mutex mutex_;  // Of what the functions below change.
  Filming filming_;
  RigTruth* truth_;
  std::vector<double> first_;  // Model's motor positions at the start, microsteps.
  RigPorts ports_;
  double passed_ = 0;  // Time of the simulation, s.
  std::string failure_;
};

}  // namespace flexura
