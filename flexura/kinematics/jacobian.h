#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/kinematics/spatial.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

/// 6 x 3n for an arm of n sections: column 3i + 0, 1, 2 is the twist of a point P of the backbone, relative
/// to and expressed in W, per unit rate of section i's bend_x, bend_y (rad/s) and stretch (1/s). Rows: [v;
/// w], the velocity of P itself (m/s) and the angular velocity of the backbone's frame there (rad/s).
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The analytic Jacobians of one state of an arm, for as many points as asked for, without allocation after
/// the constructor. P is a point of the arm's material, so that stretch carries it along; columns of sections
/// after P's are zero. Smooth through every straight section.
class BackboneJacobian {
 public:
  /// Twists [v; w] by bend_x, bend_y and stretch.
  using Columns = Eigen::Matrix<double, 6, 3>;
  /// A section as it stands.
  struct Part {
    Pose X_WS;               ///< Its base.
    Eigen::Vector2d bend;    ///< rad.
    double rest_length = 0;  ///< Not stretched, m.
    double stretch = 1;      ///< The factor on rest_length.
    Columns V_end;           ///< Twist of its end at its own rates, in W.
    Eigen::Vector3d p_end;   ///< Its end, in W, m.
  };

  BackboneJacobian() = default;
  /// `state` must fit the arm, else std::invalid_argument.
  BackboneJacobian(const Arm& arm, const ArmState& state) { set(arm, state); }

  /// Another state; without allocation for as many sections as before. std::invalid_argument likewise.
  void set(const Arm& arm, const ArmState& state);
  /// One a section, base first.
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

  /// X_WS at `point`, whose section is one of the arm's: that is not checked.
  [[nodiscard]] Pose pose(const MaterialPoint& point) const;
  // NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// Writes the Jacobian of `point` into J, 6 x 3n. std::invalid_argument: J of another size, a section that
  /// the arm has not.
  void at(const MaterialPoint& point, Eigen::Ref<Jacobian> J) const;
  /// Writes the Jacobian of the tip into J.
  void tip(Eigen::Ref<Jacobian> J) const { at({parts_.size() - 1, 1.0}, J); }
  // NOLINTEND(performance-unnecessary-value-param)

 private:
  std::vector<Part> parts_;
};

/// The tip's Jacobian, 6 x 3n. `state` must fit the arm, else std::invalid_argument.
[[nodiscard]] Jacobian tip_jacobian(const Arm& arm, const ArmState& state);

}  // namespace flexura
