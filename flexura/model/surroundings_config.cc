#include "flexura/model/surroundings_config.h"

#include <fmt/format.h>

#include "flexura/base/table.h"

namespace flexura {

const Table<ContactConfig>& fields_of(const ContactConfig*) {
  static const auto table =
      Table<ContactConfig>("contact", "How a dynamic arm touches the obstacles, and itself.")
          .field("stiffness", &ContactConfig::stiffness,
                 {.meaning = "Force for each metre of depth and each metre of the arm, N/m^2.",
                  .range = between(1e-3, 1e12)})
          .field("damping", &ContactConfig::damping,
                 {.meaning = "By which part of it the force grows for each m/s of approach, s/m (K. H. Hunt "
                             "and F. R. E. Crossley).",
                  .range = between(0, 1e6)})
          .field("friction", &ContactConfig::friction,
                 {.meaning = "Coulomb's coefficient of friction.", .range = between(0, 100)})
          .field("slip_speed", &ContactConfig::slip_speed,
                 {.meaning = "A contact that slips more slowly sticks, m/s.", .range = between(1e-9, 1e3)})
          .field("spacing", &ContactConfig::spacing,
                 {.meaning = "How close the places of the arm are that touch something.",
                  .unit = Unit::metre,
                  .range = between(1e-6, 1e6),
                  .default_text = "the least radius of the tube"})
          .field("itself", &ContactConfig::itself, {.meaning = "Whether the arm touches itself, too."});
  return table;
}

const Table<DragConfig>& fields_of(const DragConfig*) {
  static const auto table =
      Table<DragConfig>("drag", "The fluid in which a dynamic arm moves.")
          .field("density", &DragConfig::density,
                 {.meaning = "Density of the fluid, kg/m^3: 1000 of water, 1.2 of air.",
                  .range = between(0, 1e6)})
          .field("across_coefficient", &DragConfig::across_coefficient,
                 {.meaning = "Drag coefficient across the arm; a cylinder's is about 1.",
                  .range = between(0, 1e3)})
          .field("along_coefficient", &DragConfig::along_coefficient,
                 {.meaning = "Drag coefficient of its skin, along it.", .range = between(0, 1e3)})
          .field("linear_across", &DragConfig::linear_across,
                 {.meaning = "Drag in proportion to the speed, across each metre of the arm, N s/m^2.",
                  .range = between(0, 1e9)})
          .field("linear_along", &DragConfig::linear_along,
                 {.meaning = "The same along it.", .range = between(0, 1e9)})
          .field("flow", &DragConfig::flow,
                 {.meaning = "Velocity of the fluid in the world's frame, m/s: X, Y, Z.",
                  .range = between(-1e3, 1e3)});
  return table;
}

const Table<PayloadConfig>& fields_of(const PayloadConfig*) {
  static const auto table =
      Table<PayloadConfig>("payload", "A mass that a dynamic arm carries for a time.")
          .field("section", &PayloadConfig::section,
                 {.meaning = "The section that carries it, counted from 1 at the base.",
                  .range = between(1, 1e6),
                  .required = true})
          .field("at", &PayloadConfig::at,
                 {.meaning = "Where, as a part of the section's length.", .range = between(0, 1)})
          .field("mass", &PayloadConfig::mass,
                 {.meaning = "Its mass, kg.", .range = between(0, 1e6), .required = true})
          .field("offset", &PayloadConfig::offset,
                 {.meaning = "Its centre in the cross-section's frame: x, y, z.",
                  .unit = Unit::metre,
                  .range = between(-1e3, 1e3)})
          .field("from", &PayloadConfig::from,
                 {.meaning = "When the arm picks it up. It is at rest until then.",
                  .unit = Unit::second,
                  .range = between(0, 1e9)})
          .field("until", &PayloadConfig::until,
                 {.meaning = "When the arm drops it.",
                  .unit = Unit::second,
                  .range = between(0, 1e9),
                  .default_text = "never"})
          .check([](const PayloadConfig& payload, Reader& reader) {
            if (payload.until && *payload.until <= payload.from)
              reader.problem_at("until",
                                fmt::format("is not after from: expected more than {} s", payload.from));
          });
  return table;
}

}  // namespace flexura
