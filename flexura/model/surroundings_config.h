#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "flexura/base/fields.h"

namespace flexura {

/// Contact of a moving arm with obstacles and itself, `[arm.contact]` (docs/mechanics.md, "Contact").
struct ContactConfig {
  double stiffness = 1e5;  ///< Contact force per metre of penetration and per metre of arm, N/m^2.
  /// Hunt-Crossley damping: relative increase of the contact force per m/s of approach, s/m.
  double damping = 5;
  double friction = 0.3;     ///< Coulomb friction coefficient.
  double slip_speed = 1e-3;  ///< Slip speed below which a contact sticks, m/s.
  /// Distance between contact points along the arm, m; default: the smallest tube radius.
  std::optional<double> spacing = {};
  bool itself = false;  ///< Whether the arm can touch itself.
};

/// Fluid around a moving arm, `[arm.drag]` (docs/mechanics.md, "Drag").
struct DragConfig {
  double density = 1000;                   ///< Density of the fluid, kg/m^3.
  double across_coefficient = 1;           ///< Form drag coefficient, across the arm.
  double along_coefficient = 0.01;         ///< Skin friction coefficient, along the arm.
  double linear_across = 0;                ///< Linear drag across the arm, per metre of arm, N s/m^2.
  double linear_along = 0;                 ///< Linear drag along the arm, per metre of arm, N s/m^2.
  std::array<double, 3> flow = {0, 0, 0};  ///< Velocity of the fluid, in the world's frame, m/s.
};

/// A mass that a moving arm carries temporarily, `[[arm.payload]]`.
struct PayloadConfig {
  std::int64_t section = 1;  ///< Section that carries the payload, counted from 1 at the base.
  double at = 1;             ///< Position along the section as a fraction of its length; in [0, 1].
  double mass = 0;           ///< Mass, kg.
  std::array<double, 3> offset = {0, 0, 0};  ///< Centre of mass in the cross-section's frame, m.
  /// Time at which the arm picks up the payload, s. Before this time, the payload is at rest.
  double from = 0;
  std::optional<double> until = {};  ///< Time at which the arm drops the payload, s; default: never.
};

const Table<ContactConfig>& fields_of(const ContactConfig*);
const Table<DragConfig>& fields_of(const DragConfig*);
const Table<PayloadConfig>& fields_of(const PayloadConfig*);

}  // namespace flexura
