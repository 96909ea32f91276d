#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace flexura {

/// Tolerances and limits for solving an ordinary differential equation.
struct OdeTolerance {
  double relative = 1e-9;  ///< Relative error tolerance of each component per step.
  /// Absolute error tolerance per step, in the units of y; added to the relative tolerance.
  double absolute = 1e-12;
  double first_step = 1e-3;  ///< First step size to try, in units of time; > 0.
  double largest_step = std::numeric_limits<double>::infinity();  ///< Largest step size, in units of time.
  int most_steps = 1'000'000;  ///< Largest number of steps in one advance, including rejected steps.
};

/// Solves dy/dt = f(t, y) by the explicit Runge-Kutta pair of order 5(4) with adaptive steps (Dormand,
/// Prince, "A family of embedded Runge-Kutta formulae", 1980). The step size rule is from Hairer, Norsett,
/// Wanner, "Solving Ordinary Differential Equations I", II.4. Allocates nothing after the constructor.
class DormandPrince {
 public:
  /// Makes a solver for `size` components of y.
  explicit DormandPrince(Eigen::Index size, const OdeTolerance& tolerance = {})
      : tolerance_(tolerance), step_(tolerance.first_step), trial_(size) {
    for (Eigen::VectorXd& slope : slopes_) slope.resize(size);
  }

  /// Result of an advance.
  struct Progress {
    /// Whether the time `until` was reached. If `until` was not reached, the number of steps reached its
    /// limit, the step size became too small, or go_on() stopped the advance. After such an end, t and y have
    /// the values of the last accepted step.
    bool is_there = false;
    int steps = 0, taken_back = 0;  ///< Numbers of accepted steps, and of steps rejected for their error.
  };

  /// Advances from (t, y) to exactly the time `until` >= t. f(t, y, slope) writes dy/dt into `slope`. The
  /// solver calls go_on() before every step. If go_on() returns false, the advance stops.
  template <class Function, class GoOn = bool (*)()>
  Progress advance(Function&& f, double& t, Eigen::VectorXd& y, double until, GoOn go_on = always) {
    Progress progress;
    f(t, y, slopes_[0]);
    while (t < until) {
      if (progress.steps + progress.taken_back == tolerance_.most_steps || !go_on()) return progress;
      const double desired = std::min(step_, tolerance_.largest_step);
      const bool is_last = t + desired >= until;
      const double h = is_last ? until - t : desired;
      if (!is_last && !(t + h > t)) return progress;
      const double error = attempt(f, t, y, h);
      const double factor =
          std::isfinite(error) ? std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.2, 5.0) : 0.2;
      if (error <= 1) {
        t = is_last ? until : t + h;
        y.swap(trial_);
        slopes_[0].swap(slopes_[6]);
        ++progress.steps;
        if (!is_last || factor < 1) step_ = h * factor;
      } else {
        ++progress.taken_back;
        step_ = h * std::min(factor, 1.0);
      }
    }
    progress.is_there = true;
    return progress;
  }

 private:
  static bool always() { return true; }

  // Computes trial_, which is y after a step h, and slopes_[6], which is dy/dt at its end. Returns the root
  // mean square of the error in units of the tolerance.
  template <class Function>
  double attempt(Function& f, double t, const Eigen::VectorXd& y, double h) {
    auto& k = slopes_;
    trial_ = y + h * (1.0 / 5 * k[0]);
    f(t + h / 5, trial_, k[1]);
    trial_ = y + h * (3.0 / 40 * k[0] + 9.0 / 40 * k[1]);
    f(t + 3 * h / 10, trial_, k[2]);
    trial_ = y + h * (44.0 / 45 * k[0] - 56.0 / 15 * k[1] + 32.0 / 9 * k[2]);
    f(t + 4 * h / 5, trial_, k[3]);
    trial_ =
        y + h * (19372.0 / 6561 * k[0] - 25360.0 / 2187 * k[1] + 64448.0 / 6561 * k[2] - 212.0 / 729 * k[3]);
    f(t + 8 * h / 9, trial_, k[4]);
    trial_ = y + h * (9017.0 / 3168 * k[0] - 355.0 / 33 * k[1] + 46732.0 / 5247 * k[2] + 49.0 / 176 * k[3] -
                      5103.0 / 18656 * k[4]);
    f(t + h, trial_, k[5]);
    trial_ = y + h * (35.0 / 384 * k[0] + 500.0 / 1113 * k[2] + 125.0 / 192 * k[3] - 2187.0 / 6784 * k[4] +
                      11.0 / 84 * k[5]);
    f(t + h, trial_, k[6]);
    double sum = 0;
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const double off = h * (71.0 / 57600 * k[0][i] - 71.0 / 16695 * k[2][i] + 71.0 / 1920 * k[3][i] -
                              17253.0 / 339200 * k[4][i] + 22.0 / 525 * k[5][i] - 1.0 / 40 * k[6][i]);
      const double scale =
          tolerance_.absolute + tolerance_.relative * std::max(std::abs(y[i]), std::abs(trial_[i]));
      sum += (off / scale) * (off / scale);
    }
    return std::sqrt(sum / static_cast<double>(std::max<Eigen::Index>(y.size(), 1)));
  }

  OdeTolerance tolerance_;
  double step_;
  Eigen::VectorXd trial_;
  std::array<Eigen::VectorXd, 7> slopes_;
};

}  // namespace flexura
