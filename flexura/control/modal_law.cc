#include "flexura/control/modal_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

// Returns (bend_x, bend_y, stretch) of each section or arc.
Eigen::VectorXd packed_state(const ArmState& state) {
  Eigen::VectorXd numbers(3 * static_cast<Eigen::Index>(state.bends.size()));
  for (std::size_t i = 0; i < state.bends.size(); ++i)
    numbers.segment<3>(3 * static_cast<Eigen::Index>(i)) << state.bends[i], state.stretches[i];
  return numbers;
}

// Gains of a mode: of its error, of its rate, and of the target's acceleration, on the equilibrium.
struct Gains {
  double error = 0, rate = 0, acceleration = 0;
};

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
  const Eigen::VectorXd shape = rest + shapes * z, error = desired - shape,
                        rate_error = desired_rate - (by_command * sent_rate + shapes * z_rate);
  Eigen::VectorXd move = shapes * z + T * desired_rate;  // Of the equilibrium.
  Eigen::VectorXd outside = error;
  if (modes > 0) {
    const Eigen::MatrixXd into = pseudo_inverse(shapes);
    const Eigen::VectorXd e = into * error, e_rate = into * rate_error, a = into * desired_acceleration;
    const double slowest = now.frequency_factors[0] * now.modes[0].frequency;
    for (Eigen::Index j = 0; j < modes; ++j) {
      const SwingMode& mode = now.modes[static_cast<std::size_t>(j)];
      const double w = now.frequency_factors[j] * mode.frequency, own = 2 * mode.damping / w;
      Gains gains;
      if (config_.kind == ModalLawKind::computed_torque) {
        gains = {r * r / (w * w), 2 * r / (w * w) - own, 1 / (w * w)};
      } else {
        const double share = std::min(1.0, r * r / (slowest * slowest));
        gains = {share, 2 * std::sqrt(share) / w, 0};
      }
      move += shapes.col(j) * (gains.error * e[j] + gains.rate * e_rate[j] + gains.acceleration * a[j]);
    }
    outside -= shapes * e;
  }
  move += std::min(1.0, r * T) * outside;
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
