#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Reflected fractions of red, green and blue light, each from 0 to 1.
using ColorConfig = std::array<double, 3>;

/// Shape of the arm's tip: cut straight across, or a hemisphere.
enum class TipKind { flat, round };

/// A coloured band around the arm. Position and width are measured along the unstretched arm. The band
/// stretches with the arm.
struct Marker {
  double at = 0;        ///< Distance of the band's middle from the base, m.
  double width = 0.01;  ///< Width along the arm, m; > 0.
  ColorConfig color = {0.85, 0.1, 0.1};
};

/// Bands of equal width at equal distances along every section.
struct MarkerBands {
  std::int64_t per_section = 4;  ///< Number of bands per section. The last band ends at the section's end.
  std::optional<double> width;   ///< Width of a band along the arm, m; default: a fifth of the spacing.
  /// Colours of the bands from base to tip, repeated cyclically.
  std::vector<ColorConfig> colors = {{0.85, 0.1, 0.1}};
};

/// A flat, round guide disk perpendicular to the backbone.
struct Disk {
  double at = 0;             ///< Distance of the disk's middle from the base along the unstretched arm, m.
  double radius = 0.03;      ///< Radius, m.
  double thickness = 0.004;  ///< Thickness along the arm, m.
};

/// Appearance of the arm in pictures, apart from its shape.
struct LookConfig {
  ColorConfig color = {0.08, 0.08, 0.09};  ///< Colour of the tube.
  TipKind tip = TipKind::flat;
  std::optional<MarkerBands> bands;
  std::vector<Marker> marker;  ///< Single markers in addition to the bands.
  std::vector<Disk> disk;
  ColorConfig disk_color = {0.35, 0.35, 0.37};

  /// Returns all markers on an arm from base to tip: the markers of `bands` and of `marker`.
  [[nodiscard]] std::vector<Marker> markers(const Arm& arm) const;
};

const std::vector<std::string>& names_of(const TipKind*);
const Table<Marker>& fields_of(const Marker*);
const Table<MarkerBands>& fields_of(const MarkerBands*);
const Table<Disk>& fields_of(const Disk*);
const Table<LookConfig>& fields_of(const LookConfig*);

/// Reports to `reader` markers and disks that are not on the arm, and markers that overlap. `path`: path of
/// `look` in the document.
void check_look(const LookConfig& look, const Arm& arm, const std::string& path, Reader& reader);

}  // namespace flexura
