#pragma once

#include <string>
#include <vector>

namespace flexura {

/// What a run under an artificial potential has of energy at one time, J.
struct LyapunovSample {
  double time = 0;       ///< s
  double kinetic = 0;    ///< T
  double potential = 0;  ///< Pi
  double gravity = 0;    ///< V_g; leave it at 0 where it is part of Pi, as V_e.
  double elastic = 0;    ///< V_e
  double taken = 0;      ///< By the law's damping since the start: the integral of x_t K x_t.
  double damped = 0;     ///< By the arm's own damping since the start.
};

/// What a run says of the theory's conditions.
struct LyapunovVerdict {
  bool is_monotone = false;  ///< W = T + Pi never rose.
  bool is_balanced = false;  ///< W fell by what damping took, and by that alone.
  bool is_settled = false;   ///< At the end W is small.
  double largest_rise = 0;   ///< Of W from any time to a later one, J.
  double imbalance = 0;      ///< The largest |W - W(0) + taken + damped|, J.
  /// The shares of dV_g/dx and dV_e/dx that nothing compensated, and what the potential's force lacks of its
  /// own (2: it has the other sign), as far as these explain the imbalance (docs/control.md, eq. 11).
  double gravity_share = 0, elastic_share = 0, potential_share = 0;
  std::vector<std::string> reasons;  ///< In words; empty for a run as the theory has it.

  /// The run is as the theory has it.
  [[nodiscard]] bool is_good() const { return reasons.empty(); }
};

/// Watches W = T + Pi along a run; keeps every sample.
class LyapunovMonitor {
 public:
  /// `tolerance`: of W's balance, share of the energies in play. `settled`: what may be left of W in the end,
  /// share of W at the start. `rounding`: how much W is not known to whatever came into play, J.
  explicit LyapunovMonitor(double tolerance = 1e-6, double settled = 1e-3, double rounding = 0);

  /// std::invalid_argument: a number that is not finite, a time not after the last one.
  void add(const LyapunovSample& sample);
  /// Of all samples so far; std::logic_error for fewer than two.
  [[nodiscard]] LyapunovVerdict verdict() const;

 private:
  void explain(LyapunovVerdict& verdict, double scale) const;

  double tolerance_, settled_, rounding_;
  std::vector<LyapunovSample> samples_;
};

}  // namespace flexura
