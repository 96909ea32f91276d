#include "flexura/control/predictive_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "flexura/kinematics/jacobian.h"
#include "flexura/math/dense.h"
#include "flexura/math/oscillator.h"
#include "flexura/model/arm_difference.h"

namespace flexura {
namespace {

constexpr int places_an_arc = 3;  // Of the error along the arm.
// Typical position error along the arm per radian of a section's bend, as a fraction of the length.
constexpr double gain = 1.0 / 3;

Eigen::VectorXd packed(const ArmVariables& variables, const ArmState& state) {
  Eigen::VectorXd x(variables.size());
  for (std::size_t i = 0; i < variables.parts().size(); ++i) {
    const ArmVariables::Part& part = variables.parts()[i];
    x[part.at] = state.bends[i].x();
    if (part.is_spatial) x[part.at + 1] = state.bends[i].y();
    if (part.is_stretchable) x[part.stretch_at()] = state.stretches[i];
  }
  return x;
}

// Returns (bend_x, bend_y, stretch) of each arc of the difference.
Eigen::VectorXd difference(const ArmState& to, const ArmState& from) {
  Eigen::VectorXd numbers(3 * static_cast<Eigen::Index>(to.bends.size()));
  for (std::size_t i = 0; i < to.bends.size(); ++i)
    numbers.segment<3>(3 * static_cast<Eigen::Index>(i)) << to.bends[i] - from.bends[i],
        to.stretches[i] - from.stretches[i];
  return numbers;
}

}  // namespace

PredictiveLaw::PredictiveLaw(const Arm& driven, const Arm& shaped, const PredictiveLawConfig& config)
    : driven_(driven), shaped_(shaped), config_(config), variables_(driven) {
  if (!(config.step > 0) || !std::isfinite(config.step) || config.horizon < 1 || !(config.rate > 0) ||
      !std::isfinite(config.rate) || config.most_iterations < 1)
    throw std::invalid_argument("a predictive law needs a step, a horizon and a rate above 0");
  for (std::size_t i = 0; i < driven.sections.size(); ++i) {
    const Section& section = driven.sections[i];
    const ArmVariables::Part& part = variables_.parts()[i];
    discs_.push_back({part.at, part.is_spatial ? 2 : 1, section.max_bend, section.max_bend_rate});
  }
  // A double integrator with the cost |g x|^2 + rho |x''|^2 is closed at the rate (g^2 / rho)^(1/4).
  effort_ = gain * gain / std::pow(config.rate, 4);
}

// Distances along the arm by its bends, at a shape.
void PredictiveLaw::find_metric(const ArmState& shape) {
  const BackboneJacobian jacobian(shaped_, shape);
  const auto arcs = static_cast<Eigen::Index>(shaped_.sections.size());
  constexpr Eigen::Index rows_an_arc = 3 * Eigen::Index{places_an_arc} + 2;
  metric_.setZero(rows_an_arc * arcs, 3 * arcs);
  Jacobian J(6, 3 * arcs);
  double total = 0;
  for (const Section& section : shaped_.sections) total += section.length;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < shaped_.sections.size(); ++i) {
    const double weight = std::sqrt(shaped_.sections[i].length / total / places_an_arc) / total;
    for (int k = 1; k <= places_an_arc; ++k, row += 3) {
      jacobian.at({i, static_cast<double>(k) / places_an_arc}, J);
      metric_.middleRows<3>(row) = weight * J.topRows<3>();
    }
  }
  // Some bends hardly move the arm. The bends themselves count too, so that all errors decay at about one
  // rate: those of an arc as much as if it turned all of its section by the typical gain.
  const double share =
      static_cast<double>(shaped_.sections.size()) / static_cast<double>(driven_.sections.size());
  for (Eigen::Index arc = 0; arc < arcs; ++arc, row += 2)
    metric_.block<2, 2>(row, 3 * arc).diagonal().setConstant(gain * std::sqrt(share));
}

