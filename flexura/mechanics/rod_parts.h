#pragma once

#include <cstddef>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// A part of a rod with strain modes of its own: a section or, where its tendons run straight between guide
/// disks, a piece of it between two disks.
struct RodPart {
  std::size_t section = 0;    ///< Its section in the rod.
  double begin = 0, end = 1;  ///< As parts of that section's length.
  bool is_last = true;        ///< Of its section.
  double s_base = 0;          ///< Arc length from the rod's base to its own, m.
  RodSection rod = {};        ///< Material, bodies and modes of this part alone.

  /// Returns whether the place is in it. A place between two parts of a section is in the first.
  [[nodiscard]] bool holds(const RodPlace& place) const;
  /// Returns a place of its section as a part of its own length, from 0 to 1.
  [[nodiscard]] double within(double at) const;
  /// Returns a place in it as a part of its section's length.
  [[nodiscard]] double of_section(double at) const { return begin + at * (end - begin); }
};

/// Returns the parts of a valid rod, from the base on. A section with 1 to 11 pieces between disks is divided
/// into them if StrainModes::by_piece is set and each bend has at least 3 modes, so that its curvature can
/// follow the chords (docs/mechanics.md). With more pieces the modes of the whole section suffice.
[[nodiscard]] std::vector<RodPart> parts_of(const Rod& rod);

}  // namespace flexura
