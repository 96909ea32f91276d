#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/math/se3.h"

namespace flexura {

/// A place on a rod: a part, from 0 to 1, of one of its sections.
struct RodPlace {
  std::size_t section = 0;
  double at = 1;

  bool operator==(const RodPlace&) const = default;
};

/// Where a node of a rod is, and its twist [v; w] about the origin of the rod's base, in the base's axes: the
/// velocity of a point p of it is v + w x p.
struct NodeMotion {
  Pose pose;
  Vector6d twist = Vector6d::Zero();
};

/// What pulls at a node: a wrench [f; m] about the same origin, and its derivatives by a small twist of the
/// node and by its twist.
struct NodePull {
  Vector6d wrench = Vector6d::Zero();
  Matrix6d by_pose = Matrix6d::Zero();
  Matrix6d by_twist = Matrix6d::Zero();
  /// Nothing pulls: all above is 0, and need not be read.
  bool is_idle = false;
  /// The symmetric parts of -by_pose and -by_twist may have negative eigenvalues (friction, geometry), with
  /// which a step's matrix may have no factor. Where `is_held` it is made of these instead, which have none:
  /// it then solves the step's equations in more iterations, and the solution is the same.
  bool is_held = false;
  Matrix6d stiffness = Matrix6d::Zero();
  Matrix6d damping = Matrix6d::Zero();
  /// Its place is tied to others by ties, whose motion changes the wrench, too: couple() and tie() say how.
  /// What they do is in `wrench` alone.
  bool is_coupled = false;

  /// Nothing pulls.
  void clear() {
    if (is_idle) return;
    *this = NodePull{};
    is_idle = true;
  }
  /// Both pull.
  NodePull& operator+=(const NodePull& other);
};

/// What the motion of a point changes of the wrench at one.
struct PointCoupling {
  std::size_t of = 0,
              at = 0;  ///< Of the points that were chosen: what the first's motion does at the second.
  Matrix6d by_pose = Matrix6d::Zero(), by_twist = Matrix6d::Zero();
};

/// What holds several points against each other. Their relative velocity is the sum of rows[i] times the
/// twist of points[i].
struct PointTie {
  static constexpr std::size_t most = 5;
  std::array<std::size_t, most> points{};  ///< Of those that were chosen.
  std::array<Eigen::Matrix<double, 3, 6>, most> rows;
  /// Against that relative motion, symmetric and positive semidefinite, as NodePull has them.
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero(), damping = Eigen::Matrix3d::Zero();
};

/// What else pulls at a rod in motion, as it moves: contact, drag, springs. It pulls at the rod's nodes, and
/// at points between them, which cost nothing where nothing is near.
class RodSurroundings {
 public:
  virtual ~RodSurroundings() = default;
  /// Of all nodes, from the base on: the last node of a section and the first of the next lie in one place,
  /// and are both there. `run`: metres of rod for each node in an integral along it. Sets all of `pulls`, and
  /// allocates nothing if steps are not to.
  virtual void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
                    std::span<NodePull> pulls) const = 0;

  /// The places beside the nodes where it may pull; they may be nodes as well. They stay the same.
  [[nodiscard]] virtual std::span<const RodPlace> points() const { return {}; }
  /// Adds which of the points it wants to see, rising, where the nodes are so. `lengths`: of the rod between
  /// nodes, at most, m; of all sections after each other. What is not chosen is not pulled at.
  virtual void choose(std::span<const NodeMotion> /*nodes*/, std::span<const double> /*lengths*/,
                      std::vector<std::size_t>& /*chosen*/) const {}
  /// What pulls at the points that were chosen. Sets all of `pulls`.
  virtual void pull_points(std::span<const std::size_t> /*chosen*/, std::span<const NodeMotion> /*points*/,
                           std::span<NodePull> /*pulls*/) const {}
  /// Of pulls that are coupled: adds all their derivatives, those by their own motion too.
  virtual void couple(std::span<const std::size_t> /*chosen*/, std::span<const NodeMotion> /*points*/,
                      std::vector<PointCoupling>& /*couplings*/) const {}
  /// Of the same: adds what holds them, for a step's matrix.
  virtual void tie(std::span<const std::size_t> /*chosen*/, std::span<const NodeMotion> /*points*/,
                   std::vector<PointTie>& /*ties*/) const {}
};

}  // namespace flexura
