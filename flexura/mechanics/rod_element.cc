#include "flexura/mechanics/rod_element.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "flexura/math/so3.h"
#include "flexura/mechanics/rod_spring.h"

namespace flexura {
namespace {

// Returns the wrench of a force f at p, and of a moment.
Vector6d wrench_at(const Eigen::Vector3d& p, const Eigen::Vector3d& f, const Eigen::Vector3d& moment) {
  Vector6d W;
  W << f, p.cross(f) + moment;
  return W;
}

// Derivative of the wrench of a dead force on point p of a body, by a twist of the body.
Matrix6d dead_force_slope(const Eigen::Vector3d& p, const Eigen::Vector3d& f) {
  Matrix6d D = Matrix6d::Zero();
  const Eigen::Matrix3d F = skew(f);
  D.bottomLeftCorner<3, 3>() = -F;
  D.bottomRightCorner<3, 3>() = F * skew(p);
  return D;
}

// Derivative of a wrench that follows the body.
Matrix6d following_slope(const Vector6d& W) { return -bracket_form(W).transpose(); }

}  // namespace

bool RodElement::is_coarse() const {
  constexpr double most_last = 0.3;    // Of the last polynomial, rad in the piece.
  constexpr double most_beside = 0.1;  // Of the nearest tendon's distance.
  if (!has_chords()) return false;
  const double piece = length_ / static_cast<double>(grid_.disks.size() - 1);
  double last = 0, curvature = 0, nearest = std::numeric_limits<double>::infinity();
  for (std::size_t c = 3; c < 5; ++c)
    if (grid_.count[c] > 0) last = std::hypot(last, q_[grid_.first[c] + grid_.count[c] - 1]);
  if (grid_.disks.size() == 2 && std::ranges::max(grid_.count[3], grid_.count[4]) > 2)
    return last * piece > most_last;
  for (const Vector6d& strain : strain_) curvature = std::max(curvature, strain.segment<2>(3).norm());
  for (const std::vector<Passage>& passages : passages_)
    nearest = std::min(nearest, passages.front().offset.norm());
  return curvature * piece * piece / 8 > most_beside * nearest;
}

RodElement::RodElement(RodPart part, std::span<const TendonRoute> tendons, std::span<const double> at)
    : part_(std::move(part)), grid_(part_.rod, at), length_(part_.rod.length) {
  for (std::size_t i = 0; i < tendons.size(); ++i) {
    if (tendons[i].section < part_.section) continue;
    tendons_.push_back(i);
    std::vector<Passage>& passages = passages_.emplace_back();
    for (const double t : grid_.t) {
      const TendonRoute::Offset offset = tendons[i].at(part_.s_base + t * length_);
      passages.push_back({offset.value, offset.slope, offset.second});
    }
  }
  const auto n = static_cast<Eigen::Index>(size());
  const std::size_t nodes = grid_.t.size();
  const auto count = static_cast<Eigen::Index>(tendons.size());
  residual = by_share = by_place_ = q_ = Eigen::VectorXd::Zero(n);
  tangent = Eigen::MatrixXd::Zero(n, n);
  by_base = Eigen::MatrixXd::Zero(n, 6);
  wrench_by_modes = step_ = moved_ = turned_ = Columns::Zero(6, n);
  tendon_lengths = Eigen::VectorXd::Zero(count);
  length_slopes = pull_slopes = Eigen::MatrixXd::Zero(n, count);
  strain_ = grid_.rest;
  rates_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(nodes));
  X_.resize(nodes);
  A_.resize(nodes, Columns::Zero(6, n));
  exp_.resize(nodes - 1, TwistExponential(Vector6d::Zero()));
  const Vector6d still = Vector6d::Zero();
  twist_.resize(nodes - 1, MagnusStep({still, still, still}));
  by_moments_.resize(nodes - 1);
  across_.resize(nodes - 1, still);
  F_.resize(nodes, Vector6d::Zero());
  D_.resize(nodes, Matrix6d::Zero());
}

void RodElement::set_modes(const Eigen::Ref<const Eigen::VectorXd>& q) {
  q_ = q;
  for (std::size_t k = 0; k < strain_.size(); ++k)
    strain_[k] = grid_.strain(grid_.rest[k], q_, grid_.at_node.col(static_cast<Eigen::Index>(k)));
}

