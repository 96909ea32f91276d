#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/math/se3.h"

// Definition of a rod: sections, tendons and loads (docs/mechanics.md).
//
// A strain is a twist per metre of undeformed length, linear part first: [v; u] with X' = X hat([v; u]) for
// the frame X of a cross-section, whose z is the tangent of the undeformed rod. v is (shear x, shear y,
// stretch), undeformed (0, 0, 1); u is the curvature about x and y and the twist about z, 1/m.
namespace flexura {

/// Number of Legendre polynomials of arc length for each strain of a section: 1 is constant, 2 linear. With 0
/// the strain keeps its undeformed value under any load.
struct StrainModes {
  int shear = 1;
  int stretch = 1;
  int bend = 5;  ///< Number of polynomials for each of the two bending directions.
  int twist = 4;
  /// Whether, in a section with guide disks, each piece between two disks has separate modes (rod_parts.h).
  /// If false, modes extend over the whole section, which is inaccurate for strongly bent pieces.
  bool by_piece = true;

  /// The rod moves only in its xz plane: the rod bends about y, without twist or shear along y.
  bool planar = false;

  /// Returns the numbers of the six strains, in their order.
  [[nodiscard]] std::array<int, 6> counts() const {
    if (planar) return {shear, 0, stretch, 0, bend, 0};
    return {shear, shear, stretch, bend, bend, twist};
  }
};

/// A body fixed on a section's backbone: a guide disk, a camera, a weight.
struct PointMass {
  double at = 1;                                     ///< Position as part of the section's length, in [0, 1].
  double mass = 0;                                   ///< kg
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< Centre of mass in the cross-section's frame, m.
};

/// One section of a rod: material, geometry and resolution of its strains.
struct RodSection {
  double length = 1;  ///< Undeformed length, m; > 0.
  /// Radius of the elastic rod at the section's base and end, m; > 0.
  std::array<double, 2> radius = {1e-3, 1e-3};
  std::array<double, 2> inner_radius = {0, 0};  ///< Radius of the bore at base and end, m; below `radius`.
  double youngs_modulus = 0;                    ///< E, Pa; > 0 unless `stiffness` is given.
  double shear_modulus = 0;                     ///< G, Pa; > 0 unless `stiffness` is given.
  double density = 0;                           ///< kg/m^3
  /// Stiffness of the six strains, given directly: GA (x), GA (y), EA, N; EI (x), EI (y), GJ, N m^2; each >
  /// 0.
  std::optional<Vector6d> stiffness = {};
  std::optional<double> mass_per_length = {};  ///< Mass per length, given directly, kg/m.
  /// Viscosity (Kelvin-Voigt) as a time constant, s. The damping is the stiffness times this time. A free
  /// strain without inertia decays to 1/e in this time. Used in dynamics only, as is `damping`.
  double damping_time = 0;
  /// Damping of the six strains, given directly, N s and N m^2 s; each >= 0.
  std::optional<Vector6d> damping = {};
  /// Curvature about x and y and twist of the undeformed rod, 1/m: coefficients of powers of t = s/length.
  /// Empty: straight.
  std::vector<Eigen::Vector3d> rest_curvature = {};
  std::vector<PointMass> masses = {};
  /// Tendons run straight between guide disks that divide the section into this many equal pieces. 0: tendons
  /// run in a continuous channel.
  int disks = 0;
  StrainModes modes = {};
  /// Number of Gauss-Lobatto nodes for the quadrature and for the poses, including both ends. 0: computed
  /// from the number of modes.
  int nodes = 0;

