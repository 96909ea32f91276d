#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

// The paper's planar arm (section 3.1), corrected as docs/kinematic-model.md tells. All angles are rad,
// counter-clockwise positive in the XOY plane; cord and tangent angles are measured from +X_W.
//
// For section n, base first: arching_n (eq. 1) is half its bend, the angle from the tangent at its start to
// its cord; cord_angle_n is the cord's angle from +X.
namespace flexura {

/// Eq. 5: cord_n = base_tangent (alpha_Ox^0, the tangent's angle at the base) + 2 (arching_0 + ... +
/// arching_{n-1}) + arching_n.
[[nodiscard]] std::vector<double> cord_angles_from_archings(std::span<const double> archings,
                                                            double base_tangent);

/// Eq. 5 read backwards. Angles are taken as they stand, never wrapped: 2 pi more is another arm.
/// For exact angles only: an error in one cord alternates through all later archings with gain 2.
[[nodiscard]] std::vector<double> archings_from_cord_angles(std::span<const double> cord_angles,
                                                            double base_tangent);

/// The bend (-2 b, 0) of a planar section with arching b, rad.
[[nodiscard]] Eigen::Vector2d bend_from_arching(double arching);

/// The arching of a planar section, rad: -bend_x / 2. std::invalid_argument when the bend leaves the plane
/// (bend_y not 0).
[[nodiscard]] double arching_from_bend(const Eigen::Vector2d& bend);

/// Eqs. 7 and 8 (9 and 10 unrolled): each section's base point and, last, the end effector E, m.
/// `lengths` and `archings` have one entry a section, else std::invalid_argument.
[[nodiscard]] std::vector<Eigen::Vector2d> base_points(std::span<const double> lengths,
                                                       std::span<const double> archings,
                                                       const Eigen::Vector2d& base_point,
                                                       double base_tangent);

}  // namespace flexura
