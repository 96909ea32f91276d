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

/// Mechanical model of an arm. With `kinematic` the shape follows the commands. With `statics` sections are
/// elastic rods, in equilibrium with their tendons, gravity and loads. With `dynamics` these rods move with
/// their inertia.
enum class ArmMechanics { kinematic, statics, dynamics };

/// Route of a tendon in the arm's cross-sections, from the arm's base to the end of one section,
/// `[[arm.tendon]]`. At s m of arc length from the base, at rest, its offset from the backbone is (x(s),
/// y(s)) + r(s) (cos a(s), sin a(s)). Radius r and angle a change linearly from base to end.
struct TendonRouteConfig {
  std::int64_t section = 1;               ///< Section at whose end it ends, counted from 1 at the base.
  double radius = 0;                      ///< Distance from the backbone at the base, m.
  double angle = 0;                       ///< Around the backbone there, from x towards y, rad.
  std::optional<double> end_radius = {};  ///< Distance at its end, m; default: as at the base.
  double turns = 0;                       ///< Turns around the backbone from base to end, from x towards y.
  std::vector<double> x = {}, y = {};     ///< Coefficients of powers of s: m, m/m, ...
  double compliance = 0;                  ///< Elongation per tension, m/N.
  double friction = 0;                    ///< Coulomb friction coefficient along its route.
  std::optional<double> breaks_at = {};   ///< Time at which it breaks, s; default: never.

  /// Returns (x, y) at arc length `s` of a tendon that ends at `end`, m.
  [[nodiscard]] Eigen::Vector2d offset(double s, double end) const;
};

/// A force and a moment at the end of a section, `[[arm.load]]`.
struct LoadConfig {
  std::int64_t section = 1;                  ///< Counted from 1 at the base.
  std::array<double, 3> force = {0, 0, 0};   ///< N, in the world's frame; if following, in that of the end.
  std::array<double, 3> moment = {0, 0, 0};  ///< N m, in the same frame as the force.
  bool following = false;                    ///< The load turns with the section's end.
};

const std::vector<std::string>& names_of(const ArmMechanics*);
const Table<TendonRouteConfig>& fields_of(const TendonRouteConfig*);
const Table<LoadConfig>& fields_of(const LoadConfig*);

/// Reports errors of the tendons, loads and materials of the arm at the current place of `reader`. Errors are
/// an end at a missing section, a tendon outside the tube, a rod's section without a material, and a moving
/// one without a mass.
void check_mechanics(const ArmConfig& arm, Reader& reader);

}  // namespace flexura
