#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/math/se3.h"

// What a rod is: sections, tendons along them, and what pulls at it (docs/mechanics.md).
//
// A strain is a twist a metre of rest length, linear first: [v; u] with X' = X hat([v; u]) for the frame X of
// a cross-section, whose z is the tangent at rest. v is (shear x, shear y, stretch), (0, 0, 1) at rest; u the
// curvature about x and y and the twist about z, 1/m.
namespace flexura {

/// How many Legendre polynomials of arc length each strain of a section is a sum of: 1 is constant, 2 linear.
/// 0: it stays as it is at rest, whatever pulls at it.
struct StrainModes {
  int shear = 1;
  int stretch = 1;
  int bend = 5;  ///< Each of the two directions.
  int twist = 4;

  /// Moves in the plane of x and z alone: bends about y, without twist and shear along y.
  bool planar = false;

  /// Of the six strains, in their order.
  [[nodiscard]] std::array<int, 6> counts() const {
    if (planar) return {shear, 0, stretch, 0, bend, 0};
    return {shear, shear, stretch, bend, bend, twist};
  }
};

/// A body that is fixed on a section's backbone: a guide disk, a camera, a weight.
struct PointMass {
  double at = 1;                                     ///< Where, of the section's length; in [0, 1].
  double mass = 0;                                   ///< kg
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< Its centre of mass in the cross-section's frame, m.
};

/// One section of a rod: what it is made of, and how finely its strains are resolved.
struct RodSection {
  double length = 1;                            ///< At rest, m; > 0.
  std::array<double, 2> radius = {1e-3, 1e-3};  ///< Of the elastic rod at the section's base and end, m; > 0.
  std::array<double, 2> inner_radius = {0, 0};  ///< Of its bore, m; below `radius`.
  double youngs_modulus = 0;                    ///< E, Pa; > 0, as the next, unless `stiffness` is given.
  double shear_modulus = 0;                     ///< G, Pa
  double density = 0;                           ///< kg/m^3
  /// Given directly, of the six strains: GA twice and EA, N, EI about x and y and GJ, N m^2; each > 0.
  std::optional<Vector6d> stiffness = {};
  std::optional<double> mass_per_length = {};  ///< Given directly, kg/m.
  /// Viscosity (W. Voigt): of the time in which a strain that nothing holds falls to 1/e against the
  /// stiffness; the damping is the stiffness times it, s. For dynamics alone, as the next.
  double damping_time = 0;
  /// Given directly, of the six strains, N s and N m^2 s; each >= 0.
  std::optional<Vector6d> damping = {};
  /// Curvature about x and y and twist of the rod when nothing pulls, 1/m: the coefficients of powers of
  /// t = s/length. None: straight.
  std::vector<Eigen::Vector3d> rest_curvature = {};
  std::vector<PointMass> masses = {};
  /// Tendons run straight between guide disks that cut the section into so many equal pieces; 0: in a
  /// continuous channel.
  int disks = 0;
  StrainModes modes = {};
  /// Of the quadrature and of the chain of poses: Gauss-Lobatto nodes, the section's ends among them. 0: as
  /// many as the modes need.
  int nodes = 0;

  /// The diagonal of the stiffness at t in [0, 1] of the length, N and N m^2.
  [[nodiscard]] Vector6d stiffness_at(double t) const;
  /// kg/m there.
  [[nodiscard]] double mass_per_length_at(double t) const;
  /// The diagonal of the damping there, N s and N m^2 s.
  [[nodiscard]] Vector6d damping_at(double t) const;
  /// The moments of inertia about x, y and z of a slice there, for each metre, kg m: those of the round
  /// cross-section, of which `mass_per_length_at` is the mass.
  [[nodiscard]] Eigen::Vector3d slice_inertia_at(double t) const;
  /// The strain at rest there.
  [[nodiscard]] Vector6d rest_strain_at(double t) const;
  /// And that by arc length, 1/m and 1/m^2.
  [[nodiscard]] Vector6d rest_strain_slope_at(double t) const;
};

/// Where a tendon runs: from the rod's base through all sections up to the end of one, where it is fastened.
/// At arc length s m from the base, at rest, it passes the cross-section at
/// (x(s), y(s)) + r(s) (cos a(s), sin a(s)), with r = radius + radius_slope s and a = angle + angle_slope s.
struct TendonRoute {
  std::size_t section = 0;             ///< At whose end it is fastened, 0 at the base.
  double radius = 0;                   ///< m
  double radius_slope = 0;             ///< Converging (< 0) or spreading, m/m.
  double angle = 0;                    ///< From x towards y, rad.
  double angle_slope = 0;              ///< Helical, rad/m.
  std::vector<double> x = {}, y = {};  ///< Coefficients of powers of s: m, m/m, ...
  double compliance = 0;  ///< How much longer it is for each newton, m/N; >= 0. For displacements only.
  /// Coulomb friction while it is pulled in: of the tension, exp(-friction angle) is left where the tendon
  /// has turned by an angle since its base (L. Euler, J. Eytelwein); >= 0.
  double friction = 0;

  /// Its offset in the cross-section, and the first two derivatives of that by s; z is 0.
  struct Offset {
    Eigen::Vector3d value, slope, second;
  };
  /// At arc length s m from the base, at rest.
  [[nodiscard]] Offset at(double s) const;
};

/// A force and a moment at the end of a section.
struct EndLoad {
  std::size_t section = 0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N, in the base's frame; following: in the end's.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< N m, likewise.
  bool following = false;                            ///< Turns with the section's end.
};

/// A spring that draws a point of a rod's middle line to a place, like a hand that holds it by a rubber band:
/// with d from the point to the place its force is k d / sqrt(1 + (k |d| / most)^2), and so never above
/// `most`; a constant force comes on top of that.
struct PointSpring {
  std::size_t section = 0;
  double at = 1;                                    ///< Where, of the section's length; in [0, 1].
  Eigen::Vector3d to = Eigen::Vector3d::Zero();     ///< The place, in the base's frame, m.
  double stiffness = 0;                             ///< k, N/m; >= 0. 0: the constant force alone.
  double most = 1;                                  ///< N; > 0
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< The constant force, in the base's frame, N.
};

/// What pulls at a rod beside its tendons, in the frame of its base.
struct RodLoads {
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s^2
  Eigen::Vector3d per_length =
      Eigen::Vector3d::Zero();  ///< A force along all of it, N for each metre at rest.
  std::vector<EndLoad> ends = {};
  /// Each at a place that is a node of the rod. For arms at rest; of a rod in motion they are surroundings
  /// (RodSpring).
  std::vector<PointSpring> springs = {};
};

/// A rod clamped at its base, in whose frame everything is: it leaves the origin along z.
struct Rod {
  std::vector<RodSection> sections;  ///< Base first; at least one.
  std::vector<TendonRoute> tendons;

  /// m, at rest.
  [[nodiscard]] double length() const;
};

/// What is wrong with a rod, in words: lengths, radii and stiffnesses that are not positive, a tendon that
/// ends nowhere, counts out of bounds, numbers that are not finite. Empty: nothing.
[[nodiscard]] std::vector<std::string> rod_problems(const Rod& rod);

}  // namespace flexura
