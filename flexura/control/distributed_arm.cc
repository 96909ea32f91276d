#include "flexura/control/distributed_arm.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

void require_arm(const DistributedArmModel& model) {
  if (!(model.density > 0) || !std::isfinite(model.density))
    throw std::invalid_argument("a distributed arm's density must be finite and above 0");
  for (const double number :
       {model.bending_stiffness, model.axial_stiffness, model.damping, model.length_damping})
    if (!(number >= 0) || !std::isfinite(number))
      throw std::invalid_argument("a distributed arm's stiffness and damping must be finite and 0 or more");
  if (!model.gravity.allFinite()) throw std::invalid_argument("a distributed arm's gravity must be finite");
  constexpr double most_q = 1.57;
  const auto is_clamp = [](const std::array<double, 2>& clamp) {
    return std::isfinite(clamp[0]) && std::abs(clamp[1]) < most_q;  // False if it is not a number.
  };
  if (model.clamp && !is_clamp(*model.clamp))
    throw std::invalid_argument("a distributed arm's base must have |q| below 1.57 rad");
}

}  // namespace

DistributedArm::DistributedArm(const DistributedArmModel& model)
    : model_((require_arm(model), model)),
      shapes_(angle_shapes(model.lengths, model.basis, model.clamp.has_value(), model.nodes, model.points)) {
  const auto sections = static_cast<Eigen::Index>(model.lengths.size());
  const Eigen::Index points = shapes_.s.size();
  if (points < nodes())
    throw std::invalid_argument("a distributed arm needs at least as many points as nodes");
  lengths_at_ = 2 * nodes();
  size_ = lengths_at_ + (model.has_variable_lengths ? sections : 0);
  const double length = std::accumulate(model.lengths.begin(), model.lengths.end(), 0.0);
  root_ = (model.density * shapes_.weights).cwiseSqrt().asDiagonal() * shapes_.running;
  weigh_ = model.density * (length - shapes_.s.array()) * shapes_.weights.array();
  for (Eigen::VectorXd* of_points : {&theta_, &q_, &theta_s_, &q_s_, &theta_t_, &q_t_, &point_force_})
    of_points->setZero(points);
  for (Eigen::Matrix3Xd* of_points : {&e_, &e_theta_, &e_q_, &curving_}) of_points->setZero(3, points);
  for (Eigen::MatrixXd& component : by_x_) component.setZero(points, size_);
  stretch_.setOnes(sections), stretch_t_.setZero(sections);
  for (Eigen::VectorXd* of_x : {&rates_, &gravity_gradient_, &elastic_gradient_, &damping_force_})
    of_x->setZero(size_);
  flow_.setZero(3 * points, size_), mass_.setZero(size_, size_);
  flow_rate_.setZero(3 * points), bias_.setZero(3 * points);
  factor_.compute(Eigen::MatrixXd::Identity(size_, size_));  // Allocates for the factor of the mass matrix.
  set(Eigen::VectorXd::Zero(size_), Eigen::VectorXd::Zero(size_));
}

Eigen::VectorXd DistributedArm::coordinates(const std::function<Eigen::Vector2d(double s)>& angles) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size_);
  for (Eigen::Index i = 0; i < nodes(); ++i) {
    const Eigen::Vector2d there = angles(shapes_.nodes[i]);
    x[i] = there[0];
    x[nodes() + i] = there[1];
  }
  return x;
}

void DistributedArm::set(const Eigen::VectorXd& x, const Eigen::VectorXd& v) {
  if (x.size() != size_ || v.size() != size_)
    throw std::invalid_argument("a state's size does not fit the distributed arm");
  set_angles(x, v);
  set_velocities();
  set_forces();
}

