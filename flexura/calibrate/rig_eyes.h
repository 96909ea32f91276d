#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_problem.h"
#include "flexura/calibrate/rig_session.h"

namespace flexura {

/// A rig as it was found, and by what: markers that were taken for others count against it.
struct RigReading {
  std::optional<RigProblem> problem;  ///< Of what was recognised; there always is one.
  RigCalibration found;
  double things = 0;     ///< What was taken for the arm's markers and axis points, or the cylinder's.
  double amiss = 0;      ///< Of them those that the rig does not explain, and markers of nobody.
  double explained = 0;  ///< Things, less twice those that it does not explain, and less markers of nobody.

  /// Whether it is found, and no more than a twentieth is amiss.
  [[nodiscard]] bool is_whole() const { return found.is_found && amiss <= 0.05 * things; }
};

/// What a session looks at, the arm or the calibration cylinder: measures it in pictures, keeps what was
/// seen, and finds the rig that explains all of it.
class RigEyes {
 public:
  /// Of a rig that is known a few markers tell more, and are hardly taken for others.
  static constexpr std::size_t few = 2;

  virtual ~RigEyes() = default;
  RigEyes(const RigEyes&) = delete;
  RigEyes& operator=(const RigEyes&) = delete;

  /// The session's camera `i` was sent there: what it sees from now on it sees from another stance.
  void sent(std::size_t i, const RigStance& stance);
  /// Measures a picture of the session's camera `i`, keeps what it shows, if anything, and fills in what that
  /// is, by all that is kept and the rig that was `found` before, if there is one.
  void see(std::size_t i, const RigModel* found, RigSight& sight);
  /// From which of the kept stances the camera has looked since it was sent; none yet.
  [[nodiscard]] const std::optional<std::size_t>& stance(std::size_t i) const { return cameras_[i].stance; }
  /// Markers that can be recognised, in the last picture.
  [[nodiscard]] virtual std::size_t markers() const { return 0; }
  /// Where in the picture something of it was measured last, px, if anything was.
  [[nodiscard]] virtual std::optional<Eigen::Vector2d> whereabouts() const { return std::nullopt; }

  /// The rig that explains most of what was kept; `found`: the one before. None where a camera recognises
  /// nothing.
  [[nodiscard]] virtual RigReading read(const RigModel* found) const = 0;
  /// What a picture that was kept shows, by the rig as found, for stance and pose 0.
  [[nodiscard]] virtual RigImage told(const RigModel& model, const RigSight& sight) const = 0;

 protected:
  explicit RigEyes(const RigModel& believed) : believed_(believed) {}
  /// The commanded poses and the stances, as read, of what is kept.
  [[nodiscard]] virtual std::vector<ArmState>& poses() = 0;
  [[nodiscard]] virtual std::vector<RigStance>& stances() = 0;
  /// Measures a picture of the session's camera `i`. Whether it tells anything.
  [[nodiscard]] virtual bool look(std::size_t i, const Picture& picture) = 0;
  /// What was measured last, as far as it says what it is without being kept. `view`: as far as it is known.
  [[nodiscard]] virtual SeenArm unkept(const View& view) const = 0;
  /// Keeps what was measured last, seen from this stance in this pose. What it is, by the rig that was found
  /// before, if there is one.
  [[nodiscard]] virtual SeenArm keep(std::size_t stance, std::size_t pose, const RigModel* found) = 0;
  /// The one that explains most.
  [[nodiscard]] static RigReading best_of(std::vector<RigReading>& readings);
  [[nodiscard]] const RigModel& model(const RigModel* found) const {
    return found != nullptr ? *found : believed_;
  }

  const RigModel& believed_;

 private:
  struct Sent {
    RigStance to;
    bool is_turned = true;                    // Since the last picture that was kept.
    std::optional<std::size_t> stance, last;  // Of what is kept: since it was sent, and before.
  };
  std::array<Sent, 2> cameras_;
};

/// Those of a session with this configuration, which outlives them as the others do. `target`: what the
/// cameras are believed to look at, in W, m.
[[nodiscard]] std::unique_ptr<RigEyes> session_eyes(const RigModel& believed, const RigPrior& prior,
                                                    const RigSessionConfig& config,
                                                    const Eigen::Vector3d& target);

/// The same before the arm alone.
[[nodiscard]] std::unique_ptr<RigEyes> arm_eyes(const RigModel& believed, const RigPrior& prior,
                                                const RigSessionConfig& config,
                                                const Eigen::Vector3d& target);

}  // namespace flexura
