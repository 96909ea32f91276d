#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

struct ArmConfig;

/// Mechanical model of an arm. `kinematic`: the shape follows the commands. `statics`: sections are elastic
/// rods in equilibrium with their tendons, gravity and loads. `dynamics`: elastic rods with inertia, which
/// move under the same forces.
enum class ArmMechanics { kinematic, statics, dynamics };

/// Route of a tendon from the arm's base to the end of one section, `[[arm.tendon]]`. Let s be the arc length
/// from the base of the arm at rest, m. In the cross-section at s, the tendon's offset from the backbone is
/// (x(s), y(s)) + r(s) (cos a(s), sin a(s)), m. The radius r and the angle a change linearly from the arm's
/// base to the tendon's end.
struct TendonRouteConfig {
  std::int64_t section = 1;  ///< Section at the end of which the tendon ends, counted from 1 at the base.
  double radius = 0;         ///< Distance from the backbone at the base, m.
  double angle = 0;          ///< Angle around the backbone at the base, from x towards y, rad.
  /// Distance from the backbone at the tendon's end, m; default: `radius`.
  std::optional<double> end_radius = {};
  /// Number of turns around the backbone from the arm's base to the tendon's end, from x towards y.
  double turns = 0;
  /// Coefficients of the polynomials x(s) and y(s), by increasing power of s from 0: m, m/m, ...
  std::vector<double> x = {}, y = {};
  double compliance = 0;                 ///< Elongation of the tendon per tension, m/N.
  double friction = 0;                   ///< Coulomb friction coefficient along the route.
  std::optional<double> breaks_at = {};  ///< Time at which the tendon breaks, s; default: never.

  /// Returns the tendon's offset from the backbone, m, at arc length `s`. The tendon ends at arc length
  /// `end`. Arc lengths are in m from the base.
  [[nodiscard]] Eigen::Vector2d offset(double s, double end) const;
};

/// A force and a moment at the end of a section, `[[arm.load]]`.
struct LoadConfig {
  std::int64_t section = 1;  ///< Section with the loaded end, counted from 1 at the base.
  std::array<double, 3> force = {
      0, 0, 0};  ///< Force in the world's frame, N; if `following`, in the frame of the section's end.
  std::array<double, 3> moment = {0, 0, 0};  ///< Moment in the frame of `force`, N m.
  bool following = false;                    ///< Whether force and moment rotate with the section's end.
};

const std::vector<std::string>& names_of(const ArmMechanics*);
const Table<TendonRouteConfig>& fields_of(const TendonRouteConfig*);
const Table<LoadConfig>& fields_of(const LoadConfig*);

/// Reports errors of the tendons, loads and materials of `arm`. `reader` must be at the arm's table. Errors
/// are a wrong section number and a tendon that leaves the tube. Further errors are a section of a static or
/// dynamic arm without a material, and a section of a dynamic arm without a mass.
void check_mechanics(const ArmConfig& arm, Reader& reader);

}  // namespace flexura
