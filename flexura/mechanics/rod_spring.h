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

/// Returns what is wrong with a spring, in words: numbers that are not finite or out of bounds. "" if it is
/// valid.
[[nodiscard]] std::string spring_problem(const PointSpring& spring);

/// Returns the force of a spring at a point of the rod, N; both in the base's frame. It is conservative.
[[nodiscard]] Eigen::Vector3d spring_force(const PointSpring& spring, const Eigen::Vector3d& point);

/// The force as a wrench about the base's origin, and its derivative by a small twist of the node at that
/// point.
struct SpringPull {
  Vector6d wrench = Vector6d::Zero();
  Matrix6d by_pose = Matrix6d::Zero();
  /// Part of -by_pose without negative eigenvalues: all but the lever's rotation.
  Matrix6d stiffness = Matrix6d::Zero();
};
/// Returns the wrench at the node whose position is `point`.
[[nodiscard]] SpringPull spring_pull(const PointSpring& spring, const Eigen::Vector3d& point);

/// A spring on a moving rod, which can change from step to step.
class RodSpring final : public RodSurroundings {
 public:
  /// Attaches it to the node nearest to the place, of the chain of RodDynamics.
  RodSpring(const RodChain& chain, const RodPlace& place);

  /// Sets the spring, ignoring the place in it; std::nullopt: no force. Throws std::invalid_argument for an
  /// invalid spring.
  void set(const std::optional<PointSpring>& spring);

  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;

 private:
  std::size_t node_ = 0;
  std::optional<PointSpring> spring_;
};

}  // namespace flexura
