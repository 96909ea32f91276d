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

/// A frame that was filmed.
struct FilmedFrame {
  std::string camera;
  Frame frame;
  std::string message = {};  ///< Its logged_image, where that was made on the way; "": the log makes it.
};

/// The true state of a rig, which its ports do not give: not for algorithms.
class RigTruth {
 public:
  virtual ~RigTruth() = default;
  RigTruth() = default;
  RigTruth(const RigTruth&) = delete;
  RigTruth& operator=(const RigTruth&) = delete;

  /// Where a camera truly stands now.
  [[nodiscard]] virtual RigStance stance(std::size_t camera) = 0;
  /// How the arm truly lay at a time not long ago, s.
  [[nodiscard]] virtual Backbone backbone(double time) = 0;
  /// By which each of its tendons pulled then, N; empty: of an arm without forces.
  [[nodiscard]] virtual std::vector<double> tensions(double /*time*/) { return {}; }
  /// How far its drives had each tendon pulled in then, m; empty: not known.
  [[nodiscard]] virtual std::vector<double> pulled(double /*time*/) { return {}; }
  /// Of its motion, its strains and its weight then; none: it has no inertia, or nobody knows.
  [[nodiscard]] virtual std::optional<RodEnergy> energy(double /*time*/) { return std::nullopt; }
  /// Where it touched something then.
  [[nodiscard]] virtual std::vector<PlantContact> contacts(double /*time*/) { return {}; }
  /// What was out of the ordinary in how it lay then, one line; "": nothing.
  [[nodiscard]] virtual std::string warning(double /*time*/) { return {}; }
  /// How many microsteps each motor had lost by then, unknown to its controller; empty: none ever.
  [[nodiscard]] virtual std::vector<double> lost_steps(double /*time*/) { return {}; }
};

/// A rig on which an experiment is played, simulated or real: its ports, and how its time passes.
class Rig {
 public:
  virtual ~Rig() = default;
  Rig() = default;
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  /// Valid as long as the rig.
  [[nodiscard]] virtual RigPorts ports() = 0;
  /// Null where nobody knows it: of equipment.
  [[nodiscard]] virtual RigTruth* truth() { return nullptr; }
  /// Nothing comes to harm: then it is played through motions that are unsafe, too, to be looked at.
  [[nodiscard]] virtual bool is_simulated() const { return false; }

  using TakeFrame = std::function<void(const FilmedFrame&)>;
  /// Commands the arm to be in `state` at `time` s, not before the call's before, waits until then, and gives
  /// every frame received on the way, in the order of time and then of the cameras.
  virtual void play_to(double time, const ArmState& state, const TakeFrame& take) = 0;
  /// The same, and no frame is taken on the way.
  virtual void pass_to(double time, const ArmState& state) = 0;
  /// Frames received up to now are not handed out any more.
  virtual void skip_to_now() = 0;
};

/// Makes the rig of an experiment, which outlives it.
using RigFactory = std::function<std::unique_ptr<Rig>(const Setup&)>;

/// The factory of simulated rigs (rig/filming.h).
[[nodiscard]] std::unique_ptr<Rig> simulated_rig(const Setup& setup);

/// Where the cameras of a rig say that they stand now, and where `optics`, these cameras as they are believed
/// to be, start those without heads or stages. std::runtime_error with what is wrong where one does not say.
[[nodiscard]] std::vector<CameraReading> camera_readings(const RigPorts& ports,
                                                         const std::vector<Camera>& optics);

}  // namespace flexura
