#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "flexura/model/arm_response.h"

namespace flexura {

/// Motion of an arm's drives over a time during which its modes stay the same.
struct SwingPath {
  std::vector<SwingMode> modes;
  /// A part of the time with a constant rate of the command.
  struct Part {
    double duration = 0;    ///< s
    Eigen::VectorXd kicks;  ///< Change of each mode's rate at its beginning, 1/s (SwingMode::kick).
  };
  std::vector<Part> parts;
  Eigen::VectorXd last_rate = {};  ///< Rate of the command in the last part, 1/s; empty without parts.
};

/// Standard deviations of the swing's model.
struct SwingFilterConfig {
  double kick_error = 0.3;             ///< Error of a kick, share of it.
  double force_noise = 0.1;            ///< Process noise of each mode's rate, rad/s per root second.
  double frequency_error = 0.2;        ///< Initial error of the logarithms of all frequencies, in common.
  double mode_frequency_error = 0.15;  ///< Initial error of each mode's in addition.
  double frequency_noise = 0.02;       ///< Process noise of these logarithms, per root second.
};

/// Estimates the swing of an arm about its equilibrium: the modes' coordinates z, their rates z', and a
/// factor on each frequency (docs/estimation.md, "An arm that swings"). The factors correct a wrong stiffness
/// or mass of the model. An extended Kalman filter on (z, z', logarithms of the factors). It is a part of a
/// larger one, whose other unknowns begin with the bends of the arm's shape, swing included.
class SwingFilter {
 public:
  /// Starts at rest, not tracked.
  explicit SwingFilter(const SwingFilterConfig& config = {}) : config_(config) {}

  /// Forgets the swing: the arm is at rest, as far as known.
  void forget();
  /// Returns whether the swing is tracked.
  [[nodiscard]] bool is_tracked() const { return !modes_.empty(); }

  /// Advances the swing along a path. Modes of another number start anew, at rest. `covariance`: of the other
  /// unknowns, advanced too; they begin with `bends` numbers (bend_x, bend_y) for each arc. Returns the
  /// change of (bend_x, bend_y, stretch) of each arc; empty if the path has no modes.
  [[nodiscard]] Eigen::VectorXd predict(const SwingPath& path, Eigen::Index bends,
                                        Eigen::MatrixXd& covariance);
  /// Updates the swing by an estimate of the other unknowns. `innovation`: estimate minus prediction;
  /// `predicted`: covariance of the prediction; `estimated`: of the estimate. `is_update`: the estimate
  /// contains the prediction; otherwise it is by the pictures alone.
  void update(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& predicted,
              const Eigen::MatrixXd& estimated, bool is_update);

  /// Returns the change of (bend_x, bend_y, stretch) of each arc by the present swing; empty if not tracked.
  [[nodiscard]] Eigen::VectorXd shape() const;
  /// Returns z of all modes, then z', after a path from the present with these modes; empty if not tracked.
  [[nodiscard]] Eigen::VectorXd after(const SwingPath& path) const;
  /// Returns the modes that the swing is made of.
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
