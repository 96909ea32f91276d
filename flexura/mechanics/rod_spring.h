#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/math/se3.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// What is wrong with a spring, in words: numbers that are not finite or out of bounds. "": nothing.
[[nodiscard]] std::string spring_problem(const PointSpring& spring);

/// The force of a spring at a point of the rod, N; both in the base's frame. It has an energy.
[[nodiscard]] Eigen::Vector3d spring_force(const PointSpring& spring, const Eigen::Vector3d& point);

/// That as a wrench about the base's origin, and its derivative by a small twist of the node at that point.
struct SpringPull {
  Vector6d wrench = Vector6d::Zero();
  Matrix6d by_pose = Matrix6d::Zero();
  /// The part of -by_pose that has no negative eigenvalue: all but that of the force's lever.
  Matrix6d stiffness = Matrix6d::Zero();
};
/// Of the node whose position is `point`.
[[nodiscard]] SpringPull spring_pull(const PointSpring& spring, const Eigen::Vector3d& point);

/// A spring at a rod in motion, which can be set anew from step to step.
class RodSpring final : public RodSurroundings {
 public:
  /// At the node that is nearest to the place: one of the chain of RodDynamics.
  RodSpring(const RodChain& chain, const RodPlace& place);

  /// From now on it pulls so, whatever place the spring says; none: it does not pull. std::invalid_argument:
  /// the spring's problem.
  void set(const std::optional<PointSpring>& spring);

  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;

 private:
  std::size_t node_ = 0;
  std::optional<PointSpring> spring_;
};

}  // namespace flexura
