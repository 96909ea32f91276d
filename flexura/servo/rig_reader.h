#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "flexura/camera/camera.h"
#include "flexura/port/rig_model.h"
#include "flexura/port/rig_ports.h"
#include "flexura/servo/motion_history.h"

namespace flexura {

/// Two pictures that belong together, and how the cameras are believed to have seen then.
struct PicturePair {
  std::array<Frame, 2> frames;
  std::array<View, 2> views;

  /// Middle of the exposures, s.
  [[nodiscard]] double time() const { return 0.5 * (frames[0].time + frames[1].time); }
};

/// Reads a rig's devices: the newest pictures that belong together, and what arm, heads and stages said of
/// themselves when these were taken.
class RigReader {
 public:
  struct Times {
    double span = 0;      ///< Readings are kept for so long, s.
    double together = 0;  ///< Pictures of both cameras that were taken within that belong together, s.
    double silent = 0;    ///< What a device says of an earlier time than so long ago is no answer, s.
  };
  /// `believed` outlives this.
  RigReader(const RigPorts& ports, const RigModel& believed, const std::array<std::size_t, 2>& cameras,
            const Times& times);

  using Trouble = std::optional<std::string>;
  /// Asks arm, heads and stages where they are; why it cannot be known is trouble (rig_readings.h), and so is
  /// a time that is yet to come or long gone.
  [[nodiscard]] Trouble read();
  /// Asks the cameras for pictures; a pair, when there is a new one. A camera that does not answer, or whose
  /// picture's time is none, is yet to come or before that of the one before, has none: `silence` says why.
  [[nodiscard]] std::optional<PicturePair> newest_pair();
  /// Why a camera gave no picture when it was last asked, with its name; "": each answered.
  [[nodiscard]] std::string silence() const;
  /// Whose pictures have not come since a time, s: why there is no pair.
  [[nodiscard]] std::string no_pair(double since) const;

  /// What the drives said, and what the model makes of it, at a time.
  [[nodiscard]] ArmState said(double time) const { return *arm_.at(time); }
  [[nodiscard]] ArmState believed(double time) const { return model_.bent(said(time)); }
  /// What the cameras saw at a time, as believed.
  [[nodiscard]] std::array<View, 2> views(double time) const { return {view(0, time), view(1, time)}; }
  /// How one stood, as its head and stage say.
  [[nodiscard]] CameraStance stance(std::size_t i, double time) const { return *stances_[i].at(time); }

  [[nodiscard]] double now() const { return ports_.clock->now(); }
  [[nodiscard]] const RigPorts& ports() const { return ports_; }
  /// The port of one of the two.
  [[nodiscard]] const CameraPorts& camera(std::size_t i) const { return ports_.cameras[cameras_[i]]; }
  [[nodiscard]] const std::string& name(std::size_t i) const { return camera(i).name; }
  /// A reason with the cameras' names, where an estimator counts pictures.
  [[nodiscard]] std::string by_name(std::string reason) const;

 private:
  using StateBlend = ArmState (*)(const ArmState&, const ArmState&, double);
  using StanceBlend = CameraStance (*)(const CameraStance&, const CameraStance&, double);
  [[nodiscard]] View view(std::size_t i, double time) const { return optics_[i].view(stance(i, time)); }
  // Of what a device says, and of a picture after those before it; none, "": nothing.
  [[nodiscard]] Trouble odd_time(const std::string& device, double time) const;
  [[nodiscard]] std::string odd_time(const Frame& frame, const std::deque<Frame>& before) const;
  // Asks both cameras.
  void take_newest();

  RigPorts ports_;
  const RigModel& model_;
  std::array<std::size_t, 2> cameras_;
  std::array<Camera, 2> optics_;  // As they are believed to be.
  Times times_;
  MotionHistory<ArmState, StateBlend> arm_;
  std::array<MotionHistory<CameraStance, StanceBlend>, 2> stances_;
  std::array<std::deque<Frame>, 2> recent_;
  std::array<double, 2> paired_at_ = {-1, -1};  // s
  std::array<std::string, 2> silence_;
};

}  // namespace flexura