void DistributedArm::set_angles(const Eigen::VectorXd& x, const Eigen::VectorXd& v) {
  const Eigen::Index n = nodes();
  rates_ = v;
  theta_.noalias() = shapes_.values * x.head(n);
  q_.noalias() = shapes_.values * x.segment(n, n);
  theta_s_.noalias() = shapes_.slopes * x.head(n);
  q_s_.noalias() = shapes_.slopes * x.segment(n, n);
  theta_t_.noalias() = shapes_.values * v.head(n);
  q_t_.noalias() = shapes_.values * v.segment(n, n);
  if (model_.clamp) {
    theta_ += (*model_.clamp)[0] * shapes_.base, q_ += (*model_.clamp)[1] * shapes_.base;
    theta_s_ += (*model_.clamp)[0] * shapes_.base_slopes, q_s_ += (*model_.clamp)[1] * shapes_.base_slopes;
  }
  if (model_.has_variable_lengths) {
    for (Eigen::Index k = 0; k < stretch_.size(); ++k) {
      const double rest = model_.lengths[static_cast<std::size_t>(k)];
      stretch_[k] = 1 + x[lengths_at_ + k] / rest;
      stretch_t_[k] = v[lengths_at_ + k] / rest;
    }
  }
}

// docs/control.md, eq. 2 to 5.
void DistributedArm::set_velocities() {
  const Eigen::Index n = nodes();
  for (Eigen::Index j = 0; j < theta_.size(); ++j) {
    const double a = std::cos(theta_[j]), b = std::sin(theta_[j]), c = std::cos(q_[j]), d = std::sin(q_[j]);
    const auto section = static_cast<Eigen::Index>(shapes_.section[static_cast<std::size_t>(j)]);
    const double stretch = stretch_[section], stretch_t = stretch_t_[section];
    e_.col(j) << b * c, a * c, d;
    e_theta_.col(j) << a * c, -b * c, 0;
    e_q_.col(j) << -b * d, -a * d, c;
    const Eigen::Vector3d by_both(-a * d, b * d, 0), by_theta_twice(-b * c, -a * c, 0);
    const double u = theta_t_[j], w = q_t_[j];
    curving_.col(j) = 2 * stretch_t * (u * e_theta_.col(j) + w * e_q_.col(j)) +
                      stretch * (u * u * by_theta_twice + 2 * u * w * by_both - w * w * e_.col(j));
    for (Eigen::Index i = 0; i < 3; ++i) {
      Eigen::MatrixXd& by_x = by_x_[static_cast<std::size_t>(i)];
      by_x.row(j).head(n) = stretch * e_theta_(i, j) * shapes_.values.row(j);
      by_x.row(j).segment(n, n) = stretch * e_q_(i, j) * shapes_.values.row(j);
      if (model_.has_variable_lengths)
        by_x(j, lengths_at_ + section) = e_(i, j) / model_.lengths[static_cast<std::size_t>(section)];
    }
  }
  const Eigen::Index points = theta_.size();
  for (Eigen::Index i = 0; i < 3; ++i) {
    flow_.middleRows(i * points, points).noalias() = root_ * by_x_[static_cast<std::size_t>(i)];
    bias_.segment(i * points, points).noalias() = root_ * curving_.row(i).transpose();
  }
  flow_rate_.noalias() = flow_ * rates_;
}

