#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/math/se3.h"

namespace flexura {

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
  /// Another node's motion changes the wrench, too: couple() says how.
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

/// What the motion of a node changes of the wrench at another.
struct NodeCoupling {
  std::size_t of = 0, at = 0;  ///< Of all nodes.
  Matrix6d by_pose = Matrix6d::Zero(), by_twist = Matrix6d::Zero();
};

/// What else pulls at a rod in motion, as it moves: contact, drag, springs.
class RodSurroundings {
 public:
  virtual ~RodSurroundings() = default;
  /// Of all nodes, from the base on: the last node of a section and the first of the next lie in one place,
  /// and are both there. `run`: metres of rod for each node in an integral along it. Sets all of `pulls`, and
  /// allocates nothing if steps are not to.
  virtual void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
                    std::span<NodePull> pulls) const = 0;
  /// Of nodes whose pulls are coupled: adds what each does to the other.
  virtual void couple(std::span<const NodeMotion> /*nodes*/, std::span<const double> /*run*/,
                      std::vector<NodeCoupling>& /*couplings*/) const {}
};

}  // namespace flexura
