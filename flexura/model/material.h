#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

/// Poisson's ratio of a material if a file has neither Poisson's ratio nor a shear modulus. This value is
/// typical of metals.
inline constexpr double common_poisson = 0.3;

/// Stiffness of a rod, given directly instead of computed from moduli and radii.
struct StiffnessConfig {
  std::array<double, 2> shear = {1, 1};  ///< Shear stiffness GA towards x and y of the cross-section, N.
  double stretch = 1;                    ///< Axial stiffness EA, N.
  std::array<double, 2> bend = {1, 1};   ///< Bending stiffness EI for bends towards x and towards y, N m^2.
  double twist = 1;                      ///< Torsional stiffness GJ, N m^2.
};

/// Number of Legendre polynomials in arc length for each strain of a section. A strain with the number 0 is
/// fixed at its rest value.
struct ModesConfig {
  std::int64_t shear = 1;  ///< Number for each of the two shear strains.
  std::int64_t stretch = 1;
  std::int64_t bend = 5;  ///< Number for each of the two curvatures.
  std::int64_t twist = 4;
};

/// A rigid body fixed to a section's backbone.
struct BodyConfig {
  double at = 1;    ///< Position along the section as a fraction of its length; in [0, 1].
  double mass = 0;  ///< Mass, kg.
  std::array<double, 3> offset = {0, 0, 0};  ///< Centre of mass in the cross-section's frame, m.
};

/// Material of the elastic rod in a section, `[arm.section.material]`. The rod's stiffness is computed from
/// moduli and radii, or given by `stiffness`.
struct MaterialConfig {
  std::optional<double> youngs_modulus = {};  ///< Young's modulus E, Pa.
  std::optional<double> shear_modulus = {};   ///< Shear modulus G, Pa.
  /// Poisson's ratio nu, with G = E / (2 (1 + nu)); not allowed with a shear modulus.
  std::optional<double> poisson = {};
  double density = 0;  ///< Density, kg/m^3.
  /// Outer radius of the rod at the section's base and end, m; default: the tube's radius.
  std::optional<std::array<double, 2>> radius = {};
  /// Radius of the rod's bore at the section's base and end, m.
  std::array<double, 2> inner_radius = {0, 0};
  std::optional<StiffnessConfig> stiffness = {};  ///< Stiffness of the rod, instead of the moduli.
  std::optional<double> mass_per_length = {};  ///< Mass per length of the rod, instead of the density, kg/m.
  double damping_time = 0;                     ///< Ratio of damping to stiffness (Kelvin-Voigt), s.
  std::array<double, 2> rest_bend = {0, 0};    ///< Bend vector of the unloaded section, rad.
  /// Twist of the unloaded section: rotation of its end relative to its base about the backbone, rad.
  double rest_twist = 0;
  /// Number of equal pieces into which guide disks divide the section. Tendons are straight in each piece.
  std::optional<std::int64_t> disks = {};
  ModesConfig modes = {};
  /// Number of quadrature nodes along the section; 0: the number that the modes need.
  std::int64_t nodes = 0;
  std::vector<BodyConfig> mass = {};  ///< Bodies fixed to the section, in any order.
};

const Table<StiffnessConfig>& fields_of(const StiffnessConfig*);
const Table<ModesConfig>& fields_of(const ModesConfig*);
const Table<BodyConfig>& fields_of(const BodyConfig*);
const Table<MaterialConfig>& fields_of(const MaterialConfig*);

/// Reports to `reader` a bore that is not narrower than the rod. `path`: path of `material` in the document.
/// `tube_radius`: radii of the section's tube at its base and end, m.
void check_material(const MaterialConfig& material, const std::array<double, 2>& tube_radius,
                    const std::string& path, Reader& reader);

}  // namespace flexura
