#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

// The paper's planar arm (section 3.1), with the corrections of docs/kinematic-model.md. All angles are rad,
// counter-clockwise positive in the XOY plane; cord and tangent angles are measured from +X_W.
//
// For section n, base first: arching_n (eq. 1) is half its bend, the angle from the tangent at its start to
// its cord; cord_angle_n is the cord's angle from +X.
namespace flexura {

/// Returns cord angles by eq. 5: cord_n = base_tangent (alpha_Ox^0, the tangent's angle at the base) + 2
/// (arching_0 + ... + arching_{n-1}) + arching_n.
[[nodiscard]] std::vector<double> cord_angles_from_archings(std::span<const double> archings,
                                                            double base_tangent);

/// Returns archings by the inverse of eq. 5. Angles are never wrapped: 2 pi more is another arm. For exact
/// angles only: an error in one cord alternates through all later archings with gain 2.
[[nodiscard]] std::vector<double> archings_from_cord_angles(std::span<const double> cord_angles,
                                                            double base_tangent);

/// Returns the bend (-2 b, 0) of a planar section with arching b, rad.
[[nodiscard]] Eigen::Vector2d bend_from_arching(double arching);

/// Returns the arching of a planar section, rad: -bend_x / 2. Throws std::invalid_argument if the bend leaves
/// the plane (bend_y not 0).
[[nodiscard]] double arching_from_bend(const Eigen::Vector2d& bend);

/// Returns each section's base point and, last, the end effector E, m, by eqs. 7 and 8 (9 and 10 unrolled).
/// Throws std::invalid_argument unless `lengths` and `archings` have one element per section.
[[nodiscard]] std::vector<Eigen::Vector2d> base_points(std::span<const double> lengths,
                                                       std::span<const double> archings,
                                                       const Eigen::Vector2d& base_point,
                                                       double base_tangent);

}  // namespace flexura
