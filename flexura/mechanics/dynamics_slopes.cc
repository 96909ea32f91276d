#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

#include "flexura/mechanics/dynamics_work.h"

namespace flexura {

// Uses dual numbers: each evaluation has as many directions as an instruction has lanes.
void RodDynamics::Work::differentiate(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                      const RodLoads& loads, double by_q, double by_v,
                                      Eigen::MatrixXd& momentum, Eigen::MatrixXd& force) {
  using Number = Dual<Lanes>;
  if (!differential_) {
    differential_ = std::make_unique<RodMotion<Number>>(layout);
    differential_->set_points(points.get());
  }
  differential_->set_grip(grip);
  differential_->hold(held_before_, slide_time_);
  const Eigen::Index n = q.size();
  momentum.resize(n, n);
  force.resize(n, n);
  const auto number = [](double value) { return value + Number{}; };
  std::vector<Number> q_dual, v_dual, pulls;
  for (const double value : q) q_dual.push_back(number(value));
  for (const double value : v) v_dual.push_back(number(value));
  for (const double value : tensions) pulls.push_back(number(value));
  std::vector<Number> p_dual(q_dual.size()), f_dual(q_dual.size());
  const auto section_of = [&](Eigen::Index mode) {
    std::size_t s = 0;
    while (s + 1 < layout.sections.size() &&
           layout.sections[s + 1].first_mode <= static_cast<std::size_t>(mode))
      ++s;
    return s;
  };
  constexpr auto width = static_cast<Eigen::Index>(lanes_of<Lanes>);
  for (Eigen::Index first = 0; first < n; first += width) {
    const Eigen::Index count = std::min(width, n - first);
    const auto set = [&](double q_slope, double v_slope) {
      for (Eigen::Index lane = 0; lane < count; ++lane) {
        const auto j = static_cast<std::size_t>(first + lane);
        q_dual[j].slope[lane] = q_slope;
        v_dual[j].slope[lane] = v_slope;
      }
    };
    set(by_q, by_v);
    differential_->vary(section_of(first), section_of(first + count - 1), first > 0);
    differential_->place(q_dual.data(), v_dual.data());
    differential_->keep_surroundings(first > 0);
    differential_->pull(loads, pulls.data(), surroundings);
    differential_->balance(p_dual.data(), f_dual.data());
    set(0, 0);
    for (Eigen::Index lane = 0; lane < count; ++lane) {
      for (Eigen::Index j = 0; j < n; ++j) {
        momentum(j, first + lane) = p_dual[static_cast<std::size_t>(j)].slope[lane];
        force(j, first + lane) = f_dual[static_cast<std::size_t>(j)].slope[lane];
      }
    }
  }
}

RodDynamicsSlopes RodDynamics::Work::slopes_at(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                               const TendonInput& tendons, const RodLoads& loads) {
  RodDynamicsSlopes slopes;
  differentiate(q, v, loads, 1, 0, slopes.momentum_by_q, slopes.force_by_q);
  motion.place(q.data(), v.data());
  if (v.isZero(0) && !rubs() && surroundings == nullptr && !layout.is_driven) {
    // Of the forces at rest, only damping depends on the rates.
    matrix.find_columns(motion);
    slopes.mass = matrix.dense_mass(motion);
    slopes.force_by_v.setZero(q.size(), q.size());
    for (const RodLayout::Section& section : layout.sections) {
      const auto first = static_cast<Eigen::Index>(section.first_mode),
                 size = static_cast<Eigen::Index>(section.modes);
      slopes.force_by_v.block(first, first, size, size) = -section.damping;
    }
  } else {
    differentiate(q, v, loads, 0, 1, slopes.mass, slopes.force_by_v);
  }
  if (rubs()) motion.pull(loads, tensions.data(), surroundings);
  Eigen::VectorXd length_slopes(q.size());
  const auto count = static_cast<Eigen::Index>(chain.tendons());
  slopes.force_by_input.setZero(q.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto tendon = static_cast<std::size_t>(i);
    motion.find_pull_slopes(tendon, tensions[tendon], slopes.force_by_input.col(i).data());
    slopes.force_by_input.col(i) *= -1;
    if (tendons.displacements.empty()) continue;
    // The tension follows the tendon's length.
    if (tensions[tendon] == 0) {
      slopes.force_by_input.col(i).setZero();
      continue;
    }
    motion.find_length_slopes(tendon, length_slopes.data());
    slopes.force_by_q += slopes.force_by_input.col(i) * length_slopes.transpose() / compliance[tendon];
    slopes.force_by_input.col(i) /= compliance[tendon];
  }
  find_parameter_slopes(q, v, loads, slopes);
  return slopes;
}

Eigen::MatrixXd RodDynamics::Work::inner_forces(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const {
  constexpr std::array<Eigen::Index, 6> of_strain = {0, 0, 1, 2, 2, 3};
  constexpr Eigen::Index of_damping = 5;
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(
      q.size(), dynamics_parameters * static_cast<Eigen::Index>(chain.rod().sections.size()));
  for (const RodLayout::Section& section : layout.sections) {
    const auto first = static_cast<Eigen::Index>(section.first_mode),
               size = static_cast<Eigen::Index>(section.modes),
               column = dynamics_parameters * static_cast<Eigen::Index>(section.part.section);
    const Eigen::VectorXd stiff = section.stiffness * q.segment(first, size);
    for (Eigen::Index j = 0; j < size; ++j)
      forces(first + j, column + of_strain[section.strain[static_cast<std::size_t>(j)]]) = stiff[j];
    forces.col(column + of_damping).segment(first, size) = section.damping * v.segment(first, size);
  }
  return forces;
}

void RodDynamics::Work::find_parameter_slopes(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                              const RodLoads& loads, RodDynamicsSlopes& slopes) {
  constexpr Eigen::Index of_mass = 4;
  slopes.force_by_parameters = -inner_forces(q, v);
  if (rubs()) {
    Eigen::VectorXd by_grip(q.size());
    for (const RodLayout::Rubbing& rub : layout.rubbing) {
      motion.find_grip_slopes(rub.tendon, tensions[rub.tendon], by_grip.data());
      slopes.force_by_parameters -= by_grip * grip_by_parameters.row(static_cast<Eigen::Index>(rub.tendon));
    }
  }
  // Momentum and forces of inertia and weight are linear in the masses. So their derivatives are those of a
  // rod that has only these masses.
  slopes.momentum_by_parameters.setZero(q.size(), slopes.force_by_parameters.cols());
  RodLayout massive = layout;
  massive.rubbing.clear();
  for (RodLayout::Section& section : massive.sections) {
    section.stiffness.setZero();
    section.damping.setZero();
  }
  RodMotion<double> alone(massive);
  const std::vector<double> slack(chain.tendons(), 0.0);
  Eigen::VectorXd force(q.size());
  for (std::size_t i = 0; i < chain.rod().sections.size(); ++i) {
    std::ranges::fill(massive.bodies, RodLayout::Body{});
    for (const RodLayout::Section& section : massive.sections)
      if (section.part.section == i)
        std::copy_n(layout.slices.begin() + static_cast<std::ptrdiff_t>(section.first_node),
                    section.intervals + 1,
                    massive.bodies.begin() + static_cast<std::ptrdiff_t>(section.first_node));
    alone.place(q.data(), v.data());
    alone.pull({.gravity = loads.gravity}, slack.data(), nullptr);
    const Eigen::Index column = dynamics_parameters * static_cast<Eigen::Index>(i) + of_mass;
    alone.balance(slopes.momentum_by_parameters.col(column).data(), force.data());
    slopes.force_by_parameters.col(column) = force;
  }
}

bool RodDynamics::Work::find_stage(const RodState& state, const TendonInput& tendons, const RodLoads& loads,
                                   double h, Eigen::VectorXd& q, Eigen::VectorXd& v) {
  RodState after = state;
  if (!step_once(scheme, after, tendons, loads, h).converged()) return false;
  q = q_from_ + scheme.stage * h * velocity;
  v = velocity;
  hold(state.friction.data(), h);
  return true;
}

void RodDynamics::Work::keep_tensions_of_rest(const RodState& state, const TendonInput& tendons) {
  if (tendons.displacements.empty() || state.tensions.size() != tensions.size() || !state.momentum.isZero(0))
    return;
  // More than the rounding of an equilibrium, and far less than a motion.
  const double rounding = 1e-9 * chain.rod().length();
  for (std::size_t i = 0; i < tensions.size(); ++i) {
    const double stretch = lengths_[static_cast<Eigen::Index>(i)] - rest_lengths[i] +
                           tendons.displacements[i] - compliance[i] * state.tensions[i];
    if (!(state.tensions[i] >= 0) || !(stretch <= rounding)) return;
    if (state.tensions[i] > 0 && !(stretch >= -rounding)) return;
  }
  std::ranges::copy(state.tensions, tensions.begin());
}

RodDynamicsSlopes RodDynamics::slopes(const RodState& state, const TendonInput& tendons,
                                      const RodLoads& loads, const RodSlide* slide) {
  const RodState started =
      start(state.q, velocity(state), tendons, loads, slide);  // Checks input and sets the tensions.
  work_->keep_tensions_of_rest(state, tendons);
  return work_->slopes_at(started.q, started.rate, tendons, loads);
}

RodLinear RodDynamics::linearize(const RodState& state, const TendonInput& tendons, const RodLoads& loads) {
  if (work_->rubs())
    throw std::invalid_argument(
        fmt::format("tendon {}: friction has no linear model", work_->layout.rubbing.front().tendon + 1));
  RodLinear linear;
  linear.slopes = slopes(state, tendons, loads);
  const RodDynamicsSlopes& by = linear.slopes;
  const Eigen::Index n = state.q.size(), inputs = by.force_by_input.cols();
  const Eigen::LDLT<Eigen::MatrixXd> mass(by.mass);
  const Eigen::MatrixXd by_p = mass.solve(Eigen::MatrixXd::Identity(n, n)),
                        rate_by_q = -mass.solve(by.momentum_by_q);
  linear.A.resize(2 * n, 2 * n);
  linear.A << rate_by_q, by_p, by.force_by_q + by.force_by_v * rate_by_q, by.force_by_v * by_p;
  linear.B.setZero(2 * n, inputs);
  linear.B.bottomRows(n) = by.force_by_input;
  linear.A_rest.setZero(2 * n, 2 * n);
  linear.A_rest.topRightCorner(n, n).setIdentity();
  linear.A_rest.bottomRows(n) << mass.solve(by.force_by_q), mass.solve(by.force_by_v);
  linear.B_rest.setZero(2 * n, inputs);
  linear.B_rest.bottomRows(n) = mass.solve(by.force_by_input);
  const Eigen::MatrixXd rates = -mass.solve(by.momentum_by_parameters);
  linear.by_parameters.resize(2 * n, rates.cols());
  linear.by_parameters << rates, by.force_by_parameters + by.force_by_v * rates;
  linear.by_parameters_rest.setZero(2 * n, rates.cols());
  linear.by_parameters_rest.bottomRows(n) = mass.solve(by.force_by_parameters);
  work_->matrix.find_columns(work_->motion);
  linear.tip_by_q = work_->matrix.node_columns(work_->layout.nodes - 1);
  const Triple<double>& p = work_->motion.nodes().back().position;
  for (Eigen::Index j = 0; j < n; ++j)
    linear.tip_by_q.col(j).head<3>() +=
        linear.tip_by_q.col(j).tail<3>().cross(Eigen::Vector3d(p.x, p.y, p.z));
  linear.lengths_by_q.setZero(inputs, n);
  Eigen::VectorXd row(n);
  for (Eigen::Index i = 0; i < inputs; ++i) {
    work_->motion.find_length_slopes(static_cast<std::size_t>(i), row.data());
    linear.lengths_by_q.row(i) = row.transpose();
  }
  return linear;
}

RodStepSlopes RodDynamics::step_slopes(const RodState& state, const TendonInput& tendons,
                                       const RodLoads& loads, double h) {
  Eigen::VectorXd q, v;
  if (!(h > 0) || !work_->input_problem(tendons, loads).empty() ||
      !work_->find_stage(state, tendons, loads, h, q, v))
    throw std::runtime_error("the step does not converge, so it has no derivatives");
  const RodDynamicsSlopes by = work_->slopes_at(q, v, tendons, loads);
  const Work::Scheme& scheme = work_->scheme;
  const Eigen::Index n = q.size(), inputs = by.force_by_input.cols(),
                     parameters = by.force_by_parameters.cols();
  const double stretch = scheme.stage * h, memory = scheme.memory * h;
  const Eigen::MatrixXd shape = by.momentum_by_q - stretch * by.force_by_q;
  const Eigen::PartialPivLU<Eigen::MatrixXd> derivative(by.mass - stretch * by.force_by_v + stretch * shape);
  // Columns: q, p, rate, force, input, parameters. First the stage's start, then the stage, then the step's
  // end.
  const Eigen::Index columns = 4 * n + inputs + parameters;
  const auto none = Eigen::MatrixXd::Zero(n, columns);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd q_from = none, p_from = none, u = none, rate = none, force = none;
  q_from.leftCols(n) = one;
  q_from.middleCols(2 * n, n) = memory * one;
  p_from.middleCols(n, n) = one;
  p_from.middleCols(3 * n, n) = memory * one;
  u.middleCols(4 * n, inputs) = by.force_by_input;
  u.rightCols(parameters) = by.force_by_parameters;
  // Heavier parts need less speed for the same momentum.
  p_from.rightCols(parameters) -= by.momentum_by_parameters;
  const Eigen::MatrixXd v_by = derivative.solve(p_from + stretch * u - shape * q_from);
  const Eigen::MatrixXd f_by = by.force_by_q * (q_from + stretch * v_by) + by.force_by_v * v_by + u;
  const double now = 1 / scheme.alpha_m, old = (1 - scheme.alpha_m) / scheme.alpha_m;
  rate.middleCols(2 * n, n) = one;
  force.middleCols(3 * n, n) = one;
  Eigen::MatrixXd after(4 * n, columns);
  after.middleRows(2 * n, n) = now * v_by - old * rate;
  after.middleRows(3 * n, n) = now * f_by - old * force;
  after.topRows(n) = h * (1 - scheme.gamma) * rate + h * scheme.gamma * after.middleRows(2 * n, n);
  after.middleRows(n, n) = h * (1 - scheme.gamma) * force + h * scheme.gamma * after.middleRows(3 * n, n);
  after.topLeftCorner(n, n) += one;
  after.block(n, n, n, n) += one;
  return {.by_state = after.leftCols(4 * n),
          .by_input = after.middleCols(4 * n, inputs),
          .by_parameters = after.rightCols(parameters)};
}

}  // namespace flexura
