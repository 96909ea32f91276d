#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/log/run_watcher.h"
#include "flexura/mechanics/rod_energy.h"
#include "flexura/model/backbone.h"
#include "flexura/port/camera_port.h"
#include "flexura/port/rig_model.h"
#include "flexura/port/rig_ports.h"
#include "flexura/rig/setup.h"
#include "flexura/sim/plant_contact.h"

namespace flexura {

/// A filmed frame.
struct FilmedFrame {
  std::string camera;
  Frame frame;
  std::string message = {};  ///< Result of logged_image() for the frame; "" if not yet computed.
};

/// True state of a rig. The rig's ports do not provide the true state, and algorithms must not use it.
class RigTruth {
 public:
  virtual ~RigTruth() = default;
  RigTruth() = default;
  RigTruth(const RigTruth&) = delete;
  RigTruth& operator=(const RigTruth&) = delete;

  /// Returns the true axis positions of a camera now.
  [[nodiscard]] virtual RigStance stance(std::size_t camera) = 0;
  /// Returns the arm's true backbone at a recent time, s.
  [[nodiscard]] virtual Backbone backbone(double time) = 0;
  /// Returns the tension of each tendon at a recent time, N; empty for an arm without forces.
  [[nodiscard]] virtual std::vector<double> tensions(double /*time*/) { return {}; }
  /// Returns the true displacement of each tendon at a recent time, m; empty if unknown.
  [[nodiscard]] virtual std::vector<double> pulled(double /*time*/) { return {}; }
  /// Returns the kinetic, elastic and gravitational energy of the arm at a recent time. std::nullopt if the
  /// arm has no inertia, or the energies are unknown.
  [[nodiscard]] virtual std::optional<RodEnergy> energy(double /*time*/) { return std::nullopt; }
  /// Returns the arm's contacts at a recent time.
  [[nodiscard]] virtual std::vector<PlantContact> contacts(double /*time*/) { return {}; }
  /// Returns a warning of one line about the arm's state at a recent time, or "".
  [[nodiscard]] virtual std::string warning(double /*time*/) { return {}; }
  /// Returns the number of microsteps that each motor had lost by a recent time. Controllers do not notice
  /// lost microsteps. Empty if motors cannot lose microsteps.
  [[nodiscard]] virtual std::vector<double> lost_steps(double /*time*/) { return {}; }
};

/// A rig of an experiment, simulated or real: its ports, and functions that advance it in time.
class Rig {
 public:
  virtual ~Rig() = default;
  Rig() = default;
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  /// Returns the ports, valid as long as the rig.
  [[nodiscard]] virtual RigPorts ports() = 0;
  /// Returns the true state; null for real equipment.
  [[nodiscard]] virtual RigTruth* truth() { return nullptr; }
  /// Returns true for a simulated rig: nothing can be damaged, so that unsafe motions are allowed.
  [[nodiscard]] virtual bool is_simulated() const { return false; }

  using TakeFrame = std::function<void(const FilmedFrame&)>;
  /// Commands the arm to be in `state` at `time` (s) and waits until then. `time` must not be before the time
  /// of the previous call. Passes every frame received in between to `take`, ordered by time, then by camera.
  virtual void play_to(double time, const ArmState& state, const TakeFrame& take) = 0;
  /// Advances to `time` like play_to(), but without frames.
  virtual void pass_to(double time, const ArmState& state) = 0;
  /// Discards all frames that were received before now.
  virtual void skip_to_now() = 0;
};

/// Function that makes the rig of an experiment. The Setup must outlive the rig.
using RigFactory = std::function<std::unique_ptr<Rig>(const Setup&)>;

/// Returns a simulated rig (rig/filming.h).
[[nodiscard]] std::unique_ptr<Rig> simulated_rig(const Setup& setup);

/// Returns the rig of the equipment in the experiment's table [rig]. The function connects to all devices,
/// determines the motor positions (RigEquipment::start), and starts the process that stops the devices if
/// this program crashes or hangs (Guard). The destructor stops all devices. The rig's clock shows real time.
///
/// Throws std::runtime_error with one clear line if a device cannot be used, or, later, if a device fails.
/// `is_cancelled`: returns whether the user has asked the program to stop, which ends homing; empty: never.
[[nodiscard]] std::unique_ptr<Rig> equipment_rig(const Setup& setup, std::function<bool()> is_cancelled = {});

/// Returns the rig of an experiment: its equipment if it has a table [rig], otherwise a simulated rig.
[[nodiscard]] std::unique_ptr<Rig> rig_of(const Setup& setup, std::function<bool()> is_cancelled = {});

/// Returns the axis positions that the heads and stages of a rig's cameras report now. `optics`: models of
/// these cameras; their initial positions are used for missing heads or stages. Throws std::runtime_error
/// with the reason if a head or stage does not report.
[[nodiscard]] std::vector<CameraReading> camera_readings(const RigPorts& ports,
                                                         const std::vector<Camera>& optics);

}  // namespace flexura
