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

/// Returns the error of a spring as text: a number that is not finite or out of bounds; "" if the spring is
/// valid.
[[nodiscard]] std::string spring_problem(const PointSpring& spring);

/// Returns the conservative force of a spring at a point of the rod, N. Force and point are in the base's
/// frame.
[[nodiscard]] Eigen::Vector3d spring_force(const PointSpring& spring, const Eigen::Vector3d& point);

/// Force of a spring as a wrench about the base's origin, and its derivative with respect to a small
/// displacement twist of the node.
struct SpringPull {
  Vector6d wrench = Vector6d::Zero();
  Matrix6d by_pose = Matrix6d::Zero();
  /// Positive semidefinite part of -by_pose: all terms except the rotation of the lever arm.
  Matrix6d stiffness = Matrix6d::Zero();
};
/// Returns the wrench of a spring at a node with the position `point`.
[[nodiscard]] SpringPull spring_pull(const PointSpring& spring, const Eigen::Vector3d& point);

/// A spring on a moving rod. The spring can change from step to step.
class RodSpring final : public RodSurroundings {
 public:
  /// Attaches the spring to the node of `chain` that is nearest to `place`. `chain`: the chain of
  /// RodDynamics.
  RodSpring(const RodChain& chain, const RodPlace& place);

  /// Sets the spring, whose `section` and `at` are ignored; std::nullopt: no force. Throws
  /// std::invalid_argument for an invalid spring.
  void set(const std::optional<PointSpring>& spring);

  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;

 private:
  std::size_t node_ = 0;
  std::optional<PointSpring> spring_;
};

}  // namespace flexura
