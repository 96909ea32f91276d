#include "flexura/tasks/dynamics/dynamics_plant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "flexura/kinematics/shape.h"
#include "flexura/math/arrays.h"
#include "flexura/math/direction.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// Returns the given azimuths, shifted so that the first one equals the base's (by whole turns).
std::vector<double> continued(double base, std::vector<double> azimuths) {
  const double turns = azimuths.front() - base;
  for (double& azimuth : azimuths) azimuth -= turns;
  return azimuths;
}

// Returns the distance of the origin from the segment between two points.
double distance_to_path(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double length = way.squaredNorm();
  const double share = length > 0 ? std::clamp(-from.dot(way) / length, 0.0, 1.0) : 0;
  return (from + share * way).norm();
}

// Linear interpolation between values at equal shares.
double linear_between(const std::vector<double>& values, double share) {
  const auto spans = static_cast<double>(values.size() - 1);
  const double at = std::clamp(share, 0.0, 1.0) * spans;
  const std::size_t i = std::min(static_cast<std::size_t>(at), values.size() - 2);
  const double part = at - static_cast<double>(i);
  return (1 - part) * values[i] + part * values[i + 1];
}

// Returns a position along the arm at rest, m, as its section and the share of it.
std::pair<std::size_t, double> place_on(const std::vector<double>& lengths, double s) {
  std::size_t section = 0;
  for (; section + 1 < lengths.size() && s > lengths[section]; ++section) s -= lengths[section];
  return {section, std::clamp(s / lengths[section], 0.0, 1.0)};
}

DistributedArmModel model_of(const DynamicsTask& task, const Arm& arm, const ArmState& from) {
  DistributedArmModel model{.lengths = {},
                            .has_variable_lengths = task.variable_lengths,
                            .density = task.density,
                            .gravity = vector(task.gravity),
                            .bending_stiffness = task.bending_stiffness,
                            .axial_stiffness = task.axial_stiffness,
                            .damping = task.damping,
                            .length_damping = task.length_damping,
                            .clamp = {},
                            .basis = task.basis,
                            .nodes = static_cast<int>(task.nodes),
                            .points = 8};
  for (std::size_t i = 0; i < arm.sections.size(); ++i)
    model.lengths.push_back(arm.sections[i].length * (task.variable_lengths ? 1 : from.stretches[i]));
  const Eigen::Vector2d base = angles_of_direction(arm.X_WB.rotation.col(2));
  model.clamp = {base[0], base[1]};
  // At least as many points as numbers, and some more for products of two shape functions.
  if (task.basis == AngleBasis::polynomial) model.points = std::max(model.points, model.nodes + 2);
  return model;
}

}  // namespace

AnglesAlongArm::AnglesAlongArm(const Arm& arm, const ArmState& state) : backbone_(arm, state) {
  constexpr double step = 0.05;  // In rad of bend.
  const Eigen::Vector3d base = arm.X_WB.rotation.col(2);
  double before = angles_of_direction(base)[0];
  Eigen::Vector2d level = base.head<2>();  // cos q of its length.
  double least_level = level.norm();
  for (const Arc& arc : backbone_.arcs()) {
    const auto count = static_cast<int>(std::ceil(arc.bend.norm() / step)) + 16;
    auto& azimuths = azimuths_.emplace_back();
    for (int i = 0; i <= count; ++i) {
      const Eigen::Vector3d direction = arc.pose(arc.length * i / count).rotation.col(2);
      before = nearest_turn(angles_of_direction(direction)[0], before);
      azimuths.push_back(before);
      least_level = std::min(least_level, distance_to_path(level, direction.head<2>()));
      level = direction.head<2>();
    }
  }
  largest_elevation_ = std::acos(std::min(least_level, 1.0));
}

Eigen::Vector2d AnglesAlongArm::at(std::size_t section, double share) const {
  const Arc& arc = backbone_.arcs()[section];
  const std::vector<double>& azimuths = azimuths_[section];
  Eigen::Vector2d angles = angles_of_direction(arc.pose(share * arc.length).rotation.col(2));
  const auto near = static_cast<std::size_t>(std::round(share * static_cast<double>(azimuths.size() - 1)));
  angles[0] = nearest_turn(angles[0], azimuths[near]);
  return angles;
}

DynamicsPlant::DynamicsPlant(const DynamicsTask& task, const Arm& arm, const ArmState& from)
    : arm_(arm), stretches_(from.stretches), distributed_(model_of(task, arm, from)) {
  const AngleShapes& shapes = distributed_.shapes();
  ends_.resize(static_cast<Eigen::Index>(shapes.lengths.size()), shapes.nodes.size() + 1);
  double end = 0;
  for (std::size_t i = 0; i < shapes.lengths.size(); ++i) {
    end += shapes.lengths[i];
    ends_.row(static_cast<Eigen::Index>(i)) = shapes.at(end);
  }
  start_ = coordinates(from, start_off_);
  is_regular_ = AnglesAlongArm(arm, from).largest_elevation() <= most_elevation;
  const DynamicsTargetConfig& target = task.target;
  ArmState to = from;
  if (!target.azimuths) {
    to = arm_state(arm, target);
    if (!task.variable_lengths) to.stretches = from.stretches;
  } else if (target.stretches) {
    to.stretches = *target.stretches;
  }
  target_ = coordinates(to, target_off_);
  if (!target.azimuths) return;
  const double length = std::accumulate(shapes.lengths.begin(), shapes.lengths.end(), 0.0);
  const std::vector<double> azimuths = continued((*distributed_.model().clamp)[0], *target.azimuths);
  const Angles angles = [&](double s) -> Eigen::Vector2d {
    return {linear_between(azimuths, s / length), linear_between(*target.elevations, s / length)};
  };
  const Eigen::Index numbers = 2 * distributed_.nodes();
  target_.head(numbers) = distributed_.coordinates(angles).head(numbers);
  target_off_ = off(target_, angles);
}

