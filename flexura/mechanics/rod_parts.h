#pragma once

#include <cstddef>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// A part of a rod with separate strain modes: a whole section, or the piece of a section between two guide
/// disks.
struct RodPart {
  std::size_t section = 0;    ///< Index of the section that the part belongs to.
  double begin = 0, end = 1;  ///< Begin and end of the part, as fractions of the section's length.
  bool is_last = true;        ///< Whether the part is the last of its section.
  double s_base = 0;          ///< Arc length from the rod's base to the part's base, m.
  RodSection rod = {};        ///< Material, bodies and modes of this part only.

  /// Returns whether the place is in the part. A place at the boundary of two parts is in the proximal part.
  [[nodiscard]] bool holds(const RodPlace& place) const;
  /// Converts a position from a fraction of the section's length to a fraction of the part's length, 0 to 1.
  [[nodiscard]] double within(double at) const;
  /// Converts a position from a fraction of the part's length to a fraction of the section's length.
  [[nodiscard]] double of_section(double at) const { return begin + at * (end - begin); }
};

/// Returns the parts of a valid rod, from the base on. A section with 1 to 11 pieces between disks is divided
/// into these pieces, if StrainModes::by_piece is set and each bend has at least 3 modes. The curvature of a
/// divided section can follow the straight tendons (docs/mechanics.md). With more than 11 pieces the modes of
/// the whole section suffice.
[[nodiscard]] std::vector<RodPart> parts_of(const Rod& rod);

}  // namespace flexura
