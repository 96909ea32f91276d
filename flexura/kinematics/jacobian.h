#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/kinematics/spatial.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Jacobian of a backbone point P, 6 x 3n for an arm of n sections. Columns 3i, 3i + 1 and 3i + 2 are twists
/// [v; w] of P relative to W, expressed in W. These twists are per unit rate of bend_x, bend_y (rad/s) and
/// stretch (1/s) of section i. The first three rows are the velocity v of P, m/s. The last three rows are the
/// angular velocity w of the backbone's frame at P, rad/s.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Analytic Jacobians of any number of backbone points in one state of an arm. Only the constructor allocates
/// memory. P is a material point, which moves with stretch. Columns of sections beyond P's section are zero.
/// The Jacobians are smooth for straight sections.
class BackboneJacobian {
 public:
  /// Twists [v; w] per unit rate of bend_x, bend_y and stretch.
  using Columns = Eigen::Matrix<double, 6, 3>;
  /// A section in a state of the arm.
  struct Part {
    Pose X_WS;               ///< Pose of the section's base frame.
    Eigen::Vector2d bend;    ///< Bend vector, rad.
    double rest_length = 0;  ///< Length at stretch 1, m.
    double stretch = 1;      ///< Factor on rest_length.
    Columns V_end;           ///< Twists of the section's end per unit rate of its variables, in W.
    Eigen::Vector3d p_end;   ///< Position of the section's end, in W, m.
  };

  BackboneJacobian() = default;
  /// Throws std::invalid_argument unless `state` has one bend and one stretch per section.
  BackboneJacobian(const Arm& arm, const ArmState& state) { set(arm, state); }

  /// Sets another arm and state. Allocates no memory if the number of sections does not change. Throws
  /// std::invalid_argument unless `state` has one bend and one stretch per section.
  void set(const Arm& arm, const ArmState& state);
  /// Returns the sections, base first.
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

  /// Returns the backbone's frame X_WS at `point`. Does not check whether the arm has the point's section.
  [[nodiscard]] Pose pose(const MaterialPoint& point) const;
  // NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// Writes the Jacobian of `point` into J, 6 x 3n. Throws std::invalid_argument if J has another size or the
  /// arm does not have the point's section.
  void at(const MaterialPoint& point, Eigen::Ref<Jacobian> J) const;
  /// Writes the Jacobian of the tip into J.
  void tip(Eigen::Ref<Jacobian> J) const { at({parts_.size() - 1, 1.0}, J); }
  // NOLINTEND(performance-unnecessary-value-param)

 private:
  std::vector<Part> parts_;
};

/// Returns the tip's Jacobian, 6 x 3n. Throws std::invalid_argument unless `state` has one bend and one
/// stretch per section.
[[nodiscard]] Jacobian tip_jacobian(const Arm& arm, const ArmState& state);

}  // namespace flexura