// Linear prediction of the weighted errors: without changes of the rate, and by changes.
void PredictiveLaw::predict(const PredictiveState& now, const Eigen::MatrixXd& by_command) {
  const Eigen::Index n = variables_.size(), rows = metric_.rows();
  const int horizon = config_.horizon;
  const double T = config_.step;
  const auto modes = static_cast<Eigen::Index>(now.modes.size());
  Eigen::MatrixXd by_variables(by_command.rows(), n), kicks(modes, n), shapes(by_command.rows(), modes);
  const auto take = [&](const auto& from, auto&& to) {
    for (std::size_t i = 0; i < variables_.parts().size(); ++i) {
      const ArmVariables::Part& part = variables_.parts()[i];
      const auto c = 3 * static_cast<Eigen::Index>(i);
      to.col(part.at) = from.col(c);
      if (part.is_spatial) to.col(part.at + 1) = from.col(c + 1);
      if (part.is_stretchable) to.col(part.stretch_at()) = from.col(c + 2);
    }
  };
  take(by_command, by_variables);
  Eigen::MatrixXd all_kicks(modes, by_command.cols());
  std::vector<Eigen::Matrix2d> motion;
  for (Eigen::Index j = 0; j < modes; ++j) {
    const SwingMode& mode = now.modes[static_cast<std::size_t>(j)];
    all_kicks.row(j) = mode.kick.transpose();
    shapes.col(j) = mode.shape;
    motion.push_back(
        oscillation(now.frequency_factors[j] * mode.frequency, now.frequency_factors[j] * mode.damping, T));
  }
  take(all_kicks, kicks);
  const Eigen::MatrixXd of_command = metric_ * by_variables, of_swing = metric_ * shapes;

  // Answer to a change of rate, m + 1 steps after it.
  answer_.assign(static_cast<std::size_t>(horizon), Eigen::MatrixXd(rows, n));
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(modes, n), v = kicks;
  for (int m = 0; m < horizon; ++m) {
    for (Eigen::Index j = 0; j < modes; ++j) {
      const Eigen::Matrix2d& F = motion[static_cast<std::size_t>(j)];
      const Eigen::RowVectorXd before = z.row(j);
      z.row(j) = F(0, 0) * before + F(0, 1) * v.row(j);
      v.row(j) = (F(1, 0) * before + F(1, 1) * v.row(j)).eval();
    }
    answer_[static_cast<std::size_t>(m)].noalias() = (T * (m + 1)) * of_command + of_swing * z;
  }

  // Without changes.
  free_.resize(horizon * rows);
  Eigen::VectorXd e = difference(now.rest, now.desired), free_z = now.swing.head(modes),
                  free_v = now.swing.tail(modes);
  const Eigen::VectorXd way = by_variables * packed(variables_, now.rate);
  for (int k = 0; k < horizon; ++k) {
    const auto later = static_cast<std::size_t>(k);
    e += T * way;
    if (later < now.desired_later.size()) {
      const ArmState& before = k == 0 ? now.desired : now.desired_later[later - 1];
      e -= difference(now.desired_later[later], before);
    }
    for (Eigen::Index j = 0; j < modes; ++j) {
      const Eigen::Vector2d after =
          motion[static_cast<std::size_t>(j)] * Eigen::Vector2d(free_z[j], free_v[j]);
      free_z[j] = after[0], free_v[j] = after[1];
    }
    free_.segment(k * rows, rows) = metric_ * e + of_swing * free_z;
  }

  // At the end of the horizon: where the arm comes to rest if its rate decays.
  const double decay = 1 / config_.rate, weight = std::sqrt(decay / T);
  free_end_ = weight * (metric_ * (e + decay * way));
  end_.assign(static_cast<std::size_t>(horizon), weight * of_command);
  for (int i = 0; i < horizon; ++i) end_[static_cast<std::size_t>(i)] *= T * (horizon - i) + decay;
}

// A limit that the present command breaks is met again at the end of the horizon.
void PredictiveLaw::set_limits(const PredictiveState& now) {
  const auto count = static_cast<Eigen::Index>(now.limits.size());
  // Way of the fastest section during half of the horizon, rad; half a turn where rates are unlimited.
  double fastest = 0;
  for (const Disc& disc : discs_) fastest = std::max(fastest, disc.rate);
  const double reach = std::min(std::numbers::pi, 0.5 * config_.horizon * config_.step * fastest);
  limit_rows_.setZero(count, variables_.size());
  limit_rooms_.resize(count * config_.horizon);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PredictiveLimit& limit = now.limits[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < variables_.parts().size(); ++k) {
      const ArmVariables::Part& part = variables_.parts()[k];
      const auto c = 3 * static_cast<Eigen::Index>(k);
      limit_rows_(i, part.at) = limit.by_command[c];
      if (part.is_spatial) limit_rows_(i, part.at + 1) = limit.by_command[c + 1];
      if (part.is_stretchable) limit_rows_(i, part.stretch_at()) = limit.by_command[c + 2];
    }
    const double norm = limit_rows_.row(i).norm();
    // No command of the horizon meets a limit on something that the arm hardly moves.
    if (!(norm > 0) || !(limit.room > -norm * reach)) {
      limit_rows_.row(i).setZero();
    }
    const bool is_met = limit_rows_.row(i).squaredNorm() > 0;
    const double room = is_met ? limit.room / norm : std::numeric_limits<double>::infinity();
    if (is_met) limit_rows_.row(i) /= norm;
    for (int k = 0; k < config_.horizon; ++k)
      limit_rooms_[k * count + i] = room < 0 ? room * (k + 1) / config_.horizon : room;
  }
}

