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

/// How an arm's shape comes about. kinematic: as commands say. statics: its sections are elastic rods, at
/// rest under their tendons, gravity and loads. dynamics: the same rods in motion, with their inertia.
enum class ArmMechanics { kinematic, statics, dynamics };

/// Where a tendon runs in the arm's cross-sections, from its base to the end of one section,
/// `[[arm.tendon]]`: at s m of arc length from the base, at rest, it is off the backbone by (x(s), y(s)) +
/// r(s) (cos a(s), sin a(s)), where r and a change evenly from base to end.
struct TendonRouteConfig {
  std::int64_t section = 1;               ///< The one at whose end it ends, counted from 1 at the base.
  double radius = 0;                      ///< Distance from the backbone at the base, m.
  double angle = 0;                       ///< Around the backbone there, from x towards y, rad.
  std::optional<double> end_radius = {};  ///< At its end, m; none: as at the base.
  double turns = 0;                       ///< Around the backbone from base to end, from x towards y.
  std::vector<double> x = {}, y = {};     ///< Coefficients of powers of s: m, m/m, ...
  double compliance = 0;                  ///< How much longer it is for each newton, m/N.
  double friction = 0;                    ///< Coulomb's, along its way.
  std::optional<double> breaks_at = {};   ///< When it breaks, s; none: never.

  /// (x, y) at arc length `s` of a tendon that ends at `end`, m.
  [[nodiscard]] Eigen::Vector2d offset(double s, double end) const;
};

/// A force and a moment at the end of a section, `[[arm.load]]`.
struct LoadConfig {
  std::int64_t section = 1;                  ///< Counted from 1 at the base.
  std::array<double, 3> force = {0, 0, 0};   ///< N, in the world's frame; following: in that of the end.
  std::array<double, 3> moment = {0, 0, 0};  ///< N m, likewise.
  bool following = false;                    ///< Turns with the section's end.
};

const std::vector<std::string>& names_of(const ArmMechanics*);
const Table<TendonRouteConfig>& fields_of(const TendonRouteConfig*);
const Table<LoadConfig>& fields_of(const LoadConfig*);

/// Reports to `reader`, at whose current place the arm stands, what of its tendons, loads and materials does
/// not fit together: an end at a section that it has not, a tendon outside the tube, a rod's section without
/// a material, a moving one without a mass.
void check_mechanics(const ArmConfig& arm, Reader& reader);

}  // namespace flexura
