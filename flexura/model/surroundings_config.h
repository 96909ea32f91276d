#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "flexura/base/fields.h"

namespace flexura {

/// Contact of a moving arm with obstacles and itself, `[arm.contact]` (docs/mechanics.md, "Contact").
struct ContactConfig {
  double stiffness = 1e5;              ///< N per metre of depth and per metre of the arm.
  double damping = 5;                  ///< Relative increase of the force per m/s of approach, s/m.
  double friction = 0.3;               ///< Coulomb friction coefficient.
  double slip_speed = 1e-3;            ///< Speed below which a contact sticks, m/s.
  std::optional<double> spacing = {};  ///< Spacing of contact points, m; default: the least tube radius.
  bool itself = false;                 ///< Includes self-contact.
};

/// Fluid around a moving arm, `[arm.drag]` (docs/mechanics.md, "Drag").
struct DragConfig {
  double density = 1000;                   ///< kg/m^3
  double across_coefficient = 1;           ///< Form drag coefficient, across the arm.
  double along_coefficient = 0.01;         ///< Skin friction coefficient, along the arm.
  double linear_across = 0;                ///< N s/m per metre.
  double linear_along = 0;                 ///< N s/m per metre.
  std::array<double, 3> flow = {0, 0, 0};  ///< Velocity of the fluid, in the world's frame, m/s.
};

/// A mass that a moving arm carries for a time, `[[arm.payload]]`.
struct PayloadConfig {
  std::int64_t section = 1;                  ///< Counted from 1 at the base.
  double at = 1;                             ///< Position as a share of the section's length; in [0, 1].
  double mass = 0;                           ///< kg.
  std::array<double, 3> offset = {0, 0, 0};  ///< Its centre of mass in the cross-section's frame, m.
  double from = 0;                           ///< Time at which it is picked up, s; it is at rest then.
  std::optional<double> until = {};          ///< Time at which it is dropped, s; default: never.
};

const Table<ContactConfig>& fields_of(const ContactConfig*);
const Table<DragConfig>& fields_of(const DragConfig*);
const Table<PayloadConfig>& fields_of(const PayloadConfig*);

}  // namespace flexura
