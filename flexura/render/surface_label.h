#pragma once

#include <cstdint>

namespace flexura {

/// Kind of the surface that a pixel shows.
enum class SurfaceKind : std::uint8_t {
  background,
  section,  ///< The arm's skin; the index is the section's.
  cap,      ///< A flat end of the arm: 0 at the base, 1 at the tip, 2 where the radius steps.
  marker,   ///< The index is the ring's in the scene.
  disk,     ///< A tendon guide.
  screen,
  etalon,       ///< 0: the skin; 1, 2: its ends at +Y, -Y.
  etalon_line,  ///< 0 at +Z, then counter-clockwise seen from +Y.
  obstacle,
};

/// Identity of a surface.
struct SurfaceLabel {
  SurfaceKind kind = SurfaceKind::background;
  std::uint16_t index = 0;
  bool operator==(const SurfaceLabel&) const = default;
};

}  // namespace flexura
