#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

/// Of most metals: Poisson's ratio of a material that names neither it nor a shear modulus.
inline constexpr double common_poisson = 0.3;

/// Stiffness of a rod, given directly.
struct StiffnessConfig {
  std::array<double, 2> shear = {1, 1};  ///< GA towards the x and the y of the cross-section, N.
  double stretch = 1;                    ///< EA, N
  std::array<double, 2> bend = {1, 1};   ///< EI of bends towards x and towards y, N m^2.
  double twist = 1;                      ///< GJ, N m^2
};

/// How many Legendre polynomials of arc length each strain of a section is a sum of; 0: it stays as at rest.
struct ModesConfig {
  std::int64_t shear = 1;  ///< Each of the two directions.
  std::int64_t stretch = 1;
  std::int64_t bend = 5;  ///< Each of the two directions.
  std::int64_t twist = 4;
};

/// A body that is fixed on a section's backbone.
struct BodyConfig {
  double at = 1;                             ///< Where, of the section's length; in [0, 1].
  double mass = 0;                           ///< kg
  std::array<double, 3> offset = {0, 0, 0};  ///< Its centre of mass in the cross-section's frame, m.
};

/// What the elastic rod inside a section is made of, `[arm.section.material]`: either by
/// moduli and radii, or by its stiffness.
struct MaterialConfig {
  std::optional<double> youngs_modulus = {};         ///< E, Pa
  std::optional<double> shear_modulus = {};          ///< G, Pa
  std::optional<double> poisson = {};                ///< nu: G = E / (2 (1 + nu)). Beside no shear modulus.
  double density = 0;                                ///< kg/m^3
  std::optional<std::array<double, 2>> radius = {};  ///< At the section's base and end, m; else the tube's.
  std::array<double, 2> inner_radius = {0, 0};       ///< Of its bore, m.
  std::optional<StiffnessConfig> stiffness = {};     ///< Instead of the moduli.
  std::optional<double> mass_per_length = {};        ///< Instead of the density, kg/m.
  double damping_time = 0;                           ///< Of its viscosity: damping over stiffness, s.
  std::array<double, 2> rest_bend = {0, 0};          ///< The bend of the section when nothing pulls, rad.
  double rest_twist = 0;                             ///< Of its end against its base then, rad.
  std::optional<std::int64_t> disks = {};            ///< Tendons run straight between so many equal pieces.
  ModesConfig modes = {};
  std::int64_t nodes = 0;             ///< Of the quadrature; 0: as many as the modes need.
  std::vector<BodyConfig> mass = {};  ///< In any order.
};

const Table<StiffnessConfig>& fields_of(const StiffnessConfig*);
const Table<ModesConfig>& fields_of(const ModesConfig*);
const Table<BodyConfig>& fields_of(const BodyConfig*);
const Table<MaterialConfig>& fields_of(const MaterialConfig*);

/// Reports to `reader` what of a material at `path` cannot be in a tube of these radii, m: a bore as wide as
/// the rod.
void check_material(const MaterialConfig& material, const std::array<double, 2>& tube_radius,
                    const std::string& path, Reader& reader);

}  // namespace flexura