// docs/control.md, eq. 6 to 8.
void DistributedArm::set_forces() {
  const Eigen::Index n = nodes(), points = theta_.size();
  const Eigen::Vector3d& g = model_.gravity;
  const double bending = model_.bending_stiffness;
  const auto gather = [&](Eigen::VectorXd& to, Eigen::Index at, const Eigen::MatrixXd& shapes) {
    to.segment(at, n).noalias() += shapes.transpose() * point_force_;
  };
  const auto at_points = [&](auto&& value) {
    for (Eigen::Index j = 0; j < points; ++j)
      point_force_[j] =
          value(j, stretch_[static_cast<Eigen::Index>(shapes_.section[static_cast<std::size_t>(j)])]);
  };
  for (Eigen::VectorXd* gradient : {&gravity_gradient_, &elastic_gradient_, &damping_force_})
    gradient->setZero();
  at_points([&](Eigen::Index j, double stretch) { return -weigh_[j] * stretch * g.dot(e_theta_.col(j)); });
  gather(gravity_gradient_, 0, shapes_.values);
  at_points([&](Eigen::Index j, double stretch) { return -weigh_[j] * stretch * g.dot(e_q_.col(j)); });
  gather(gravity_gradient_, n, shapes_.values);
  at_points([&](Eigen::Index j, double stretch) {
    return -bending * shapes_.weights[j] / stretch * std::sin(q_[j]) * std::cos(q_[j]) * theta_s_[j] *
           theta_s_[j];
  });
  gather(elastic_gradient_, n, shapes_.values);
  at_points([&](Eigen::Index j, double stretch) {
    return bending * shapes_.weights[j] / stretch * std::cos(q_[j]) * std::cos(q_[j]) * theta_s_[j];
  });
  gather(elastic_gradient_, 0, shapes_.slopes);
  at_points([&](Eigen::Index j, double stretch) { return bending * shapes_.weights[j] / stretch * q_s_[j]; });
  gather(elastic_gradient_, n, shapes_.slopes);
  const double c = model_.damping;
  at_points([&](Eigen::Index j, double) {
    return c * shapes_.weights[j] * std::cos(q_[j]) * std::cos(q_[j]) * theta_t_[j];
  });
  gather(damping_force_, 0, shapes_.values);
  at_points([&](Eigen::Index j, double) { return c * shapes_.weights[j] * q_t_[j]; });
  gather(damping_force_, n, shapes_.values);
  if (!model_.has_variable_lengths) return;
  for (Eigen::Index j = 0; j < points; ++j) {
    const std::size_t section = shapes_.section[static_cast<std::size_t>(j)];
    const auto k = static_cast<Eigen::Index>(section);
    const double cosine = std::cos(q_[j]), rest = model_.lengths[section], w = shapes_.weights[j];
    const double square = q_s_[j] * q_s_[j] + cosine * cosine * theta_s_[j] * theta_s_[j];
    gravity_gradient_[lengths_at_ + k] -= weigh_[j] * g.dot(e_.col(j)) / rest;
    elastic_gradient_[lengths_at_ + k] +=
        w / rest *
        (model_.axial_stiffness * (stretch_[k] - 1) - 0.5 * bending * square / (stretch_[k] * stretch_[k]));
  }
  damping_force_.tail(stretch_.size()) = model_.length_damping * rates_.tail(stretch_.size());
}

double DistributedArm::kinetic_energy() const { return 0.5 * flow_rate_.squaredNorm(); }

double DistributedArm::gravity_energy() const {
  double energy = 0;
  for (Eigen::Index j = 0; j < theta_.size(); ++j) {
    const auto section = static_cast<Eigen::Index>(shapes_.section[static_cast<std::size_t>(j)]);
    energy -= weigh_[j] * stretch_[section] * model_.gravity.dot(e_.col(j));
  }
  return energy;
}

double DistributedArm::elastic_energy() const {
  double energy = 0;
  for (Eigen::Index j = 0; j < theta_.size(); ++j) {
    const double stretch = stretch_[static_cast<Eigen::Index>(shapes_.section[static_cast<std::size_t>(j)])];
    const double across = std::cos(q_[j]) * theta_s_[j];
    energy += 0.5 * shapes_.weights[j] *
              (model_.bending_stiffness * (q_s_[j] * q_s_[j] + across * across) / stretch +
               model_.axial_stiffness * (stretch - 1) * (stretch - 1));
  }
  return energy;
}

Eigen::MatrixXd DistributedArm::mass_matrix() const { return flow_.transpose() * flow_; }

bool DistributedArm::accelerate(const Eigen::VectorXd& force, Eigen::VectorXd& acceleration) {
  mass_.setZero();
  mass_.selfadjointView<Eigen::Lower>().rankUpdate(flow_.transpose());
  factor_.compute(mass_);
  acceleration = force - gravity_gradient_ - elastic_gradient_ - damping_force_;
  acceleration.noalias() -= flow_.transpose() * bias_;
  factor_.solve_in_place(acceleration);
  return factor_.is_definite() && acceleration.allFinite();
}

Eigen::Matrix3Xd DistributedArm::positions() const {
  Eigen::Matrix3Xd stretched = e_;
  for (Eigen::Index j = 0; j < stretched.cols(); ++j)
    stretched.col(j) *= stretch_[static_cast<Eigen::Index>(shapes_.section[static_cast<std::size_t>(j)])];
  return stretched * shapes_.running.transpose();
}

Eigen::Vector3d DistributedArm::tip() const {
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  for (Eigen::Index j = 0; j < theta_.size(); ++j)
    tip += shapes_.weights[j] *
           stretch_[static_cast<Eigen::Index>(shapes_.section[static_cast<std::size_t>(j)])] * e_.col(j);
  return tip;
}

}  // namespace flexura