double DynamicsPlant::largest_target_elevation() const {
  const AngleShapes& shapes = distributed_.shapes();
  const Eigen::VectorXd q = target_.segment(distributed_.nodes(), distributed_.nodes());
  const double base = (*distributed_.model().clamp)[1];
  double largest = std::max(std::abs(base), q.cwiseAbs().maxCoeff());
  if (shapes.basis == AngleBasis::sections) return largest;  // Linear between its values.
  // At Chebyshev points, between which a polynomial of so few nodes hardly rises.
  constexpr int steps = 1000;
  const double length = std::accumulate(shapes.lengths.begin(), shapes.lengths.end(), 0.0);
  for (int i = 0; i <= steps; ++i) {
    const Eigen::RowVectorXd row = shapes.at(0.5 * length * (1 - std::cos(std::numbers::pi * i / steps)));
    largest = std::max(largest, std::abs(row.head(q.size()).dot(q) + row[q.size()] * base));
  }
  return largest;
}

Eigen::VectorXd DynamicsPlant::coordinates(const ArmState& state, double& off_by) const {
  const AnglesAlongArm along(arm_, state);
  const std::vector<double>& lengths = distributed_.model().lengths;
  const Angles angles = [&](double s) {
    const auto [section, share] = place_on(lengths, s);
    return along.at(section, share);
  };
  Eigen::VectorXd x = distributed_.coordinates(angles);
  if (distributed_.model().has_variable_lengths)
    for (std::size_t i = 0; i < lengths.size(); ++i)
      x[2 * distributed_.nodes() + static_cast<Eigen::Index>(i)] = lengths[i] * (state.stretches[i] - 1);
  off_by = off(x, angles);
  return x;
}

double DynamicsPlant::off(const Eigen::VectorXd& x, const Angles& angles) const {
  DistributedArm at = distributed_;
  at.set(x, Eigen::VectorXd::Zero(x.size()));
  const AngleShapes& shapes = at.shapes();
  double sum = 0;
  for (Eigen::Index i = 0; i < shapes.s.size(); ++i)
    sum +=
        shapes.weights[i] * (Eigen::Vector2d(at.theta()[i], at.q()[i]) - angles(shapes.s[i])).squaredNorm();
  return std::sqrt(sum / shapes.weights.sum());
}

Eigen::Matrix2Xd DynamicsPlant::end_angles(const Eigen::VectorXd& x) const {
  const Eigen::Index n = distributed_.nodes();
  const std::array<double, 2>& clamp = *distributed_.model().clamp;
  Eigen::Matrix2Xd angles(2, ends_.rows());
  for (Eigen::Index i = 0; i < 2; ++i)
    angles.row(i) = (ends_.leftCols(n) * x.segment(i * n, n)).transpose() +
                    clamp[static_cast<std::size_t>(i)] * ends_.col(n).transpose();
  return angles;
}

ArmState DynamicsPlant::state(const Eigen::VectorXd& x, const ArmState& before) const {
  const Eigen::Matrix2Xd ends = end_angles(x);
  ArmState state = before;
  Eigen::Matrix3d R_WS = arm_.X_WB.rotation;
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    const auto section = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d tangent = R_WS.transpose() * direction_of_angles(ends.col(section));
    const double across = tangent.head<2>().norm(), turn = std::atan2(across, tangent.z());
    const Eigen::Vector2d old = before.bends[i];
    Eigen::Vector2d side = Eigen::Vector2d::UnitX();
    if (across > 0) {
      side = tangent.head<2>() / across;
    } else if (old.norm() > 0) {
      side = old.normalized();  // Straight on, or back: the arc keeps its previous side.
    }
    // Arcs on this side that differ by whole turns have the same tangent.
    const double turns = std::round((old.dot(side) - turn) / (2 * std::numbers::pi));
    state.bends[i] = (turn + 2 * std::numbers::pi * turns) * side;
    if (arm_.kind == ArmKind::planar) state.bends[i].y() = 0;  // Zero up to rounding.
    state.stretches[i] = stretches_[i];
    if (distributed_.model().has_variable_lengths)
      state.stretches[i] = 1 + x[2 * distributed_.nodes() + section] / distributed_.model().lengths[i];
    R_WS *= arc_pose(state.bends[i], 1).rotation;
  }
  return state;
}

}  // namespace flexura
