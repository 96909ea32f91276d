#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

/// Poisson's ratio of most metals: for a material without it and without a shear modulus.
inline constexpr double common_poisson = 0.3;

/// Stiffness of a rod, given directly.
struct StiffnessConfig {
  std::array<double, 2> shear = {1, 1};  ///< GA towards the x and the y of the cross-section, N.
  double stretch = 1;                    ///< EA, N.
  std::array<double, 2> bend = {1, 1};   ///< EI of bends towards x and towards y, N m^2.
  double twist = 1;                      ///< GJ, N m^2.
};

/// Number of Legendre polynomials of arc length in each strain of a section; 0: the strain stays as at rest.
struct ModesConfig {
  std::int64_t shear = 1;  ///< For each of the two directions.
  std::int64_t stretch = 1;
  std::int64_t bend = 5;  ///< For each of the two directions.
  std::int64_t twist = 4;
};

/// A body fixed to a section's backbone.
struct BodyConfig {
  double at = 1;                             ///< Position as a share of the section's length; in [0, 1].
  double mass = 0;                           ///< kg.
  std::array<double, 3> offset = {0, 0, 0};  ///< Its centre of mass in the cross-section's frame, m.
};

/// Material of the elastic rod in a section, `[arm.section.material]`: either moduli and radii, or a
/// stiffness.
struct MaterialConfig {
  std::optional<double> youngs_modulus = {};         ///< E, Pa.
  std::optional<double> shear_modulus = {};          ///< G, Pa.
  std::optional<double> poisson = {};                ///< nu: G = E / (2 (1 + nu)). Excludes a shear modulus.
  double density = 0;                                ///< kg/m^3.
  std::optional<std::array<double, 2>> radius = {};  ///< At the section's base and end, m; or the tube's.
  std::array<double, 2> inner_radius = {0, 0};       ///< Radius of its bore, m.
  std::optional<StiffnessConfig> stiffness = {};     ///< Instead of the moduli.
  std::optional<double> mass_per_length = {};        ///< Instead of the density, kg/m.
  double damping_time = 0;                           ///< Viscosity: damping over stiffness, s.
  std::array<double, 2> rest_bend = {0, 0};          ///< Bend of the unloaded section, rad.
  double rest_twist = 0;                   ///< Rotation of its end relative to its base without load, rad.
  std::optional<std::int64_t> disks = {};  ///< Tendons run straight between this number of equal pieces.
  ModesConfig modes = {};
  std::int64_t nodes = 0;             ///< Nodes of the quadrature; 0: as many as the modes need.
  std::vector<BodyConfig> mass = {};  ///< In any order.
};

const Table<StiffnessConfig>& fields_of(const StiffnessConfig*);
const Table<ModesConfig>& fields_of(const ModesConfig*);
const Table<BodyConfig>& fields_of(const BodyConfig*);
const Table<MaterialConfig>& fields_of(const MaterialConfig*);

/// Reports to `reader` the errors of a material at `path` in a tube of these radii, m: a bore as wide as the
/// rod.
void check_material(const MaterialConfig& material, const std::array<double, 2>& tube_radius,
                    const std::string& path, Reader& reader);

}  // namespace flexura