MagnusStep::Moments RodElement::moments_of(std::size_t interval) const {
  MagnusStep::Moments moments;
  for (std::size_t m = 0; m < 3; ++m) {
    moments[m] = grid_.strain(grid_.rest_moments[interval][m], q_,
                              grid_.moments[m].col(static_cast<Eigen::Index>(interval)));
  }
  return moments;
}

void RodElement::place(const Pose& X_BS) {
  X_[0] = X_BS;
  for (std::size_t i = 0; i < exp_.size(); ++i)
    X_[i + 1] = X_[i] * se3_exp(MagnusStep(moments_of(i)).twist());
}

void RodElement::place_with_columns(const Pose& X_BS) {
  X_[0] = X_BS;
  for (std::size_t i = 0; i < exp_.size(); ++i) {
    twist_[i] = MagnusStep(moments_of(i));
    by_moments_[i] = twist_[i].slopes();
    exp_[i] = TwistExponential(twist_[i].twist());
    X_[i + 1] = X_[i] * exp_[i].pose;
    // Motion of the interval's end by the moments of its strain.
    const Matrix6d moves = adjoint(X_[i]) * exp_[i].jacobian;
    A_[i + 1] = A_[i];
    for (std::size_t m = 0; m < 3; ++m) {
      const Matrix6d by_moment = moves * by_moments_[i][m];
      const auto modes = grid_.moments[m].col(static_cast<Eigen::Index>(i));
      grid_.for_modes([&](int c, int j) { A_[i + 1].col(j) += modes[j] * by_moment.col(c); });
    }
  }
}

void RodElement::add_block(const Matrix6d& block, const Eigen::MatrixXd& left, const Eigen::MatrixXd& right,
                           std::size_t column, double factor) {
  const auto at = static_cast<Eigen::Index>(column);
  grid_.for_modes([&](int b, int l) {
    const double by = factor * right(l, at);
    grid_.for_modes([&](int a, int j) { tangent(j, l) += block(a, b) * by * left(j, at); });
  });
}

void RodElement::stress(std::span<const double> tension) {
  residual.setZero();
  tangent.setZero();
  tendon_lengths.setZero();
  length_slopes.setZero();
  pull_slopes.setZero();
  strain_energy = 0;
  least_chord = 1;
  std::ranges::fill(across_, Vector6d::Zero());
  for (std::size_t k = 0; k < grid_.t.size(); ++k) {
    const double weight = grid_.weight[k] * length_;
    if (weight == 0) continue;
    const Vector6d& strain = strain_[k];
    Vector6d force = grid_.stiffness[k].cwiseProduct(strain - grid_.rest[k]);
    strain_energy += 0.5 * weight * force.dot(strain - grid_.rest[k]);
    Matrix6d by_strain = grid_.stiffness[k].asDiagonal();
    const auto column = static_cast<Eigen::Index>(k);
    for (std::size_t i = 0; i < tendons_.size() && !has_chords(); ++i) {
      const Passage& passage = passages_[i][k];
      const Eigen::Vector3d& d = passage.offset;
      const Eigen::Vector3d along = way(passage, strain);
      const double stretch = along.norm();
      const Eigen::Vector3d u = along / stretch;
      Vector6d slope;
      slope << u, d.cross(u);
      const auto place = static_cast<Eigen::Index>(tendons_[i]);
      tendon_lengths[place] += weight * stretch;
      grid_.for_modes([&](int c, int j) {
        const double by_mode = weight * slope[c] * grid_.at_node(j, column);
        length_slopes(j, place) += by_mode;
        pull_slopes(j, place) += passage.left * by_mode;
      });
      const double pull = tension[tendons_[i]] * passage.left;
      if (pull == 0) continue;
      force += pull * slope;
      const Eigen::Matrix3d across = pull / stretch * (Eigen::Matrix3d::Identity() - u * u.transpose());
      const Eigen::Matrix3d cross = skew(d), mixed = across * cross;
      by_strain.topLeftCorner<3, 3>() += across;
      by_strain.topRightCorner<3, 3>() -= mixed;
      by_strain.bottomLeftCorner<3, 3>() -= mixed.transpose();
      by_strain.bottomRightCorner<3, 3>() -= cross * mixed;
    }
    grid_.for_modes([&](int c, int j) { residual[j] += weight * force[c] * grid_.at_node(j, column); });
    add_block(by_strain, grid_.at_node, grid_.at_node, k, weight);
  }
  for (std::size_t piece = 0; piece + 1 < grid_.disks.size(); ++piece)
    add_chords(grid_.disks[piece], grid_.disks[piece + 1], tension);
  by_share.setZero();
  by_base.setZero();
  wrench_by_modes.setZero();
  wrench_by_base.setZero();
  wrench.setZero();
}