  /// Returns the diagonal of the stiffness at t in [0, 1] of the length, N and N m^2.
  [[nodiscard]] Vector6d stiffness_at(double t) const;
  /// Returns the mass per length at t, kg/m.
  [[nodiscard]] double mass_per_length_at(double t) const;
  /// Returns the diagonal of the damping at t, N s and N m^2 s.
  [[nodiscard]] Vector6d damping_at(double t) const;
  /// Returns the moments of inertia about x, y and z of a slice at t, per metre, kg m. The slice is a round
  /// cross-section with the mass `mass_per_length_at`.
  [[nodiscard]] Eigen::Vector3d slice_inertia_at(double t) const;
  /// Returns the undeformed strain at t.
  [[nodiscard]] Vector6d rest_strain_at(double t) const;
  /// Returns the derivative of the undeformed strain with respect to arc length at t, 1/m and 1/m^2.
  [[nodiscard]] Vector6d rest_strain_slope_at(double t) const;
};

/// Path of a tendon from the rod's base through all sections to the end of one section, where the tendon is
/// fastened. At undeformed arc length s m from the base, the tendon passes the cross-section at (x(s), y(s))
/// + r(s) (cos a(s), sin a(s)). Here r = radius + radius_slope s and a = angle + angle_slope s.
struct TendonRoute {
  std::size_t section = 0;             ///< Section at whose end the tendon is fastened, 0 at the base.
  double radius = 0;                   ///< m
  double radius_slope = 0;             ///< Change of the radius per arc length, m/m; < 0: converging.
  double angle = 0;                    ///< Angle at the base, from x towards y, rad.
  double angle_slope = 0;              ///< Change of the angle per arc length (helix), rad/m.
  std::vector<double> x = {}, y = {};  ///< Coefficients of powers of s: m, m/m, ...
  double compliance = 0;               ///< Extension per newton, m/N; >= 0. Used with displacements only.
  /// Coulomb friction coefficient; >= 0. While the tendon is pulled in, its tension after a wrap angle from
  /// the base is exp(-friction * angle) times the tension at the base (Euler, Eytelwein).
  double friction = 0;

  /// Offset in the cross-section and its first two derivatives with respect to s; z is 0.
  struct Offset {
    Eigen::Vector3d value, slope, second;
  };
  /// Returns the offset at undeformed arc length s m from the base.
  [[nodiscard]] Offset at(double s) const;
};

/// A force and a moment at the end of a section.
struct EndLoad {
  std::size_t section = 0;
  /// N, in the base's frame; if `following`, in the frame of the section's end.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< Moment, N m, in the same frame as the force.
  /// Whether force and moment turn with the section's end.
  bool following = false;
};

/// A spring that pulls a point of a rod's centerline to a place. The spring force is k d / sqrt(1 + (k |d| /
/// most)^2), with the vector d from the point to the place. It never exceeds `most`. A constant force is
/// added to this spring force.
struct PointSpring {
  std::size_t section = 0;
  double at = 1;                                    ///< Position as part of the section's length, in [0, 1].
  Eigen::Vector3d to = Eigen::Vector3d::Zero();     ///< Target place, in the base's frame, m.
  double stiffness = 0;                             ///< k, N/m; >= 0. 0: constant force only.
  double most = 1;                                  ///< Largest spring force, N; > 0.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Constant force, in the base's frame, N.
};

/// Loads on a rod other than its tendons, in the frame of its base.
struct RodLoads {
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s^2
  Eigen::Vector3d per_length =
      Eigen::Vector3d::Zero();  ///< Force along the whole rod, N per metre of undeformed length.
  std::vector<EndLoad> ends = {};
  /// Springs, each at a place that is a node of the rod. These springs act in statics only; dynamics uses
  /// RodSpring.
  std::vector<PointSpring> springs = {};
};

/// A rod clamped at its base. All quantities are in the frame of the base. The rod starts at the origin,
/// along z.
struct Rod {
  std::vector<RodSection> sections;  ///< Sections from the base on; at least one.
  std::vector<TendonRoute> tendons;

  /// Returns the undeformed length, m.
  [[nodiscard]] double length() const;
};

/// Returns the errors of a rod as text; empty if the rod is valid. Errors are numbers that are not finite,
/// lengths, radii or stiffnesses that are not positive, tendons of missing sections, and counts out of
/// bounds.
[[nodiscard]] std::vector<std::string> rod_problems(const Rod& rod);

}  // namespace flexura
