#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// Drag of a fluid on a rod (docs/mechanics.md, "Drag"). The velocity of the rod relative to the fluid has a
/// part u across the rod and a part w along it, m/s. The drag per metre of rod, N/m, is opposite to these
/// velocities:
///
///     across: density diameter across_coefficient |u| u / 2 + linear_across u
///     along:  pi density diameter along_coefficient |w| w / 2 + linear_along w
struct RodDragConfig {
  /// Density of the fluid, kg/m^3. This number and the following numbers, up to `linear_along`, are >= 0.
  double density = 1000;
  double across_coefficient = 1;    ///< Coefficient of form drag; about 1 for a cylinder.
  double along_coefficient = 0.01;  ///< Coefficient of skin friction.
  double linear_across = 0;         ///< Linear drag across the rod, N s/m per metre of rod.
  double linear_along = 0;
  Eigen::Vector3d flow = Eigen::Vector3d::Zero();  ///< Velocity of the fluid in the base's frame, m/s.
  /// Radii of the tube around each section, at the section's base and end, m; empty: the radii of the elastic
  /// rod.
  std::vector<std::array<double, 2>> radii = {};
};

/// Drag on a moving rod. Added mass and lift are not modelled.
class RodDrag final : public RodSurroundings {
 public:
  /// The drag acts at the nodes of `chain`, the chain of RodDynamics. Throws std::invalid_argument for a
  /// negative coefficient, a number that is not finite, or invalid radii.
  RodDrag(const RodChain& chain, const RodDragConfig& config);

  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;
  /// Returns the power of drag on the rod, W; never positive in a fluid at rest.
  [[nodiscard]] double power(std::span<const NodeMotion> nodes, std::span<const double> run) const;

 private:
  struct Node {
    double across, along;  // N s^2/m^2 per metre.
  };
  // Force per metre, and its derivatives with respect to velocity and tangent.
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
