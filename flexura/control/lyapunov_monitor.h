#pragma once

#include <string>
#include <vector>

namespace flexura {

/// Energies of an arm under an artificial potential at one time, J.
struct LyapunovSample {
  double time = 0;       ///< Time, s.
  double kinetic = 0;    ///< T.
  double potential = 0;  ///< Pi.
  double gravity = 0;    ///< V_g, J; 0 if Pi includes V_g.
  double elastic = 0;    ///< V_e, J; 0 if Pi includes V_e.
  double taken = 0;      ///< Energy removed by the law's damping since the start: the integral of x_t K x_t.
  double damped = 0;     ///< Energy removed by the arm's own damping since the start.
};

/// Agreement of a run with the theory.
struct LyapunovVerdict {
  bool is_monotone = false;  ///< Whether W = T + Pi never increased.
  bool is_balanced = false;  ///< Whether the decrease of W equals the dissipated energy.
  bool is_settled = false;   ///< Whether W is small at the end.
  double largest_rise = 0;   ///< Largest increase of W from any time to a later time, J.
  double imbalance = 0;      ///< Largest |W - W(0) + taken + damped|, J.
  /// Shares of dV_g/dx and dV_e/dx that were not compensated, and missing share of the potential's force (2:
  /// the force has the opposite sign). The shares are fitted to the imbalance (docs/control.md, eq. 11).
  double gravity_share = 0, elastic_share = 0, potential_share = 0;
  std::vector<std::string>
      reasons;  ///< Violated conditions in words; empty if the run agrees with the theory.

  /// Returns true if the run agrees with the theory.
  [[nodiscard]] bool is_good() const { return reasons.empty(); }
};

/// Monitors W = T + Pi during a run. Keeps every sample.
class LyapunovMonitor {
 public:
  /// `tolerance`: largest allowed imbalance of W, as a share of the energies in the run. `settled`: largest
  /// allowed final W, as a share of W at the start. `rounding`: numerical uncertainty of W, J.
  explicit LyapunovMonitor(double tolerance = 1e-6, double settled = 1e-3, double rounding = 0);

  /// Adds a sample. Throws std::invalid_argument for a number that is not finite, or a time that is not after
  /// the previous time.
  void add(const LyapunovSample& sample);
  /// Returns the result for all samples so far. Throws std::logic_error if there are fewer than two samples.
  [[nodiscard]] LyapunovVerdict verdict() const;

 private:
  void explain(LyapunovVerdict& verdict, double scale) const;

  double tolerance_, settled_, rounding_;
  std::vector<LyapunovSample> samples_;
};

}  // namespace flexura
