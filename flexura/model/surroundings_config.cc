#include "flexura/model/surroundings_config.h"

#include <fmt/format.h>

#include "flexura/base/table.h"

namespace flexura {

const Table<ContactConfig>& fields_of(const ContactConfig*) {
  static const auto table =
      Table<ContactConfig>("contact", "Contacts of a dynamic arm with obstacles and with itself.")
          .field("stiffness", &ContactConfig::stiffness,
                 {.meaning = "Contact stiffness: force per metre of penetration and per metre of arm, N/m^2.",
                  .range = between(1e-3, 1e12)})
          .field(
              "damping", &ContactConfig::damping,
              {.meaning =
                   "Hunt-Crossley damping: relative increase of the contact force per m/s of approach, s/m.",
               .range = between(0, 1e6)})
          .field("friction", &ContactConfig::friction,
                 {.meaning = "Coulomb friction coefficient.", .range = between(0, 100)})
          .field("slip_speed", &ContactConfig::slip_speed,
                 {.meaning = "Slip speed below which a contact counts as sticking, m/s.",
                  .range = between(1e-9, 1e3)})
          .field("spacing", &ContactConfig::spacing,
                 {.meaning = "Distance between the contact points of the arm.",
                  .unit = Unit::metre,
                  .range = between(1e-6, 1e6),
                  .default_text = "the smallest radius of the tube"})
          .field("itself", &ContactConfig::itself, {.meaning = "Whether the arm can touch itself."});
  return table;
}

const Table<DragConfig>& fields_of(const DragConfig*) {
  static const auto table =
      Table<DragConfig>("drag", "Fluid around a dynamic arm.")
          .field("density", &DragConfig::density,
                 {.meaning = "Density of the fluid, kg/m^3: 1000 for water, 1.2 for air.",
                  .range = between(0, 1e6)})
          .field("across_coefficient", &DragConfig::across_coefficient,
                 {.meaning = "Drag coefficient across the arm, about 1 for a cylinder.",
                  .range = between(0, 1e3)})
          .field("along_coefficient", &DragConfig::along_coefficient,
                 {.meaning = "Drag coefficient of the skin along the arm.", .range = between(0, 1e3)})
          .field(
              "linear_across", &DragConfig::linear_across,
              {.meaning = "Linear drag across the arm, per metre of arm, N s/m^2.", .range = between(0, 1e9)})
          .field(
              "linear_along", &DragConfig::linear_along,
              {.meaning = "Linear drag along the arm, per metre of arm, N s/m^2.", .range = between(0, 1e9)})
          .field("flow", &DragConfig::flow,
                 {.meaning = "Velocity of the fluid in the world's frame, m/s: X, Y, Z.",
                  .range = between(-1e3, 1e3)});
  return table;
}

const Table<PayloadConfig>& fields_of(const PayloadConfig*) {
  static const auto table =
      Table<PayloadConfig>("payload", "A mass that a dynamic arm carries temporarily.")
          .field("section", &PayloadConfig::section,
                 {.meaning = "Section that carries the payload, counted from 1 at the base.",
                  .range = between(1, 1e6),
                  .required = true})
          .field(
              "at", &PayloadConfig::at,
              {.meaning = "Position along the section, as a fraction of its length.", .range = between(0, 1)})
          .field("mass", &PayloadConfig::mass,
                 {.meaning = "Mass, kg.", .range = between(0, 1e6), .required = true})
          .field("offset", &PayloadConfig::offset,
                 {.meaning = "Centre of mass in the cross-section's frame: x, y, z.",
                  .unit = Unit::metre,
                  .range = between(-1e3, 1e3)})
          .field("from", &PayloadConfig::from,
                 {.meaning =
                      "Time at which the arm picks up the payload. Before this time, the payload is at rest.",
                  .unit = Unit::second,
                  .range = between(0, 1e9)})
          .field("until", &PayloadConfig::until,
                 {.meaning = "Time at which the arm drops the payload.",
                  .unit = Unit::second,
                  .range = between(0, 1e9),
                  .default_text = "never"})
          .check([](const PayloadConfig& payload, Reader& reader) {
            if (payload.until && *payload.until <= payload.from)
              reader.problem_at("until",
                                fmt::format("is not after `from`: expected more than {} s", payload.from));
          });
  return table;
}

}  // namespace flexura
