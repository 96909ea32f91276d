#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/math/se3.h"

namespace flexura {

/// A place on a rod: one of its sections, and the position as a fraction of the section's length, from 0 to
/// 1.
struct RodPlace {
  std::size_t section = 0;
  double at = 1;

  bool operator==(const RodPlace&) const = default;
};

/// Pose of a node of a rod, and its twist [v; w] about the origin of the rod's base, in the base's axes. A
/// point p of the node has the velocity v + w x p.
struct NodeMotion {
  Pose pose;
  Vector6d twist = Vector6d::Zero();
};

/// Wrench [f; m] on a node about the base's origin. `by_pose`: derivative with respect to a small
/// displacement twist of the node. `by_twist`: derivative with respect to the node's velocity twist.
struct NodePull {
  Vector6d wrench = Vector6d::Zero();
  Matrix6d by_pose = Matrix6d::Zero();
  Matrix6d by_twist = Matrix6d::Zero();
  /// Whether wrench and derivatives are 0.
  bool is_idle = false;
  /// Friction and geometry may cause negative eigenvalues of the symmetric parts of -by_pose and -by_twist.
  /// With such eigenvalues, the matrix of a step may not be positive definite. If `is_held`, this matrix uses
  /// the semidefinite `stiffness` and `damping` instead. The solution of a step is then the same, but needs
  /// more iterations.
  bool is_held = false;
  Matrix6d stiffness = Matrix6d::Zero();
  Matrix6d damping = Matrix6d::Zero();
  /// Whether a part of the wrench depends on the motion of other points (couple(), tie()). This part is
  /// included in `wrench`, but not in the other members.
  bool is_coupled = false;

  /// Removes the wrench.
  void clear() {
    if (is_idle) return;
    *this = NodePull{};
    is_idle = true;
  }
  /// Adds another wrench.
  NodePull& operator+=(const NodePull& other);
};

/// Derivative of the wrench at one point with respect to the motion of another.
struct PointCoupling {
  std::size_t of = 0,
              /// Indices among the chosen points: the motion of point `of` affects the wrench at point `at`.
      at = 0;
  Matrix6d by_pose = Matrix6d::Zero(), by_twist = Matrix6d::Zero();
};

/// Coupling of several points of a rod by a spring and a damper. The relative velocity of the points is the
/// sum of rows[i] times the twist of points[i].
struct PointTie {
  static constexpr std::size_t most = 5;
  std::array<std::size_t, most> points{};  ///< Indices among the chosen points.
  std::array<Eigen::Matrix<double, 3, 6>, most> rows;
  /// Stiffness and damping of the relative motion, symmetric and positive semidefinite, as in NodePull.
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero(), damping = Eigen::Matrix3d::Zero();
};

/// External wrenches on a rod in motion: contact, drag, springs. The wrenches act at the rod's nodes and at
/// points between nodes. Points that are not chosen need no computing time.
class RodSurroundings {
 public:
  virtual ~RodSurroundings() = default;
  /// Computes wrenches at all nodes, from the base on. The last node of a section and the first node of the
  /// next section are at the same place, but are separate nodes. `run`: length of rod that each node
  /// represents in an integral along the rod, m. The function must set all elements of `pulls`. If steps must
  /// not allocate memory, this function must not either.
  virtual void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
                    std::span<NodePull> pulls) const = 0;

  /// Returns the places where wrenches may act in addition to the wrenches at nodes. A place may be at a
  /// node. The places are constant.
  [[nodiscard]] virtual std::span<const RodPlace> points() const { return {}; }
  /// Appends to `chosen`, in increasing order, the indices of the points to evaluate for these node motions.
  /// `lengths`: upper bounds of the rod's lengths between nodes, m, from base to tip. Points that are not
  /// chosen have no wrench.
  virtual void choose(std::span<const NodeMotion> /*nodes*/, std::span<const double> /*lengths*/,
                      std::vector<std::size_t>& /*chosen*/) const {}
  /// Computes wrenches at the chosen points. The function must set all elements of `pulls`.
  virtual void pull_points(std::span<const std::size_t> /*chosen*/, std::span<const NodeMotion> /*points*/,
                           std::span<NodePull> /*pulls*/) const {}
  /// If wrenches at several points are coupled, appends all derivatives of these wrenches, including those
  /// with respect to the motion of the same point.
  virtual void couple(std::span<const std::size_t> /*chosen*/, std::span<const NodeMotion> /*points*/,
                      std::vector<PointCoupling>& /*couplings*/) const {}
  /// If wrenches at several points are coupled, appends their couplings, which are terms of a step's matrix.
  virtual void tie(std::span<const std::size_t> /*chosen*/, std::span<const NodeMotion> /*points*/,
                   std::vector<PointTie>& /*ties*/) const {}
};

}  // namespace flexura
