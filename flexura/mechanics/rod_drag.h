#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// A fluid around a rod (docs/mechanics.md, "Drag"): for each metre, with the velocity u against it, across
/// the rod density diameter across_coefficient |u| u / 2, along it pi times that of its own coefficient
/// (friction of the skin), and linear drag.
struct RodDragConfig {
  double density = 1000;          ///< Of the fluid, kg/m^3; >= 0, as all of these.
  double across_coefficient = 1;  ///< Of the form: a cylinder's is about 1.
  double along_coefficient = 0.01;
  double linear_across = 0;  ///< N s/m for each metre.
  double linear_along = 0;
  Eigen::Vector3d flow = Eigen::Vector3d::Zero();  ///< Of the fluid, in the base's frame, m/s.
  /// Of the tube around each section, at the section's base and end, m; none: of the elastic rod itself.
  std::vector<std::array<double, 2>> radii = {};
};

/// What a fluid does to a rod that moves in it. The fluid's own inertia and what the rod displaces (lift) are
/// not in it.
class RodDrag final : public RodSurroundings {
 public:
  /// Of the nodes of the chain of RodDynamics. std::invalid_argument: a coefficient below 0, a number that is
  /// not finite, radii that cannot be.
  RodDrag(const RodChain& chain, const RodDragConfig& config);

  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;
  /// What drag does to the rod in such a motion, W; in a fluid at rest never above 0.
  [[nodiscard]] double power(std::span<const NodeMotion> nodes, std::span<const double> run) const;

 private:
  struct Node {
    double across, along;  // N s^2/m^2 for each metre.
  };
  // The force for each metre, and that by the velocity and by the tangent.
  struct Force {
    Eigen::Vector3d force;
    Eigen::Matrix3d by_velocity, by_tangent;
  };
  [[nodiscard]] Force force_at(const Node& node, const Eigen::Vector3d& velocity,
                               const Eigen::Vector3d& tangent) const;

  RodDragConfig config_;
  std::vector<Node> nodes_;
};

}  // namespace flexura
