// What friction leaves of tendons' tensions along a section, and how that changes with its shape.
#include <algorithm>
#include <cmath>

#include "flexura/mechanics/rod_element.h"

namespace flexura {
namespace {

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Of unit vectors, by changes of both; 0 where they are one, for there it has no derivative.
double angle_change(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& da,
                    const Eigen::Vector3d& db) {
  const Eigen::Vector3d cross = a.cross(b);
  const double sine = cross.norm();
  if (sine == 0) return 0;
  return cross.dot(da.cross(b) + a.cross(db)) / sine * a.dot(b) - (da.dot(b) + a.dot(db)) * sine;
}

Eigen::Vector3d unit_change(const Eigen::Vector3d& vector, const Eigen::Vector3d& change) {
  const Eigen::Vector3d unit = vector.normalized();
  return (change - unit * unit.dot(change)) / vector.norm();
}

}  // namespace

// How a tendon goes on for each metre of the section, in the cross-section's frame.
Eigen::Vector3d RodElement::way(const Passage& passage, const Vector6d& strain) {
  return strain.head<3>() + strain.tail<3>().cross(passage.offset) + passage.slope;
}

// How that changes for each metre, the turning of the frame included.
Eigen::Vector3d RodElement::path_slope(const Passage& passage, const Vector6d& strain,
                                       const Vector6d& slope) {
  const Eigen::Vector3d u = strain.tail<3>();
  return u.cross(way(passage, strain)) + slope.head<3>() + slope.tail<3>().cross(passage.offset) +
         u.cross(passage.slope) + passage.second;
}

const std::vector<RodElement::Passage>* RodElement::passages_of(std::size_t tendon) const {
  const auto found = std::ranges::find(tendons_, tendon);
  return found == tendons_.end() ? nullptr : &passages_[static_cast<std::size_t>(found - tendons_.begin())];
}

Vector6d RodElement::strain_slope(std::size_t node) const {
  return grid_.strain(grid_.rest_slope[node], q_, grid_.slope_at_node.col(static_cast<Eigen::Index>(node)));
}

void RodElement::rub(std::size_t tendon, double friction, Run& run) {
  const auto found = std::ranges::find(tendons_, tendon);
  if (found == tendons_.end()) return;
  std::vector<Passage>& passages = passages_[static_cast<std::size_t>(found - tendons_.begin())];
  const auto turn_to = [&](const Eigen::Vector3d& direction) {
    if (!run.direction.isZero(0)) run.turned += angle_between(run.direction, direction);
    run.direction = direction;
  };
  if (has_chords()) {
    run.direction = X_.front().rotation * run.direction;
    for (std::size_t piece = 0; piece + 1 < grid_.disks.size(); ++piece) {
      const std::size_t from = grid_.disks[piece], to = grid_.disks[piece + 1];
      turn_to((X_[to] * passages[to].offset - X_[from] * passages[from].offset).normalized());
      passages[from].left = std::exp(-friction * run.turned);
    }
    run.direction = X_.back().rotation.transpose() * run.direction;
    return;
  }
  turn_to(way(passages.front(), strain_.front()).normalized());
  for (std::size_t k = 0; k < passages.size(); ++k) {
    const Eigen::Vector3d along = way(passages[k], strain_[k]);
    rates_[static_cast<Eigen::Index>(k)] =
        along.cross(path_slope(passages[k], strain_[k], strain_slope(k))).norm() / along.squaredNorm();
  }
  const double before = run.turned;
  for (std::size_t k = 0; k < passages.size(); ++k) {
    run.turned = before + length_ * grid_.cumulative.row(static_cast<Eigen::Index>(k)).dot(rates_);
    passages[k].left = std::exp(-friction * run.turned);
  }
  run.direction = way(passages.back(), strain_.back()).normalized();
}

void RodElement::rub_change(std::size_t tendon, double friction, double tension, const Eigen::VectorXd& dq,
                            Run& run, RunChange& change, Eigen::Ref<Eigen::VectorXd> residual_change) const {
  const std::vector<Passage>* passages = passages_of(tendon);
  if (passages == nullptr) return;
  const auto turn_to = [&](const Eigen::Vector3d& direction, const Eigen::Vector3d& direction_change) {
    if (!run.direction.isZero(0))
      change.turned += angle_change(run.direction, direction, change.direction, direction_change);
    run.direction = direction;
    change.direction = direction_change;
  };
  if (has_chords()) {
    // Directions in the base's frame, in which they turn with the section's base and end.
    const auto in_base = [&](const Pose& X, const Vector6d& twist) {
      run.direction = X.rotation * run.direction;
      change.direction = X.rotation * change.direction + twist.tail<3>().cross(run.direction);
    };
    in_base(X_.front(), change.base);
    const auto moved = [&](std::size_t node, const Eigen::Vector3d& point) {
      const Vector6d twist = change.base + A_[node] * dq;
      return Eigen::Vector3d(twist.head<3>() + twist.tail<3>().cross(point));
    };
    for (std::size_t piece = 0; piece + 1 < grid_.disks.size(); ++piece) {
      const std::size_t from = grid_.disks[piece], to = grid_.disks[piece + 1];
      const Eigen::Vector3d a = X_[from] * (*passages)[from].offset, b = X_[to] * (*passages)[to].offset;
      const Eigen::Vector3d u = (b - a).normalized();
      turn_to(u, unit_change(b - a, moved(to, b) - moved(from, a)));
      Vector6d W;
      W << u, a.cross(u);
      const double left_change = -friction * (*passages)[from].left * change.turned;
      residual_change += tension * left_change * ((A_[to] - A_[from]).transpose() * W);
    }
    const Vector6d end = change.base + A_.back() * dq;
    const Eigen::Matrix3d& R = X_.back().rotation;
    change.direction = R.transpose() * (change.direction - end.tail<3>().cross(run.direction));
    run.direction = R.transpose() * run.direction;
    return;
  }
  const Vector6d none = Vector6d::Zero();
  const auto strain_change = [&](const Eigen::MatrixXd& modes, std::size_t node) {
    return grid_.strain(none, dq, modes.col(static_cast<Eigen::Index>(node)));
  };
  const auto path_change = [&](std::size_t node) {
    const Vector6d strain = strain_change(grid_.at_node, node);
    return Eigen::Vector3d(strain.head<3>() + strain.tail<3>().cross((*passages)[node].offset));
  };
  const Eigen::Vector3d first = way((*passages)[0], strain_[0]);
  turn_to(first.normalized(), unit_change(first, path_change(0)));
  const std::size_t nodes = grid_.t.size();
  Eigen::VectorXd rate_changes(static_cast<Eigen::Index>(nodes));
  for (std::size_t k = 0; k < nodes; ++k) {
    const Passage& passage = (*passages)[k];
    const Eigen::Vector3d along = way(passage, strain_[k]),
                          turning = path_slope(passage, strain_[k], strain_slope(k));
    const Vector6d by_strain = strain_change(grid_.at_node, k),
                   by_slope = strain_change(grid_.slope_at_node, k);
    const Eigen::Vector3d d_along = path_change(k), du = by_strain.tail<3>();
    const Eigen::Vector3d d_turning = du.cross(along) + strain_[k].tail<3>().cross(d_along) +
                                      by_slope.head<3>() + by_slope.tail<3>().cross(passage.offset) +
                                      du.cross(passage.slope);
    const Eigen::Vector3d cross = along.cross(turning);
    const double size = cross.norm(), square = along.squaredNorm();
    double rate_change = -2 * size / square * along.dot(d_along);
    if (size > 0) rate_change += cross.dot(d_along.cross(turning) + along.cross(d_turning)) / size;
    rate_changes[static_cast<Eigen::Index>(k)] = rate_change / square;
  }
  const double before = change.turned;
  for (std::size_t k = 0; k < nodes; ++k) {
    const Passage& passage = (*passages)[k];
    change.turned = before + length_ * grid_.cumulative.row(static_cast<Eigen::Index>(k)).dot(rate_changes);
    const double weight = grid_.weight[k] * length_;
    if (weight == 0) continue;
    const Eigen::Vector3d u = way(passage, strain_[k]).normalized();
    Vector6d slope;
    slope << u, passage.offset.cross(u);
    const double pull = -tension * friction * passage.left * change.turned * weight;
    grid_.for_modes([&](int c, int j) {
      residual_change[j] += pull * slope[c] * grid_.at_node(j, static_cast<Eigen::Index>(k));
    });
  }
  const Eigen::Vector3d last = way(passages->back(), strain_.back());
  run.direction = last.normalized();
  change.direction = unit_change(last, path_change(nodes - 1));
}

}  // namespace flexura