// Minimises the cost within the limits. Scaled by the alternating direction method: x are the changes, and
// rates and commands after them are projected on their sets.
void PredictiveLaw::solve(const Eigen::VectorXd& sent, const Eigen::VectorXd& rate) {
  const Eigen::Index n = variables_.size(), rows = metric_.rows();
  const int horizon = config_.horizon;
  const double T = config_.step;
  const Eigen::Index size = n * horizon;
  H_.setZero(size, size);
  gradient_.setZero(size);
  // Products of answers: entry (i, j) sums over the steps k after both changes.
  for (std::size_t lag = 0; lag < answer_.size(); ++lag) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t m = 0; m + lag < answer_.size(); ++m) {
      // The change at step i acts m + lag steps later when that at step i + lag acts m steps later.
      sum.noalias() += answer_[m + lag].transpose() * answer_[m];
      const Eigen::Index i = horizon - 1 - static_cast<Eigen::Index>(lag + m),
                         j = i + static_cast<Eigen::Index>(lag);
      H_.block(i * n, j * n, n, n) = T * sum;
      if (lag > 0) H_.block(j * n, i * n, n, n) = T * sum.transpose();
    }
  }
  for (int i = 0; i < horizon; ++i)
    for (int j = 0; j < horizon; ++j)
      H_.block(i * n, j * n, n, n).noalias() +=
          T * end_[static_cast<std::size_t>(i)].transpose() * end_[static_cast<std::size_t>(j)];
  H_.diagonal().array() += effort_ / T;
  for (int i = 0; i < horizon; ++i)
    gradient_.segment(i * n, n).noalias() += T * end_[static_cast<std::size_t>(i)].transpose() * free_end_;
  for (int i = 0; i < horizon; ++i)
    for (int k = i; k < horizon; ++k)
      gradient_.segment(i * n, n).noalias() +=
          T * answer_[static_cast<std::size_t>(k - i)].transpose() * free_.segment(k * rows, rows);

  // Rates and commands after each step: rates = R + L x, commands = S + T cumulative rates.
  const auto rates_of = [&](const Eigen::VectorXd& x, Eigen::VectorXd& w, Eigen::VectorXd& u) {
    Eigen::VectorXd at = sent, now = rate;
    for (int k = 0; k < horizon; ++k) {
      now += x.segment(k * n, n);
      at += T * now;
      w.segment(k * n, n) = now;
      u.segment(k * n, n) = at;
    }
  };
  changes_ = -Cholesky(H_).solve(gradient_);
  Eigen::VectorXd w(size), u(size), w_in(size), u_in(size);
  rates_of(changes_, w, u);
  const auto project = [&](Eigen::VectorXd& rates, Eigen::VectorXd& commands) {
    bool is_inside = true;
    for (int k = 0; k < horizon; ++k)
      for (const Disc& disc : discs_) {
        const auto into = [&](auto&& part, double most) {
          const double norm = part.norm();
          if (!(norm > most)) return;
          is_inside = false;
          part *= most / norm;
        };
        into(rates.segment(k * n + disc.at, disc.size), disc.rate);
        into(commands.segment(k * n + disc.at, disc.size), disc.bend);
      }
    return is_inside;
  };
  const Eigen::Index count = limit_rows_.rows();
  Eigen::VectorXd y(count * horizon), y_in = y, y0 = y, dual_y = Eigen::VectorXd::Zero(y.size());
  const auto limited = [&](const Eigen::VectorXd& commands, Eigen::VectorXd& products) {
    for (int k = 0; k < horizon; ++k)
      products.segment(k * count, count).noalias() = limit_rows_ * (commands.segment(k * n, n) - sent);
  };
  limited(u, y);
  active_limit_.reset();
  w_in = w, u_in = u;
  if (project(w_in, u_in) && (y.array() <= limit_rooms_.array()).all()) return;

  // rates = w0 + B x with B lower triangular of ones; commands = u0 + T C x with C the ramps.
  Eigen::MatrixXd of_rates = Eigen::MatrixXd::Zero(horizon, horizon), of_ramps = of_rates;
  for (int i = 0; i < horizon; ++i)
    for (int j = 0; j < horizon; ++j)
      for (int k = std::max(i, j); k < horizon; ++k)
        of_rates(i, j) += 1, of_ramps(i, j) += static_cast<double>((k - i + 1) * (k - j + 1));
  const double typical = H_.diagonal().mean();
  const double weight_w = typical / of_rates.diagonal().mean(),
               weight_u = typical / (T * T * of_ramps.diagonal().mean());
  Eigen::MatrixXd system = H_;
  const Eigen::MatrixXd limiting = limit_rows_.transpose() * limit_rows_;
  for (int i = 0; i < horizon; ++i)
    for (int j = 0; j < horizon; ++j) {
      auto block = system.block(i * n, j * n, n, n);
      block.diagonal().array() += weight_w * of_rates(i, j) + weight_u * T * T * of_ramps(i, j);
      block += weight_u * T * T * of_ramps(i, j) * limiting;
    }
  const Cholesky factored(system);
  Eigen::VectorXd w0(size), u0(size), dual_w = Eigen::VectorXd::Zero(size), dual_u = dual_w, right(size);
  rates_of(Eigen::VectorXd::Zero(size), w0, u0);
  limited(u0, y0);
  y_in = y.cwiseMin(limit_rooms_);
  for (int turn = 0; turn < config_.most_iterations; ++turn) {
    // Gradient of the penalties, transposed ramps from the last step to the first.
    Eigen::VectorXd sum_w = Eigen::VectorXd::Zero(n), sum_u = sum_w, ramp = sum_w;
    for (int k = horizon - 1; k >= 0; --k) {
      sum_w += (w_in - dual_w - w0).segment(k * n, n);
      sum_u += (u_in - dual_u - u0).segment(k * n, n);
      sum_u.noalias() += limit_rows_.transpose() * (y_in - dual_y - y0).segment(k * count, count);
      ramp += sum_u;
      right.segment(k * n, n) = weight_w * sum_w + weight_u * T * ramp;
    }
    changes_ = factored.solve(right - gradient_);
    rates_of(changes_, w, u);
    limited(u, y);
    w_in = w + dual_w, u_in = u + dual_u, y_in = (y + dual_y).cwiseMin(limit_rooms_);
    (void)project(w_in, u_in);
    dual_w += w - w_in, dual_u += u - u_in, dual_y += y - y_in;
    constexpr double near = 1e-3;  // rad/s, rad
    if ((w - w_in).cwiseAbs().maxCoeff() < near && (u - u_in).cwiseAbs().maxCoeff() < near * T &&
        (count == 0 || (y - y_in).cwiseAbs().maxCoeff() < near * T))
      break;
  }
  // The multipliers of a limit are above 0 where it restricts the commands.
  if (count == 0) return;
  Eigen::Index active = 0;
  const Eigen::VectorXd multipliers = dual_y.reshaped(count, horizon).rowwise().sum();
  if (multipliers.maxCoeff(&active) > 0) active_limit_ = static_cast<std::size_t>(active);
}

ArmState PredictiveLaw::step(const PredictiveState& now, const Eigen::MatrixXd& by_command) {
  find_metric(interpolate(now.rest, now.desired, 0.5));
  predict(now, by_command);
  const Eigen::VectorXd sent = packed(variables_, now.sent), rate = packed(variables_, now.rate);
  set_limits(now);
  solve(sent, rate);
  // The solver stops near the limits; the next command keeps them exactly.
  Eigen::VectorXd first = rate + changes_.head(variables_.size());
  const auto keep = [](auto&& part, double most) {
    if (const double norm = part.norm(); norm > most) part *= most / norm;
  };
  for (const Disc& disc : discs_) keep(first.segment(disc.at, disc.size), disc.rate);
  Eigen::VectorXd command = sent + config_.step * first;
  for (const Disc& disc : discs_) keep(command.segment(disc.at, disc.size), disc.bend);
  ArmState next = now.sent;
  variables_.state(command, next);
  return next;
}

}  // namespace flexura
