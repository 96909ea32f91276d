#pragma once

#include <Eigen/Core>
#include <string>

#include "flexura/mechanics/contact_shape.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// Parameters of normal force and friction of a contact (docs/mechanics.md, "Contact").
struct ContactLaw {
  double stiffness = 1e5;    ///< Normal stiffness, N per metre of depth and per metre of rod; > 0.
  double damping = 5;        ///< Relative increase of the force per m/s of approach speed, s/m; >= 0.
  double friction = 0.3;     ///< Coulomb's friction coefficient; >= 0.
  double slip_speed = 1e-3;  ///< Slip speed below which a contact sticks (creeps), m/s; > 0.
  double transition = 1e-5;  ///< Depth within which the stiffness rises smoothly from 0, m; > 0.
};

/// Returns what is wrong with the law, in words; "" if it is valid.
[[nodiscard]] std::string law_problem(const ContactLaw& law);

/// Normal force per metre of rod, N/m, never below 0, and its derivatives.
struct ContactPress {
  double force = 0, by_depth = 0, by_rate = 0;
};
/// Returns the normal force of Hunt and Crossley (1975), linear in the depth: k depth (1 + damping rate).
/// This force is smooth at first contact, and where it would become attractive. `rate`: rate of the depth,
/// m/s.
[[nodiscard]] ContactPress press(const ContactLaw& law, double depth, double rate);

/// Contact of a body with a ball, whose centre is a point of the rod.
struct Touch {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
  NearestPoint nearest;               ///< Nearest point of the body to `center`.
  Vector6d twist = Vector6d::Zero();  ///< Twist of the point relative to the body, about the origin.
  double run = 0;                     ///< Length of rod that the point represents, m.
};

/// Force and state of a contact between ball and body.
struct TouchForce {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Deepest point of the ball's surface in the body, m.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Force on the ball, N.
  /// Tangential velocity of the ball's surface relative to the body's, m/s.
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();
  double depth = 0;         ///< m
  double normal_force = 0;  ///< N

  /// Wrench on the ball about the origin.
  [[nodiscard]] Vector6d wrench() const { return (Vector6d() << force, point.cross(force)).finished(); }
};
/// Returns normal force and friction. Friction is -friction normal_force slip / sqrt(|slip|^2 +
/// slip_speed^2).
[[nodiscard]] TouchForce touch_force(const ContactLaw& law, const Touch& touch);
/// Derivatives of a contact with respect to several variables, one column per variable.
struct TouchChange {
  static constexpr int most = 30;
  using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, most>;
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, most>;

  Row depth;      ///< Derivative of the depth.
  Rows normal;    ///< Derivative of the normal.
  Rows velocity;  ///< Derivative of the ball's velocity relative to the body at the touching point.
};
/// Returns the derivative of the contact force with respect to the variables of `change`.
[[nodiscard]] TouchChange::Rows force_change(const ContactLaw& law, const Touch& touch, const TouchForce& at,
                                             const TouchChange& change);
/// Positive semidefinite, symmetric part of the derivative of a contact force with respect to the motion of
/// the contact point. A TouchHold consists of spring and damper along the normal, and friction across.
struct TouchHold {
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero(), damping = Eigen::Matrix3d::Zero();
};
/// Returns the stiffness and damping (TouchHold) of a contact with the force `at`.
[[nodiscard]] TouchHold hold_of(const ContactLaw& law, const Touch& touch, const TouchForce& at);

/// Returns the force on the ball, for a body at rest. Sets `pull` to the wrench of this force and its
/// derivatives with respect to the point's motion.
TouchForce touch_force(const ContactLaw& law, const Touch& touch, NodePull& pull);

}  // namespace flexura
