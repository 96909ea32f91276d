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

/// A rig estimate with its evidence; misidentified markers count against it.
struct RigReading {
  std::optional<RigProblem> problem;  ///< Problem of the identified observations; always set.
  RigCalibration found;
  /// Number of observations identified as markers and axis points, or as points of the cylinder.
  double things = 0;
  double unexplained = 0;  ///< Number of them that the rig does not explain, plus unidentified markers.
  /// `things`, minus twice those that it does not explain, minus unidentified markers.
  double explained = 0;

  /// Returns whether it was found with at most a twentieth amiss.
  [[nodiscard]] bool is_whole() const { return found.is_found && unexplained <= 0.05 * things; }
};

/// Observer of the target of a session, the arm or the calibration cylinder. It measures the target in
/// pictures, stores the observations, and finds the rig that explains all of them.
class RigObserver {
 public:
  /// For a known rig, a few markers give more information and are hardly misidentified.
  static constexpr std::size_t few = 2;

  virtual ~RigObserver() = default;
  RigObserver(const RigObserver&) = delete;
  RigObserver& operator=(const RigObserver&) = delete;

  /// Records that the session's camera `i` was commanded to move: later pictures have another stance.
  void sent(std::size_t i, const RigStance& stance);
  /// Measures a picture of the session's camera `i` and stores what it shows, if anything. Fills in its
  /// identification by all stored observations and the rig `found` before, if any.
  void see(std::size_t i, const RigModel* found, CameraObservation& observed);
  /// Returns the stored stance from which the camera has looked since its last move; empty if it has not yet.
  [[nodiscard]] const std::optional<std::size_t>& stance(std::size_t i) const { return cameras_[i].stance; }
  /// Returns the number of identifiable markers in the last picture.
  [[nodiscard]] virtual std::size_t markers() const { return 0; }
  /// Returns the position of the last measured part in the picture, px; empty if nothing was measured.
  [[nodiscard]] virtual std::optional<Eigen::Vector2d> seen_at() const { return std::nullopt; }

  /// Returns the rig that explains most of what is stored; `found` is the previous one. Not found if a camera
  /// identifies nothing.
  [[nodiscard]] virtual RigReading read(const RigModel* found) const = 0;
  /// Returns the content of a stored picture as identified by the estimated rig, with stance and pose 0.
  [[nodiscard]] virtual RigImage image_of_observed(const RigModel& model,
                                                   const CameraObservation& observed) const = 0;

 protected:
  explicit RigObserver(const RigModel& nominal) : nominal_(nominal) {}
  /// Commanded poses, and stances as read, of the stored observations.
  [[nodiscard]] virtual std::vector<ArmState>& poses() = 0;
  [[nodiscard]] virtual std::vector<RigStance>& stances() = 0;
  /// Measures a picture of the session's camera `i`; returns whether it contains information.
  [[nodiscard]] virtual bool look(std::size_t i, const Picture& picture) = 0;
  /// Returns what can be identified in the last measurement without storing it, for an approximate `view`.
  [[nodiscard]] virtual SeenArm unkept(const View& view) const = 0;
  /// Stores the last measurement with this stance and pose. Returns its identification by the rig found
  /// before, if any.
  [[nodiscard]] virtual SeenArm keep(std::size_t stance, std::size_t pose, const RigModel* found) = 0;
  /// Returns the reading that explains most.
  [[nodiscard]] static RigReading best_of(std::vector<RigReading>& readings);
  [[nodiscard]] const RigModel& model(const RigModel* found) const {
    return found != nullptr ? *found : nominal_;
  }

  const RigModel& nominal_;

 private:
  struct Sent {
    RigStance to;
    bool is_turned = true;                    // Since the last stored picture.
    std::optional<std::size_t> stance, last;  // Stored stances: since the last move, and before.
  };
  std::array<Sent, 2> cameras_;
};

/// Returns the observer of a session with this configuration. All arguments must outlive it. `target`:
/// modelled target of the cameras, in W, m.
[[nodiscard]] std::unique_ptr<RigObserver> session_observer(const RigModel& nominal, const RigPrior& prior,
                                                            const RigSessionConfig& config,
                                                            const Eigen::Vector3d& target);

/// Returns the observer for the arm alone.
[[nodiscard]] std::unique_ptr<RigObserver> arm_observer(const RigModel& nominal, const RigPrior& prior,
                                                        const RigSessionConfig& config,
                                                        const Eigen::Vector3d& target);

}  // namespace flexura
