#pragma once

#include <cstdint>

namespace flexura {

/// Kind of the surface that a pixel shows.
enum class SurfaceKind : std::uint8_t {
  background,
  section,  ///< The arm's surface. The index is that of the section.
  cap,      ///< A flat end of the arm; index 0 at the base, 1 at the tip, 2 where the radius jumps.
  marker,   ///< A marker ring. The index is that in the scene's list.
  disk,     ///< A guide disk.
  screen,
  etalon,       ///< The calibration cylinder; index 0: its side; 1, 2: its ends at +Y and -Y.
  etalon_line,  ///< A red line; index 0 at +Z, then counter-clockwise as seen from +Y.
  obstacle,
};

/// Identifies a surface of the scene.
struct SurfaceLabel {
  SurfaceKind kind = SurfaceKind::background;
  std::uint16_t index = 0;
  bool operator==(const SurfaceLabel&) const = default;
};

}  // namespace flexura
