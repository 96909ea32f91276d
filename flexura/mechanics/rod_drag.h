#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// Fluid around a rod (docs/mechanics.md, "Drag"). Per metre, with the relative velocity u: across the rod
/// density diameter across_coefficient |u| u / 2, along it pi times this with along_coefficient (skin
/// friction), and linear drag.
struct RodDragConfig {
  double density = 1000;          ///< Of the fluid, kg/m^3; all these numbers are >= 0.
  double across_coefficient = 1;  ///< Form drag; about 1 for a cylinder.
  double along_coefficient = 0.01;
  double linear_across = 0;  ///< N s/m per metre.
  double linear_along = 0;
  Eigen::Vector3d flow = Eigen::Vector3d::Zero();  ///< Velocity of the fluid, in the base's frame, m/s.
  /// Radii of the tube around each section, at the section's base and end, m; empty: those of the elastic
  /// rod.
  std::vector<std::array<double, 2>> radii = {};
};

/// Drag on a moving rod. Added mass and lift are not modelled.
class RodDrag final : public RodSurroundings {
 public:
  /// Acts at the nodes of the chain of RodDynamics. Throws std::invalid_argument for a negative coefficient,
  /// a number that is not finite, or invalid radii.
  RodDrag(const RodChain& chain, const RodDragConfig& config);

  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;
  /// Returns the power of drag on the rod, W; never positive in a fluid at rest.
  [[nodiscard]] double power(std::span<const NodeMotion> nodes, std::span<const double> run) const;

 private:
  struct Node {
    double across, along;  // N s^2/m^2 per metre.
  };
  // Force per metre, and its derivatives by velocity and tangent.
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
