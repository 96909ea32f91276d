#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "flexura/model/arm_response.h"

namespace flexura {

/// Motion of an arm's drives during a time in which the arm's modes are constant.
struct SwingPath {
  std::vector<SwingMode> modes;
  /// A part of the time in which the rate of the command is constant.
  struct Part {
    double duration = 0;  ///< Duration of the part, s.
    /// Change of each mode's rate at the beginning of the part, 1/s (SwingMode::kick).
    Eigen::VectorXd kicks;
  };
  std::vector<Part> parts;
  Eigen::VectorXd last_rate = {};  ///< Rate of the command in the last part, 1/s; empty without parts.
};

/// Standard deviations of the model of the oscillation.
struct SwingFilterConfig {
  double kick_error = 0.3;       ///< Error of a kick, as a share of the kick.
  double force_noise = 0.1;      ///< Process noise of each mode's rate, rad/s per root second.
  double frequency_error = 0.2;  ///< Initial common error of the logarithms of all frequencies.
  /// Initial additional error of the logarithm of each mode's frequency.
  double mode_frequency_error = 0.15;
  double frequency_noise = 0.02;  ///< Process noise of the logarithms of the frequencies, per root second.
};

/// Estimates the oscillation of an arm about its equilibrium: the modes' coordinates z, their rates z', and a
/// factor on each frequency (docs/estimation.md, "An arm that swings"). The factors correct a wrong stiffness
/// or mass of the model. The filter is an extended Kalman filter on (z, z', logarithms of the factors). This
/// filter is a part of a larger filter. The first of the other unknowns are the bends of the arm's shape,
/// including the oscillation.
class SwingFilter {
 public:
  /// Starts without modes: the oscillation is not tracked.
  explicit SwingFilter(const SwingFilterConfig& config = {}) : config_(config) {}

  /// Discards the modes: the oscillation is not tracked until the next prediction.
  void forget();
  /// Returns whether the oscillation is tracked.
  [[nodiscard]] bool is_tracked() const { return !modes_.empty(); }

  /// Predicts the oscillation along a path. If the number of modes changes, the modes start at rest.
  /// `covariance`: covariance of the other unknowns, which is predicted too. The other unknowns begin with
  /// the arcs' bends; `bends`: number of bends per arc. Returns the change of bend_x, bend_y and stretch of
  /// each arc; empty if the path has no modes.
  [[nodiscard]] Eigen::VectorXd predict(const SwingPath& path, Eigen::Index bends,
                                        Eigen::MatrixXd& covariance);
  /// Updates the oscillation with an estimate of the other unknowns. `innovation`: estimate minus prediction.
  /// `predicted`: covariance of the prediction. `estimated`: covariance of the estimate. `is_update`: whether
  /// the estimate includes the prediction; otherwise it uses only the pictures.
  void update(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& predicted,
              const Eigen::MatrixXd& estimated, bool is_update);

  /// Returns the change of bend_x, bend_y and stretch of each arc due to the present oscillation; empty if it
  /// is not tracked.
  [[nodiscard]] Eigen::VectorXd shape() const;
  /// Returns z of all modes, then z', at the end of a path that starts now; empty if the oscillation is not
  /// tracked.
  [[nodiscard]] Eigen::VectorXd after(const SwingPath& path) const;
  /// Returns the modes of the oscillation.
  [[nodiscard]] const std::vector<SwingMode>& modes() const { return modes_; }
  /// Returns the factors on the modes' frequencies.
  [[nodiscard]] Eigen::VectorXd frequency_factors() const;
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }

 private:
  SwingFilterConfig config_;
  std::vector<SwingMode> modes_;
  Eigen::VectorXd mean_;        // z, z', logarithms of the factors on the frequencies.
  Eigen::MatrixXd covariance_;  // Of mean_.
  Eigen::MatrixXd cross_;       // Of the other unknowns (rows) with mean_ (columns).
};

}  // namespace flexura