// The wrench factor * W on everything beyond an interval turns with everything before it, from the node
// `from` on. Its effect on the interval's own twist is left to add_bending().
void RodElement::add_geometry(std::size_t interval, const Vector6d& W, std::size_t from, double factor) {
  across_[interval] += factor * W;
  step_.noalias() = A_[interval + 1] - A_[interval];
  if (interval == from) return;
  moved_.noalias() = A_[interval] - A_[from];
  turned_.noalias() = bracket_form(W).transpose().lazyProduct(moved_);
  tangent.noalias() += factor * step_.transpose().lazyProduct(turned_);
}

// The twists of an interval's parts do not commute: adds the second derivative of its twist by the moments of
// its strain, times the wrench on it.
void RodElement::add_bending() {
  for (std::size_t interval = 0; interval < across_.size(); ++interval) {
    if (across_[interval].isZero(0)) continue;
    const Vector6d local = adjoint(X_[interval]).transpose() * across_[interval];
    const Matrix6d form = exp_[interval].jacobian_form(local).transpose();
    MagnusStep::Form second = twist_[interval].form(exp_[interval].jacobian.transpose() * local);
    const MagnusStep::Slopes& by = by_moments_[interval];
    for (std::size_t b = 0; b < 3; ++b) {
      const Matrix6d turned = form * by[b];
      for (std::size_t a = 0; a < 3; ++a) {
        second[a][b] += by[a].transpose() * turned;
        add_block(second[a][b], grid_.moments[a], grid_.moments[b], interval, 1);
      }
    }
  }
}

// The energy of a straight piece is its tension times its length. All tendons between the same two disks move
// with the same columns, so that their wrenches are added before the products with these.
void RodElement::add_chords(std::size_t from, std::size_t to, std::span<const double> tensions) {
  moved_.noalias() = A_[to] - A_[from];
  Vector6d pull = Vector6d::Zero();
  Matrix6d turned = Matrix6d::Zero();
  for (std::size_t i = 0; i < tendons_.size(); ++i) {
    const Passage& begin = passages_[i][from];
    const Eigen::Vector3d a = X_[from] * begin.offset, b = X_[to] * passages_[i][to].offset;
    const double distance = (b - a).norm();
    const Eigen::Vector3d u = (b - a) / distance;
    const Vector6d W = wrench_at(a, u, Eigen::Vector3d::Zero());
    const auto place = static_cast<Eigen::Index>(tendons_[i]);
    tendon_lengths[place] += distance;
    by_place_.noalias() = moved_.transpose().lazyProduct(W);
    length_slopes.col(place) += by_place_;
    pull_slopes.col(place) += begin.left * by_place_;
    const double tension = tensions[tendons_[i]] * begin.left;
    if (tension == 0) continue;
    least_chord = std::min(least_chord, distance / ((grid_.t[to] - grid_.t[from]) * length_));
    pull += tension * W;
    // Motion of the end b relative to a.
    Eigen::Matrix<double, 3, 6> point;
    point << Eigen::Matrix3d::Identity(), -skew(b);
    const Eigen::Matrix<double, 3, 6> across =
        tension / distance * (Eigen::Matrix3d::Identity() - u * u.transpose()) * point;
    turned.topRows<3>() += across;
    turned.bottomRows<3>() += skew(a) * across;
  }
  if (turned.isZero(0)) return;
  residual.noalias() += moved_.transpose().lazyProduct(pull);
  turned_.noalias() = turned.lazyProduct(moved_);
  tangent.noalias() += moved_.transpose().lazyProduct(turned_);
  for (std::size_t interval = from; interval < to; ++interval) add_geometry(interval, pull, from, 1);
}

void RodElement::add_stiffness_slopes(Eigen::Ref<Eigen::MatrixXd> slopes) const {
  constexpr std::array<int, 6> parameter = {0, 0, 1, 2, 2, 3};
  for (std::size_t k = 0; k < grid_.t.size(); ++k) {
    const Vector6d force =
        grid_.weight[k] * length_ * grid_.stiffness[k].cwiseProduct(strain_[k] - grid_.rest[k]);
    grid_.for_modes([&](int c, int j) {
      slopes(j, parameter[static_cast<std::size_t>(c)]) +=
          force[c] * grid_.at_node(j, static_cast<Eigen::Index>(k));
    });
  }
}

