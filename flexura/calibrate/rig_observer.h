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

/// A rig estimate, with the numbers of observations that the estimate explains and does not explain.
struct RigReading {
  std::optional<RigProblem> problem;  ///< Estimation problem with the identified observations; always set.
  RigCalibration found;
  /// Number of observations identified as markers and axis points, or as points of the cylinder.
  double things = 0;
  /// Number of these observations that the estimate does not explain, plus the number of unidentified
  /// markers.
  double unexplained = 0;
  /// `things`, minus twice the number of unexplained observations, minus the number of unidentified markers.
  double explained = 0;

  /// Returns whether the rig was found and at most one in twenty observations is unexplained.
  [[nodiscard]] bool is_whole() const { return found.is_found && unexplained <= 0.05 * things; }
};

/// Observer of a session's target, which is the arm or the calibration cylinder. The observer measures the
/// target in pictures, stores the observations, and estimates the rig that explains all observations.
class RigObserver {
 public:
  /// Smallest number of markers of a useful picture if the rig is known. With a known rig, even a few markers
  /// are reliably identified.
  static constexpr std::size_t few = 2;

  virtual ~RigObserver() = default;
  RigObserver(const RigObserver&) = delete;
  RigObserver& operator=(const RigObserver&) = delete;

  /// Records that the session's camera `i` was commanded to move. Later pictures then have another stance.
  void sent(std::size_t i, const RigStance& stance);
  /// Measures a picture of the session's camera `i` and stores its observations, if any. Adds the identified
  /// markers to `observed`. Identifies markers with all stored observations and the previously estimated rig
  /// `found`, if any.
  void see(std::size_t i, const RigModel* found, CameraObservation& observed);
  /// Returns the index of the stance stored since the camera's last move; std::nullopt if no picture was
  /// stored since then.
  [[nodiscard]] const std::optional<std::size_t>& stance(std::size_t i) const { return cameras_[i].stance; }
  /// Returns the number of identifiable markers in the last picture.
  [[nodiscard]] virtual std::size_t markers() const { return 0; }
  /// Returns the position of the visible target in the last picture, px; std::nullopt if nothing was
  /// measured.
  [[nodiscard]] virtual std::optional<Eigen::Vector2d> seen_at() const { return std::nullopt; }

  /// Returns the rig that explains most of the stored observations. `found`: the previous estimate. Finds no
  /// rig if nothing is identified in the pictures of one camera.
  [[nodiscard]] virtual RigReading read(const RigModel* found) const = 0;
  /// Returns the observations in a stored picture, identified with the estimated rig. The indices of stance
  /// and pose in these observations are 0.
  [[nodiscard]] virtual RigImage image_of_observed(const RigModel& model,
                                                   const CameraObservation& observed) const = 0;

 protected:
  explicit RigObserver(const RigModel& nominal) : nominal_(nominal) {}
  /// Returns the commanded arm poses of the stored observations.
  [[nodiscard]] virtual std::vector<ArmState>& poses() = 0;
  /// Returns the measured camera stances of the stored observations.
  [[nodiscard]] virtual std::vector<RigStance>& stances() = 0;
  /// Measures a picture of the session's camera `i`. Returns whether the picture contains information.
  [[nodiscard]] virtual bool look(std::size_t i, const Picture& picture) = 0;
  /// Returns the parts of the last measurement that can be identified with an approximate `view`. Stores
  /// nothing.
  [[nodiscard]] virtual SeenArm unkept(const View& view) const = 0;
  /// Stores the last measurement with this stance and pose. Returns the measurement with the markers
  /// identified by the rig `found`, if any.
  [[nodiscard]] virtual SeenArm keep(std::size_t stance, std::size_t pose, const RigModel* found) = 0;
  /// Returns the estimate with the largest `explained`.
  [[nodiscard]] static RigReading best_of(std::vector<RigReading>& readings);
  [[nodiscard]] const RigModel& model(const RigModel* found) const {
    return found != nullptr ? *found : nominal_;
  }

  const RigModel& nominal_;

 private:
  struct Sent {
    RigStance to;
    bool is_turned = true;  // Since the last stored picture.
    std::optional<std::size_t> stance,
        last;  // Indices of stored stances: since the last move, and before it.
  };
  std::array<Sent, 2> cameras_;
};

/// Returns the observer of a session with this configuration. All arguments must outlive the observer.
/// `target`: modelled target of the cameras, in W, m.
[[nodiscard]] std::unique_ptr<RigObserver> session_observer(const RigModel& nominal, const RigPrior& prior,
                                                            const RigSessionConfig& config,
                                                            const Eigen::Vector3d& target);

/// Returns the observer of a session without calibration cylinder.
[[nodiscard]] std::unique_ptr<RigObserver> arm_observer(const RigModel& nominal, const RigPrior& prior,
                                                        const RigSessionConfig& config,
                                                        const Eigen::Vector3d& target);

}  // namespace flexura
