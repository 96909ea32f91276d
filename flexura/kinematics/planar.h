#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

// The paper's planar arm (section 3.1), with the corrections of docs/kinematic-model.md. All angles are in
// rad, positive counter-clockwise in the XOY plane. Chord and tangent angles are measured from +X_W.
//
// arching_n (eq. 1) of section n, base first, is half the bend: the angle from the tangent at the section's
// start to its chord. cord_angle_n is the chord's angle from +X.
namespace flexura {

/// Returns chord angles by eq. 5: cord_n = base_tangent + 2 (arching_0 + ... + arching_{n-1}) + arching_n.
/// The tangent's angle at the base, base_tangent, is the paper's alpha_Ox^0.
[[nodiscard]] std::vector<double> cord_angles_from_archings(std::span<const double> archings,
                                                            double base_tangent);

/// Returns archings by the inverse of eq. 5. Angles are not wrapped, because a chord angle larger by 2 pi
/// describes another shape. The angles must be exact: an error in one chord angle changes all later archings
/// by twice the error, with alternating signs.
[[nodiscard]] std::vector<double> archings_from_cord_angles(std::span<const double> cord_angles,
                                                            double base_tangent);

/// Returns the bend (-2 b, 0) of a planar section with arching b, rad.
[[nodiscard]] Eigen::Vector2d bend_from_arching(double arching);

/// Returns the arching of a planar section, rad: -bend_x / 2. Throws std::invalid_argument if the bend leaves
/// the plane (bend_y not 0).
[[nodiscard]] double arching_from_bend(const Eigen::Vector2d& bend);

/// Returns the base point of each section and, last, the end effector E, m. Uses eqs. 7 and 8, which are
/// equivalent to eqs. 9 and 10. Throws std::invalid_argument unless `lengths` and `archings` have one element
/// per section.
[[nodiscard]] std::vector<Eigen::Vector2d> base_points(std::span<const double> lengths,
                                                       std::span<const double> archings,
                                                       const Eigen::Vector2d& base_point,
                                                       double base_tangent);

}  // namespace flexura
