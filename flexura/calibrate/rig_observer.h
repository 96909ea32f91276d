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

/// A rig estimate, with the numbers of observations that it explains and does not explain.
struct RigReading {
  std::optional<RigProblem> problem;  ///< Problem with the identified observations; always set.
  RigCalibration found;
  /// Number of observations identified as markers and axis points, or as points of the cylinder.
  double things = 0;
  double unexplained = 0;  ///< Number of these observations that the rig does not explain, plus the number of
                           ///< unidentified markers.
  /// `things`, minus twice the number of unexplained observations, minus the number of unidentified markers.
  double explained = 0;

  /// Returns whether the rig was found and at most a twentieth of the observations is unexplained.
  [[nodiscard]] bool is_whole() const { return found.is_found && unexplained <= 0.05 * things; }
};

/// Observer of a session's target, which is the arm or the calibration cylinder. It measures the target in
/// pictures, stores the observations, and estimates the rig that explains all observations.
class RigObserver {
 public:
  /// Fewest markers of a useful picture if the rig is known. Even a few markers are then hardly
  /// misidentified.
  static constexpr std::size_t few = 2;

  virtual ~RigObserver() = default;
  RigObserver(const RigObserver&) = delete;
  RigObserver& operator=(const RigObserver&) = delete;

  /// Records that the session's camera `i` was commanded to move: later pictures have another stance.
  void sent(std::size_t i, const RigStance& stance);
  /// Measures a picture of the session's camera `i` and stores its observations, if any. Fills in which
  /// markers were identified, with all stored observations and the previously estimated rig `found`, if any.
  void see(std::size_t i, const RigModel* found, CameraObservation& observed);
  /// Returns the index of the stance stored since the camera's last move; empty if no picture was stored
  /// since.
  [[nodiscard]] const std::optional<std::size_t>& stance(std::size_t i) const { return cameras_[i].stance; }
  /// Returns the number of identifiable markers in the last picture.
  [[nodiscard]] virtual std::size_t markers() const { return 0; }
  /// Returns the position of the visible target in the last picture, px; empty if nothing was measured.
  [[nodiscard]] virtual std::optional<Eigen::Vector2d> seen_at() const { return std::nullopt; }

  /// Returns the rig that explains most of the stored observations. `found`: the previous estimate. Not found
  /// if nothing is identified in the pictures of one camera.
  [[nodiscard]] virtual RigReading read(const RigModel* found) const = 0;
  /// Returns the observations in a stored picture, identified with the estimated rig, with stance and pose 0.
  [[nodiscard]] virtual RigImage image_of_observed(const RigModel& model,
                                                   const CameraObservation& observed) const = 0;

 protected:
  explicit RigObserver(const RigModel& nominal) : nominal_(nominal) {}
  /// Returns the commanded arm poses of the stored observations.
  [[nodiscard]] virtual std::vector<ArmState>& poses() = 0;
  /// Returns the camera stances of the stored observations as read.
  [[nodiscard]] virtual std::vector<RigStance>& stances() = 0;
  /// Measures a picture of the session's camera `i`; returns whether it contains information.
  [[nodiscard]] virtual bool look(std::size_t i, const Picture& picture) = 0;
  /// Returns what can be identified in the last measurement with an approximate `view`, without storing it.
  [[nodiscard]] virtual SeenArm unkept(const View& view) const = 0;
  /// Stores the last measurement with this stance and pose. Returns it with the markers identified by the rig
  /// `found`, if any.
  [[nodiscard]] virtual SeenArm keep(std::size_t stance, std::size_t pose, const RigModel* found) = 0;
  /// Returns the reading with the largest `explained`.
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

/// Returns the observer for the arm alone.
[[nodiscard]] std::unique_ptr<RigObserver> arm_observer(const RigModel& nominal, const RigPrior& prior,
                                                        const RigSessionConfig& config,
                                                        const Eigen::Vector3d& target);

}  // namespace flexura