void RodElement::add_weight_slope(const Eigen::Vector3d& gravity, Vector6d& all,
                                  Eigen::Ref<Eigen::VectorXd> slope) const {
  for (std::size_t k = 0; k < grid_.t.size(); ++k) {
    const Vector6d W =
        wrench_at(X_[k].position, grid_.weight[k] * length_ * grid_.mass_per_length[k] * gravity,
                  Eigen::Vector3d::Zero());
    slope -= A_[k].transpose() * W;
    all += W;
  }
}

Eigen::MatrixXd RodElement::stiffness() const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size(), size());
  for (std::size_t k = 0; k < grid_.t.size(); ++k) {
    const Vector6d weighted = grid_.weight[k] * length_ * grid_.stiffness[k];
    const auto modes = grid_.at_node.col(static_cast<Eigen::Index>(k));
    grid_.for_modes([&](int a, int j) {
      grid_.for_modes([&](int b, int l) {
        if (a == b) sum(j, l) += weighted[a] * modes[j] * modes[l];
      });
    });
  }
  return sum;
}

double RodElement::load_energy(const RodLoads& loads) const {
  double sum = 0;
  for (std::size_t k = 0; k < grid_.t.size(); ++k)
    sum -= grid_.weight[k] * length_ *
           (grid_.mass_per_length[k] * loads.gravity + loads.per_length).dot(X_[k].position);
  const std::vector<PointMass>& masses = part_.rod.masses;
  for (std::size_t i = 0; i < masses.size(); ++i)
    sum -= masses[i].mass * loads.gravity.dot(X_[grid_.mass_nodes[i]] * masses[i].offset);
  for (const EndLoad& end : loads.ends)
    if (end.section == part_.section && part_.is_last) sum -= end.force.dot(X_.back().position);
  return sum;
}

// Computes the forces of all loads at each node.
void RodElement::find_forces(const RodLoads& loads) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < grid_.t.size(); ++k) {
    const Eigen::Vector3d f =
        grid_.weight[k] * length_ * (grid_.mass_per_length[k] * loads.gravity + loads.per_length);
    F_[k] = wrench_at(X_[k].position, f, none);
    D_[k] = dead_force_slope(X_[k].position, f);
  }
  const std::vector<PointMass>& masses = part_.rod.masses;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const std::size_t node = grid_.mass_nodes[i];
    const Eigen::Vector3d f = masses[i].mass * loads.gravity, p = X_[node] * masses[i].offset;
    F_[node] += wrench_at(p, f, none);
    D_[node] += dead_force_slope(p, f);
  }
  for (const EndLoad& end : loads.ends) {
    if (end.section != part_.section || !part_.is_last) continue;
    const Pose& X = X_.back();
    if (end.following) {
      const Vector6d W = wrench_at(X.position, X.rotation * end.force, X.rotation * end.moment);
      F_.back() += W;
      D_.back() += following_slope(W);
    } else {
      F_.back() += wrench_at(X.position, end.force, end.moment);
      D_.back() += dead_force_slope(X.position, end.force);
    }
  }
  for (const PointSpring& spring : loads.springs) {
    if (!part_.holds({spring.section, spring.at})) continue;
    const std::size_t node = grid_.node_at(part_.within(spring.at));
    const SpringPull pull = spring_pull(spring, X_[node].position);
    F_[node] += pull.wrench;
    D_[node] += pull.by_pose;
  }
}

void RodElement::load(const RodLoads& loads, double share, const Vector6d& beyond) {
  find_forces(loads);
  Vector6d W = beyond;
  for (std::size_t k = grid_.t.size() - 1; k > 0; --k) {
    W += F_[k];
    add_geometry(k - 1, W, 0, -share);
    // step_ is the motion of the interval's end by it.
    by_share.noalias() -= step_.transpose().lazyProduct(W);
    by_base.noalias() += share * step_.transpose().lazyProduct(bracket_form(W).transpose());
    moved_.noalias() = Matrix6d(share * D_[k]).lazyProduct(A_[k]);
    by_base.noalias() += share * A_[k].transpose().lazyProduct(D_[k]);
    tangent.noalias() -= A_[k].transpose().lazyProduct(moved_);
    wrench_by_modes += moved_;
    wrench_by_base += share * D_[k];
    wrench += F_[k];
  }
  wrench_by_base += share * D_[0];
  wrench += F_[0];
  residual += share * by_share;
}

}  // namespace flexura
