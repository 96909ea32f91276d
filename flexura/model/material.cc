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

Spec modes(const char* strain) { return {.meaning = fmt::format("Of {}.", strain), .range = mode_range}; }

void check_ways(const MaterialConfig& material, Reader& reader) {
  if (material.stiffness) {
    for (const auto& [name, modulus] :
         {std::pair{"youngs_modulus", &material.youngs_modulus},
          std::pair{"shear_modulus", &material.shear_modulus}, std::pair{"poisson", &material.poisson}})
      if (*modulus) reader.problem_at(name, "is given beside stiffness: expected one of them");
  } else if (!material.youngs_modulus) {
    reader.problem("says no stiffness: expected youngs_modulus, or stiffness");
  }
  if (material.shear_modulus && material.poisson)
    reader.problem_at("poisson", "is given beside shear_modulus: expected one of them");
  if (material.mass_per_length && material.density != 0)
    reader.problem_at("mass_per_length", "is given beside density: expected one of them");
  const ModesConfig& modes = material.modes;
  const std::int64_t least =
      std::max<std::int64_t>(2, 1 + std::max({modes.shear, modes.stretch, modes.bend, modes.twist}));
  if (material.nodes != 0 && material.nodes < least)
    reader.problem_at("nodes", fmt::format("{}: expected at least {}, or 0 for as many as the modes need",
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
             {.meaning = "Poisson's ratio, beside no shear_modulus.",
              .range = between(0, 0.5),
              .default_text = fmt::format("{}", common_poisson)})
      .field("density", &MaterialConfig::density, {.meaning = "Density, kg/m^3.", .range = between(0, 1e6)})
      .field("radius", &MaterialConfig::radius,
             {.meaning = "Radius of the elastic rod; two numbers for a taper, at the section's base and end.",
              .unit = Unit::metre,
              .range = between(1e-6, 1e6),
              .one_for_all = true,
              .default_text = "the section's"})
      .field("inner_radius", &MaterialConfig::inner_radius,
             {.meaning = "Radius of its bore; two numbers for a taper.",
              .unit = Unit::metre,
              .range = between(0, 1e6),
              .one_for_all = true})
      .field("stiffness", &MaterialConfig::stiffness,
             {.meaning = "Its stiffness, instead of the moduli.",
              .default_text = "that of the moduli and radii"})
      .field("mass_per_length", &MaterialConfig::mass_per_length,
             {.meaning = "Mass of a metre of it, kg/m, instead of the density.",
              .range = between(0, 1e6),
              .default_text = "that of the density and radii"})
      .field("damping_time", &MaterialConfig::damping_time,
             {.meaning = "Viscosity (Kelvin and Voigt): damping over stiffness, the time in which a strain "
                         "that nothing holds falls to 1/e. Of dynamic arms.",
              .unit = Unit::second,
              .range = between(0, 1e3)});
}

}  // namespace

const Table<StiffnessConfig>& fields_of(const StiffnessConfig*) {
  static const auto table =
      Table<StiffnessConfig>("stiffness", "Stiffness of a rod, the same all along it.")
          .field("shear", &StiffnessConfig::shear,
                 stiffness("Against shear towards the x and the y of the cross-section, GA, N.", true))
          .field("stretch", &StiffnessConfig::stretch, stiffness("Against stretch, EA, N."))
          .field("bend", &StiffnessConfig::bend,
                 stiffness("Against bends towards the x and the y of the cross-section, EI, N m^2.", true))
          .field("twist", &StiffnessConfig::twist, stiffness("Against twist, GJ, N m^2."));
  return table;
}

const Table<ModesConfig>& fields_of(const ModesConfig*) {
  static const auto table =
      Table<ModesConfig>(
          "modes",
          "How finely a section's strains are resolved: of how many polynomials of arc length each "
          "is made, 1 for a constant one; 0: it stays as it is at rest.")
          .field("shear", &ModesConfig::shear, modes("the two shears, each"))
          .field("stretch", &ModesConfig::stretch, modes("the stretch"))
          .field("bend", &ModesConfig::bend, modes("the two curvatures, each"))
          .field("twist", &ModesConfig::twist, modes("the twist"));
  return table;
}

const Table<BodyConfig>& fields_of(const BodyConfig*) {
  static const auto table =
      Table<BodyConfig>("mass", "A body that is fixed on the backbone: a guide disk, a camera, a weight.")
          .field("at", &BodyConfig::at,
                 {.meaning = "Where, as a part of the section's length.", .range = between(0, 1)})
          .field("mass", &BodyConfig::mass,
                 {.meaning = "Its mass, kg.", .range = between(0, 1e6), .required = true})
          .field("offset", &BodyConfig::offset,
                 {.meaning = "Its centre of mass in the cross-section's frame: x, y, z.",
                  .unit = Unit::metre,
                  .range = between(-1e3, 1e3)});
  return table;
}

const Table<MaterialConfig>& fields_of(const MaterialConfig*) {
  static const auto table = [] {
    Table<MaterialConfig> material(
        "material", "The elastic rod in a section: its moduli and radii, or its stiffness, and its mass.");
    add_moduli(material)
        .field("rest_bend", &MaterialConfig::rest_bend,
               {.meaning = "The bend vector that the section has when nothing pulls.",
                .unit = Unit::radian,
                .range = bend_range})
        .field(
            "rest_twist", &MaterialConfig::rest_twist,
            {.meaning = "How its end is turned against its base about the backbone then, from x towards y.",
             .unit = Unit::radian,
             .range = bend_range})
        .field("disks", &MaterialConfig::disks,
               {.meaning = "Guide disks cut the section into this many equal pieces, and the tendons run "
                           "straight between them.",
                .range = between(1, 1000),
                .default_text = "none: a continuous channel"})
        .field("modes", &MaterialConfig::modes, {.meaning = "How finely its strains are resolved."})
        .field(
            "nodes", &MaterialConfig::nodes,
            {.meaning = "Places along the section at which forces are summed up, its ends among them, more "
                        "than any strain has modes; 0: as many as the modes need.",
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
    reader.problem_at(path + ".inner_radius", fmt::format("{} m in a rod of radius {} m: expected less",
                                                          material.inner_radius[i], radius[i]));
    return;
  }
}

}  // namespace flexura
