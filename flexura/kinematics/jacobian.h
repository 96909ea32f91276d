#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/kinematics/spatial.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// 6 x 3n for an arm of n sections. Columns 3i + 0, 1, 2 are the twist of a point P of the backbone, relative
/// to and expressed in W. They are per unit rate of section i's bend_x, bend_y (rad/s) and stretch (1/s).
/// Rows: [v; w], the velocity of P itself (m/s) and the angular velocity of the backbone's frame there
/// (rad/s).
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Analytic Jacobians of one state of an arm, for any number of points, without allocation after the
/// constructor. P is a material point, so stretch moves it; columns of sections after P's are zero. Smooth
/// for straight sections.
class BackboneJacobian {
 public:
  /// Twists [v; w] by bend_x, bend_y and stretch.
  using Columns = Eigen::Matrix<double, 6, 3>;
  /// A section in a state.
  struct Part {
    Pose X_WS;               ///< Pose of its base.
    Eigen::Vector2d bend;    ///< rad.
    double rest_length = 0;  ///< Not stretched, m.
    double stretch = 1;      ///< Factor on rest_length.
    Columns V_end;           ///< Twist of its end per rate of its variables, in W.
    Eigen::Vector3d p_end;   ///< Position of its end, in W, m.
  };

  BackboneJacobian() = default;
  /// Throws std::invalid_argument if `state` does not fit the arm.
  BackboneJacobian(const Arm& arm, const ArmState& state) { set(arm, state); }

  /// Sets another state; allocates nothing for the same number of sections. Throws std::invalid_argument if
  /// `state` does not fit the arm.
  void set(const Arm& arm, const ArmState& state);
  /// Returns the sections, base first.
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

  /// Returns X_WS at `point`. Does not check that the arm has its section.
  [[nodiscard]] Pose pose(const MaterialPoint& point) const;
  // NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// Writes the Jacobian of `point` into J, 6 x 3n. Throws std::invalid_argument if J has another size or the
  /// arm lacks the section.
  void at(const MaterialPoint& point, Eigen::Ref<Jacobian> J) const;
  /// Writes the Jacobian of the tip into J.
  void tip(Eigen::Ref<Jacobian> J) const { at({parts_.size() - 1, 1.0}, J); }
  // NOLINTEND(performance-unnecessary-value-param)

 private:
  std::vector<Part> parts_;
};

/// Returns the tip's Jacobian, 6 x 3n. Throws std::invalid_argument if `state` does not fit the arm.
[[nodiscard]] Jacobian tip_jacobian(const Arm& arm, const ArmState& state);

}  // namespace flexura
