#include "flexura/control/modal_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "flexura/math/dense.h"
#include "flexura/math/oscillator.h"

namespace flexura {
namespace {

// Returns (bend_x, bend_y, stretch) of each section or arc.
Eigen::VectorXd packed_state(const ArmState& state) {
  Eigen::VectorXd numbers(3 * static_cast<Eigen::Index>(state.bends.size()));
  for (std::size_t i = 0; i < state.bends.size(); ++i)
    numbers.segment<3>(3 * static_cast<Eigen::Index>(i)) << state.bends[i], state.stretches[i];
  return numbers;
}

}  // namespace

ModalLaw::ModalLaw(const Arm& driven, const ModalLawConfig& config) : driven_(driven), config_(config) {
  if (!(config.step > 0) || !std::isfinite(config.step) || !(config.rate > 0) || !std::isfinite(config.rate))
    throw std::invalid_argument("a modal law needs a step and a rate above 0");
}

// In a mode, eta'' = w^2 (equilibrium - eta) - 2 zeta w eta'.
ArmState ModalLaw::step(const PredictiveState& now, const Eigen::MatrixXd& by_command) const {
  const Eigen::VectorXd rest = packed_state(now.rest), sent_rate = packed_state(now.rate);
  const auto modes = static_cast<Eigen::Index>(now.modes.size());
  const double r = config_.rate, T = config_.step;
  Eigen::MatrixXd shapes(rest.size(), modes);
  for (Eigen::Index j = 0; j < modes; ++j) shapes.col(j) = now.modes[static_cast<std::size_t>(j)].shape;
  Eigen::VectorXd z = Eigen::VectorXd::Zero(modes), z_rate = z;
  if (modes > 0) z = now.swing.head(modes), z_rate = now.swing.tail(modes);
  // The target now, its rate and acceleration.
  const Eigen::VectorXd desired = packed_state(now.desired);
  Eigen::VectorXd desired_rate = Eigen::VectorXd::Zero(rest.size()), desired_acceleration = desired_rate;
  // Over several steps: targets are straight between the given ones.
  constexpr std::size_t apart = 6;
  if (now.desired_later.size() >= 2 * apart) {
    const Eigen::VectorXd one = packed_state(now.desired_later[apart - 1]),
                          two = packed_state(now.desired_later[2 * apart - 1]);
    const double time = static_cast<double>(apart) * T;
    desired_acceleration = (two - 2 * one + desired) / (time * time);
    desired_rate = (one - desired) / time - 0.5 * time * desired_acceleration;
  }
  // The command acts at the end of the step. Until then the equilibrium goes on at its rate.
  const Eigen::VectorXd target = desired + T * desired_rate - rest;
  Eigen::VectorXd move = Eigen::VectorXd::Zero(rest.size());  // Of the equilibrium.
  Eigen::VectorXd outside = target, rate_outside = desired_rate;
  if (modes > 0) {
    const Eigen::MatrixXd into = pseudo_inverse(shapes);
    const Eigen::VectorXd rest_rate = into * (by_command * sent_rate), to = into * target,
                          to_rate = into * desired_rate, to_acceleration = into * desired_acceleration;
    const double slowest = now.frequency_factors[0] * now.modes[0].frequency;
    for (Eigen::Index j = 0; j < modes; ++j) {
      const SwingMode& mode = now.modes[static_cast<std::size_t>(j)];
      const double factor = now.frequency_factors[j], w = factor * mode.frequency,
                   own = 2 * factor * mode.damping / w;
      const Eigen::Vector2d swing =
          oscillation(w, factor * mode.damping, T) * Eigen::Vector2d(z[j], z_rate[j]);
      const double eta = swing[0] + T * rest_rate[j], eta_rate = swing[1] + rest_rate[j], e = to[j] - eta,
                   e_rate = to_rate[j] - eta_rate;
      double pull = 0;
      if (config_.kind == ModalLawKind::computed_torque) {
        pull = (r * r * e + 2 * r * e_rate + to_acceleration[j]) / (w * w) + own * eta_rate;
      } else {
        const double share = std::min(1.0, r * r / (slowest * slowest));
        pull = share * e + 2 * std::sqrt(share) / w * e_rate;
      }
      move += (eta + pull) * shapes.col(j);
    }
    outside -= shapes * to;
    rate_outside -= shapes * to_rate;
  }
  move += std::min(1.0, r * T) * outside + T * rate_outside;
  const Eigen::VectorXd change = pseudo_inverse(by_command) * move;
  ArmState command = now.sent;
  for (std::size_t i = 0; i < command.bends.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    command.bends[i] += change.segment<2>(at);
    if (driven_.sections[i].can_stretch()) command.stretches[i] += change[at + 2];
    if (driven_.kind == ArmKind::planar) command.bends[i].y() = 0;
  }
  return command;
}

}  // namespace flexura
