#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "flexura/base/fields.h"

namespace flexura {

/// How a moving arm touches obstacles and itself, `[arm.contact]` (docs/mechanics.md, "Contact").
struct ContactConfig {
  double stiffness = 1e5;              ///< N for each metre of depth and each metre of the arm.
  double damping = 5;                  ///< The force grows by this part of it for each m/s of approach, s/m.
  double friction = 0.3;               ///< Coulomb's coefficient.
  double slip_speed = 1e-3;            ///< Slower than this a contact sticks, m/s.
  std::optional<double> spacing = {};  ///< Of the places that touch, m; none: the tube's least radius.
  bool itself = false;                 ///< The arm touches itself, too.
};

/// The fluid in which an arm moves, `[arm.drag]` (docs/mechanics.md, "Drag").
struct DragConfig {
  double density = 1000;                   ///< kg/m^3
  double across_coefficient = 1;           ///< Of the form, across the arm.
  double along_coefficient = 0.01;         ///< Of the skin, along it.
  double linear_across = 0;                ///< N s/m for each metre.
  double linear_along = 0;                 ///< Likewise.
  std::array<double, 3> flow = {0, 0, 0};  ///< Of the fluid, in the world's frame, m/s.
};

/// A mass that a moving arm carries for a time, `[[arm.payload]]`.
struct PayloadConfig {
  std::int64_t section = 1;                  ///< Counted from 1 at the base.
  double at = 1;                             ///< Where, of the section's length; in [0, 1].
  double mass = 0;                           ///< kg
  std::array<double, 3> offset = {0, 0, 0};  ///< Of its centre in the cross-section's frame, m.
  double from = 0;                           ///< When it is picked up, s; it is at rest then.
  std::optional<double> until = {};          ///< When it is dropped, s; none: never.
};

const Table<ContactConfig>& fields_of(const ContactConfig*);
const Table<DragConfig>& fields_of(const DragConfig*);
const Table<PayloadConfig>& fields_of(const PayloadConfig*);

}  // namespace flexura
