#pragma once

#include <Eigen/Core>
#include <string>

#include "flexura/mechanics/contact_shape.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// How hard and how rough a contact is (docs/mechanics.md, "Contact").
struct ContactLaw {
  double stiffness = 1e5;    ///< N for each metre of depth and each metre of the rod; > 0.
  double damping = 5;        ///< The force grows by this part of it for each m/s of approach, s/m; >= 0.
  double friction = 0.3;     ///< Coulomb's coefficient; >= 0.
  double slip_speed = 1e-3;  ///< Slower than this a contact sticks, that is creeps, m/s; > 0.
  double transition = 1e-5;  ///< Within this depth the stiffness sets in, m; > 0.
};

/// What is wrong with it, in words; "": nothing.
[[nodiscard]] std::string law_problem(const ContactLaw& law);

/// The normal force for each metre of the rod, N/m, and its derivatives. Never below 0.
struct ContactPress {
  double force = 0, by_depth = 0, by_rate = 0;
};
/// Of K. H. Hunt and F. R. E. Crossley (1975), linear in the depth: k depth (1 + damping rate), smooth where
/// it sets in and where it would pull. `rate`: of the depth, m/s.
[[nodiscard]] ContactPress press(const ContactLaw& law, double depth, double rate);

/// A ball around a node of a rod that meets a body.
struct Touch {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
  NearestPoint nearest;               ///< Of the body, to the centre.
  Vector6d twist = Vector6d::Zero();  ///< Of the node against the body, about the origin.
  double run = 0;                     ///< Metres of the rod that the node stands for.
};

/// How a ball and a body touch.
struct TouchForce {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Of the ball's surface, the deepest in the body, m.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< On the ball, N.
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();   ///< Of the ball's surface along the body's, m/s.
  double depth = 0;                                 ///< m
  double normal_force = 0;                          ///< N

  /// About the origin.
  [[nodiscard]] Vector6d wrench() const { return (Vector6d() << force, point.cross(force)).finished(); }
};
/// Normal force and friction. That is -friction normal_force slip / sqrt(|slip|^2 + slip_speed^2).
[[nodiscard]] TouchForce touch_force(const ContactLaw& law, const Touch& touch);
/// How a touch changes, by so many numbers as there are columns.
struct TouchChange {
  static constexpr int most = 30;
  using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, most>;
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, most>;

  Row depth;      ///< Of the depth.
  Rows normal;    ///< Of the normal.
  Rows velocity;  ///< Of the velocity of the ball against the body at the touching point.
};
/// How the force changes then.
[[nodiscard]] TouchChange::Rows force_change(const ContactLaw& law, const Touch& touch, const TouchForce& at,
                                             const TouchChange& change);
/// What holds: against the velocity of the touching point, the spring and the damper along the normal, and
/// friction across; symmetric and positive semidefinite.
struct TouchHold {
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero(), damping = Eigen::Matrix3d::Zero();
};
/// Returns what holds at a touch with this force.
[[nodiscard]] TouchHold hold_of(const ContactLaw& law, const Touch& touch, const TouchForce& at);

/// The same, with its derivatives by the node's motion, where the body lies still.
TouchForce touch_force(const ContactLaw& law, const Touch& touch, NodePull& pull);

}  // namespace flexura
