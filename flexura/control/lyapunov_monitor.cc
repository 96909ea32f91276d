#include "flexura/control/lyapunov_monitor.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

double lyapunov_value(const LyapunovSample& sample) { return sample.kinetic + sample.potential; }

// Scale of the energies in the run. For an arm at rest they are rounding errors.
constexpr double rounding_share = 1e-12;
double energy_scale(const std::vector<LyapunovSample>& samples) {
  double scale =
      rounding_share * std::max(std::abs(samples.front().gravity), std::abs(samples.front().elastic));
  for (const LyapunovSample& sample : samples)
    scale =
        std::max({scale, std::abs(lyapunov_value(sample)), std::abs(sample.gravity - samples.front().gravity),
                  std::abs(sample.elastic - samples.front().elastic)});
  return std::max(scale, 1e-300);
}

}  // namespace

LyapunovMonitor::LyapunovMonitor(double tolerance, double settled, double rounding)
    : tolerance_(tolerance), settled_(settled), rounding_(rounding) {}

void LyapunovMonitor::add(const LyapunovSample& sample) {
  for (const double number : {sample.time, sample.kinetic, sample.potential, sample.gravity, sample.elastic,
                              sample.taken, sample.damped})
    if (!std::isfinite(number)) throw std::invalid_argument("an energy sample must be finite");
  if (!samples_.empty() && !(sample.time > samples_.back().time))
    throw std::invalid_argument("the times of energy samples must increase");
  samples_.push_back(sample);
}

LyapunovVerdict LyapunovMonitor::verdict() const {
  if (samples_.size() < 2) throw std::logic_error("a verdict on a run needs at least two energy samples");
  LyapunovVerdict verdict;
  const LyapunovSample& start = samples_.front();
  double least = lyapunov_value(start);
  for (const LyapunovSample& sample : samples_) {
    const double value = lyapunov_value(sample);
    verdict.largest_rise = std::max(verdict.largest_rise, value - least);
    least = std::min(least, value);
    verdict.imbalance = std::max(verdict.imbalance, std::abs(value - lyapunov_value(start) + sample.taken -
                                                             start.taken + sample.damped - start.damped));
  }
  const double scale = std::max(energy_scale(samples_), rounding_ / tolerance_);
  verdict.is_monotone = verdict.largest_rise <= tolerance_ * scale;
  verdict.is_balanced = verdict.imbalance <= tolerance_ * scale;
  verdict.is_settled = std::abs(lyapunov_value(samples_.back())) <=
                       settled_ * lyapunov_value(start) + std::max(rounding_, rounding_share * scale);
  explain(verdict, scale);
  return verdict;
}

// docs/control.md, eq. 11: the imbalance is a sum of three known curves, each times its share.
void LyapunovMonitor::explain(LyapunovVerdict& verdict, double scale) const {
  const LyapunovSample &start = samples_.front(), &end = samples_.back();
  double least_taken = 0;  // Least energy that damping removed between two samples.
  for (std::size_t i = 1; i < samples_.size(); ++i)
    least_taken = std::min(least_taken, samples_[i].taken - samples_[i - 1].taken);
  if (least_taken < -tolerance_ * scale)
    verdict.reasons.emplace_back("the damping K is not positive: it added energy to the arm");
  else if (end.taken - start.taken + end.damped - start.damped <= tolerance_ * scale && !verdict.is_settled)
    verdict.reasons.emplace_back("damping removed no energy from the arm");
  if (lyapunov_value(end) < -tolerance_ * scale && end.potential < 0)
    verdict.reasons.emplace_back(
        "the potential has no minimum at the target: during the run, it was lower than at the target");
  if (!verdict.is_balanced) {
    const auto count = static_cast<Eigen::Index>(samples_.size());
    Eigen::MatrixX3d courses(count, 3);
    Eigen::VectorXd imbalance(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const LyapunovSample& sample = samples_[static_cast<std::size_t>(i)];
      courses.row(i) << start.gravity - sample.gravity, start.elastic - sample.elastic,
          sample.potential - start.potential;
      imbalance[i] = lyapunov_value(sample) - lyapunov_value(start) + sample.taken - start.taken +
                     sample.damped - start.damped;
    }
    const Eigen::Vector3d shares = least_norm_solution(courses, imbalance);
    verdict.gravity_share = shares[0], verdict.elastic_share = shares[1], verdict.potential_share = shares[2];
    constexpr double counts = 0.01;
    const auto explains = [&](Eigen::Index i) {
      return std::abs(shares[i]) > counts &&
             std::abs(shares[i]) * courses.col(i).cwiseAbs().maxCoeff() > 0.02 * verdict.imbalance;
    };
    if (explains(0))
      verdict.reasons.emplace_back(
          fmt::format("gravity is not fully compensated: {:.0f} % of it remains", 100 * shares[0]));
    if (explains(1))
      verdict.reasons.emplace_back(fmt::format(
          "the arm's elasticity is not fully compensated: {:.0f} % of it remains", 100 * shares[1]));
    if (explains(2))
      verdict.reasons.push_back(
          fmt::format("the law's force is {:.2f} times the potential's force, not 1 times{}", 1 - shares[2],
                      shares[2] > 1 ? " (the force drives the arm away from the target)" : ""));
    if ((imbalance - courses * shares).cwiseAbs().maxCoeff() > 0.05 * verdict.imbalance)
      verdict.reasons.emplace_back("the forces on the arm are not the forces of the law");
  }
  if (!verdict.is_monotone && verdict.reasons.empty()) verdict.reasons.emplace_back("W increases");
  if (!verdict.is_settled && verdict.reasons.empty()) verdict.reasons.emplace_back("W has not settled yet");
}

}  // namespace flexura
