#include "flexura/model/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "flexura/base/table.h"
#include "flexura/model/arm_config.h"

namespace flexura {
namespace {

constexpr NumberRange stiffness_range = {.min = 0, .max = 1e15, .open_min = true};
constexpr NumberRange mode_range = {.min = 0, .max = 20};
constexpr std::size_t max_bodies = 1000;  // Per section.

Spec stiffness(const char* meaning, bool both = false) {
  return {.meaning = meaning, .range = stiffness_range, .required = true, .one_for_all = both};
}

Spec modes(const char* strain) {
  return {.meaning = fmt::format("Number of polynomials for {}.", strain), .range = mode_range};
}

void check_ways(const MaterialConfig& material, Reader& reader) {
  if (material.stiffness) {
    for (const auto& [name, modulus] :
         {std::pair{"youngs_modulus", &material.youngs_modulus},
          std::pair{"shear_modulus", &material.shear_modulus}, std::pair{"poisson", &material.poisson}})
      if (*modulus) reader.problem_at(name, "is given together with stiffness: expected one of them");
  } else if (!material.youngs_modulus) {
    reader.problem("has no stiffness: expected youngs_modulus, or stiffness");
  }
  if (material.shear_modulus && material.poisson)
    reader.problem_at("poisson", "is given together with shear_modulus: expected one of them");
  if (material.mass_per_length && material.density != 0)
    reader.problem_at("mass_per_length", "is given together with density: expected one of them");
  const ModesConfig& modes = material.modes;
  const std::int64_t least =
      std::max<std::int64_t>(2, 1 + std::max({modes.shear, modes.stretch, modes.bend, modes.twist}));
  if (material.nodes != 0 && material.nodes < least)
    reader.problem_at("nodes",
                      fmt::format("{}: expected at least {}, or 0 for the number that the modes need",
                                  material.nodes, least));
}

Table<MaterialConfig>& add_moduli(Table<MaterialConfig>& table) {
  return table
      .field("youngs_modulus", &MaterialConfig::youngs_modulus,
             {.meaning = "Young's modulus E, Pa.", .range = stiffness_range, .default_text = "not set"})
      .field("shear_modulus", &MaterialConfig::shear_modulus,
             {.meaning = "Shear modulus G, Pa.",
              .range = stiffness_range,
              .default_text = "E / (2 (1 + poisson))"})
      .field("poisson", &MaterialConfig::poisson,
             {.meaning = "Poisson's ratio; not allowed with `shear_modulus`.",
              .range = between(0, 0.5),
              .default_text = fmt::format("{}", common_poisson)})
      .field("density", &MaterialConfig::density, {.meaning = "Density, kg/m^3.", .range = between(0, 1e6)})
      .field("radius", &MaterialConfig::radius,
             {.meaning =
                  "Radius of the elastic rod. Two numbers, at the section's base and end, describe a taper.",
              .unit = Unit::metre,
              .range = between(1e-6, 1e6),
              .one_for_all = true,
              .default_text = "the section's"})
      .field("inner_radius", &MaterialConfig::inner_radius,
             {.meaning = "Radius of the rod's bore. Two numbers describe a taper.",
              .unit = Unit::metre,
              .range = between(0, 1e6),
              .one_for_all = true})
      .field("stiffness", &MaterialConfig::stiffness,
             {.meaning = "Stiffness of the rod, instead of the moduli.",
              .default_text = "from the moduli and radii"})
      .field("mass_per_length", &MaterialConfig::mass_per_length,
             {.meaning = "Mass per length of the rod, kg/m, instead of the density.",
              .range = between(0, 1e6),
              .default_text = "from the density and radii"})
      .field("damping_time", &MaterialConfig::damping_time,
             {.meaning = "Kelvin-Voigt damping of a dynamic arm, as ratio of damping to stiffness. A free "
                         "strain decays with this time constant.",
              .unit = Unit::second,
              .range = between(0, 1e3)});
}

}  // namespace

const Table<StiffnessConfig>& fields_of(const StiffnessConfig*) {
  static const auto table =
      Table<StiffnessConfig>("stiffness", "Stiffness of a rod, uniform along the rod.")
          .field("shear", &StiffnessConfig::shear,
                 stiffness("Shear stiffness GA towards x and y of the cross-section, N.", true))
          .field("stretch", &StiffnessConfig::stretch, stiffness("Axial stiffness EA, N."))
          .field("bend", &StiffnessConfig::bend,
                 stiffness("Bending stiffness EI towards x and y of the cross-section, N m^2.", true))
          .field("twist", &StiffnessConfig::twist, stiffness("Torsional stiffness GJ, N m^2."));
  return table;
}

const Table<ModesConfig>& fields_of(const ModesConfig*) {
  static const auto table =
      Table<ModesConfig>(
          "modes",
          "Number of polynomials in arc length that represent each strain of a section. 1: constant strain; "
          "0: strain fixed at its rest value. If guide disks divide the section into up to 11 pieces and "
          "`bend` is at least 3, each piece has its own polynomials. The number of polynomials per piece "
          "decreases with the number of pieces.")
          .field("shear", &ModesConfig::shear, modes("each of the two shear strains"))
          .field("stretch", &ModesConfig::stretch, modes("the axial strain"))
          .field("bend", &ModesConfig::bend, modes("each of the two curvatures"))
          .field("twist", &ModesConfig::twist, modes("the twist"));
  return table;
}

const Table<BodyConfig>& fields_of(const BodyConfig*) {
  static const auto table =
      Table<BodyConfig>("mass", "A body fixed on the backbone, such as a guide disk, a camera or a weight.")
          .field(
              "at", &BodyConfig::at,
              {.meaning = "Position along the section, as a fraction of its length.", .range = between(0, 1)})
          .field("mass", &BodyConfig::mass,
                 {.meaning = "Mass, kg.", .range = between(0, 1e6), .required = true})
          .field("offset", &BodyConfig::offset,
                 {.meaning = "Centre of mass in the cross-section's frame: x, y, z.",
                  .unit = Unit::metre,
                  .range = between(-1e3, 1e3)});
  return table;
}

const Table<MaterialConfig>& fields_of(const MaterialConfig*) {
  static const auto table = [] {
    Table<MaterialConfig> material("material",
                                   "Elastic rod in a section: moduli and radii or stiffness, and mass.");
    add_moduli(material)
        .field("rest_bend", &MaterialConfig::rest_bend,
               {.meaning = "Bend vector of the unloaded section.", .unit = Unit::radian, .range = bend_range})
        .field("rest_twist", &MaterialConfig::rest_twist,
               {.meaning = "Twist of the unloaded section: rotation of the section's end relative to its "
                           "base about the backbone, from x towards y.",
                .unit = Unit::radian,
                .range = bend_range})
        .field("disks", &MaterialConfig::disks,
               {.meaning = "Number of equal pieces into which guide disks divide the section. Tendons are "
                           "straight between disks.",
                .range = between(1, 1000),
                .default_text = "none: a continuous channel"})
        .field("modes", &MaterialConfig::modes, {.meaning = "Resolution of the strains."})
        .field("nodes", &MaterialConfig::nodes,
               {.meaning = "Number of quadrature nodes along the section, including both ends. The number of "
                           "nodes must be larger than the number of modes of each strain. 0: the program "
                           "chooses the number according to the modes.",
                .range = between(0, 64)})
        .field("mass", &MaterialConfig::mass,
               {.meaning = "Bodies on the section, as tables [[arm.section.material.mass]].",
                .count = {0, max_bodies},
                .default_text = "none"})
        .check(check_ways);
    return material;
  }();
  return table;
}

void check_material(const MaterialConfig& material, const std::array<double, 2>& tube_radius,
                    const std::string& path, Reader& reader) {
  const std::array<double, 2> radius = material.radius.value_or(tube_radius);
  for (std::size_t i = 0; i < 2; ++i) {
    if (material.inner_radius[i] < radius[i]) continue;
    reader.problem_at(path + ".inner_radius",
                      fmt::format("{} m in a rod of radius {} m: expected a smaller radius",
                                  material.inner_radius[i], radius[i]));
    return;
  }
}

}  // namespace flexura
