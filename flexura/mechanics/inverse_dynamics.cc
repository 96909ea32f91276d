#include "flexura/mechanics/inverse_dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "flexura/math/dense.h"
#include "flexura/mechanics/dynamics_work.h"
#include "flexura/mechanics/least_effort.h"

namespace flexura {
namespace {

// Relative threshold: below it a tendon counts as linearly dependent on the others.
constexpr double same_pull = 1e-7;

void require_modes(const Eigen::VectorXd& values, Eigen::Index count, const char* name) {
  if (values.size() != count)
    throw std::invalid_argument(fmt::format("{} {} given: expected {}", values.size(), name, count));
  if (!values.allFinite()) throw std::invalid_argument(fmt::format("{} must be finite", name));
}

Eigen::VectorXd most_tensions(const TensionFitConfig& config, Eigen::Index count) {
  if (!(config.effort > 0) || !std::isfinite(config.effort))
    throw std::invalid_argument("the weight of the effort must be above 0 and finite");
  if (config.most.empty()) return Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity());
  if (static_cast<Eigen::Index>(config.most.size()) != count)
    throw std::invalid_argument(
        fmt::format("{} bounds of tensions given: expected {}", config.most.size(), count));
  if (!std::ranges::all_of(config.most, [](double most) { return most >= 0; }))
    throw std::invalid_argument("a bound of a tension must be at least 0");
  return Eigen::Map<const Eigen::VectorXd>(config.most.data(), count);
}

// Assembles a block diagonal matrix, one block a section.
Eigen::MatrixXd of_sections(const RodLayout& layout, Eigen::MatrixXd RodLayout::Section::* part) {
  const auto n = static_cast<Eigen::Index>(layout.modes);
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n, n);
  for (const RodLayout::Section& section : layout.sections) {
    const auto first = static_cast<Eigen::Index>(section.first_mode),
               count = static_cast<Eigen::Index>(section.modes);
    whole.block(first, first, count, count) = section.*part;
  }
  return whole;
}

}  // namespace

Eigen::VectorXd RodDynamics::needed_forces(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                           const Eigen::VectorXd& a, const RodLoads& loads) {
  const Eigen::Index n = work_->chain.size();
  require_modes(q, n, "modes");
  require_modes(v, n, "rates");
  require_modes(a, n, "accelerations");
  const std::string problem = work_->input_problem({}, loads);
  if (!problem.empty()) throw std::invalid_argument(problem);
  Eigen::VectorXd there(n), momentum(n), unused(n);
  work_->set_tensions({});
  work_->motion.place(q.data(), v.data());
  work_->motion.pull(loads, work_->tensions.data(), work_->surroundings);
  work_->motion.find_acceleration_forces(there.data());
  // The momentum of the rates a is M a.
  work_->motion.place(q.data(), a.data());
  work_->motion.pull({}, work_->tensions.data(), nullptr);
  work_->motion.balance(momentum.data(), unused.data());
  return momentum - there;
}

Eigen::MatrixXd RodDynamics::lengths_by_q(const Eigen::VectorXd& q) {
  const Eigen::Index n = work_->chain.size();
  require_modes(q, n, "modes");
  work_->velocity.setZero();
  work_->motion.place(q.data(), work_->velocity.data());
  Eigen::MatrixXd by_q(n, static_cast<Eigen::Index>(work_->chain.tendons()));
  for (Eigen::Index i = 0; i < by_q.cols(); ++i)
    work_->motion.find_length_slopes(static_cast<std::size_t>(i), by_q.col(i).data());
  return by_q.transpose();
}

Eigen::MatrixXd RodDynamics::stiffness_matrix() const {
  return of_sections(work_->layout, &RodLayout::Section::stiffness);
}
Eigen::MatrixXd RodDynamics::damping_matrix() const {
  return of_sections(work_->layout, &RodLayout::Section::damping);
}

double TensionFit::residual() const {
  return desired_energy > 0 ? std::sqrt(missing_energy / desired_energy) : 0;
}

TensionFit nearest_tensions(RodDynamics& dynamics, const Eigen::VectorXd& q, const Eigen::VectorXd& desired,
                            const TensionFitConfig& config) {
  require_modes(desired, dynamics.chain().size(), "generalized forces");
  TensionFit fit{.tensions = {}, .desired = desired, .missing = desired};
  const auto count = static_cast<Eigen::Index>(dynamics.chain().tendons());
  const Eigen::VectorXd most = most_tensions(config, count);
  const Eigen::MatrixXd pulls = -dynamics.lengths_by_q(q).transpose();
  if (desired.size() == 0) {
    fit.tensions.assign(dynamics.chain().tendons(), 0.0);
    return fit;
  }
  const Cholesky stiffness(dynamics.stiffness_matrix());
  const Eigen::VectorXd goal = stiffness.solve_lower(desired);
  fit.desired_energy = 0.5 * goal.squaredNorm();
  fit.missing_energy = fit.desired_energy;
  if (count == 0) return fit;
  const Eigen::MatrixXd made = stiffness.solve_lower(pulls);
  Eigen::MatrixXd square = made.transpose() * made;
  const double size = square.trace() / static_cast<double>(count);
  square.diagonal().array() += config.effort * (size > 0 ? size : 1);
  const Eigen::VectorXd tensions =
      least_in_box(square, -made.transpose() * goal, Eigen::VectorXd::Zero(count), most);
  fit.tensions.assign(tensions.begin(), tensions.end());
  fit.missing = desired - pulls * tensions;
  fit.missing_energy = 0.5 * (goal - made * tensions).squaredNorm();
  fit.is_determined = size > 0 && rank_of(made, same_pull) == count;
  return fit;
}

TensionFit inverse_dynamics(RodDynamics& dynamics, const RodMotionSample& motion, const RodLoads& loads,
                            const TensionFitConfig& config) {
  return nearest_tensions(dynamics, motion.q, dynamics.needed_forces(motion.q, motion.v, motion.a, loads),
                          config);
}

std::vector<TensionFit> inverse_dynamics(RodDynamics& dynamics, std::span<const RodMotionSample> motion,
                                         const RodLoads& loads, const TensionFitConfig& config) {
  std::vector<TensionFit> fits;
  fits.reserve(motion.size());
  for (const RodMotionSample& sample : motion)
    fits.push_back(inverse_dynamics(dynamics, sample, loads, config));
  return fits;
}

TensionFit gravity_compensation(RodDynamics& dynamics, const Eigen::VectorXd& q, const RodLoads& loads,
                                const TensionFitConfig& config) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(q.size());
  return inverse_dynamics(dynamics, {.q = q, .v = none, .a = none}, loads, config);
}

TensionFit computed_torque(RodDynamics& dynamics, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                           const RodMotionSample& desired, const ComputedTorqueGains& gains,
                           const RodLoads& loads, const TensionFitConfig& config) {
  const Eigen::Index n = dynamics.chain().size();
  for (const Eigen::VectorXd* list : {&q, &desired.q}) require_modes(*list, n, "modes");
  for (const Eigen::VectorXd* list : {&v, &desired.v}) require_modes(*list, n, "rates");
  require_modes(desired.a, n, "accelerations");
  if (!std::isfinite(gains.position) || !std::isfinite(gains.velocity))
    throw std::invalid_argument("gains must be finite");
  const Eigen::VectorXd a = desired.a + gains.velocity * (desired.v - v) + gains.position * (desired.q - q);
  return inverse_dynamics(dynamics, {.q = q, .v = v, .a = a}, loads, config);
}

}  // namespace flexura
