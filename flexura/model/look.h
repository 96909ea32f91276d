#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Reflected shares of red, green and blue light, each from 0 to 1.
using ColorConfig = std::array<double, 3>;

/// End of the arm: cut straight across, or half a ball.
enum class TipKind { flat, round };

/// A coloured band around the arm. Positions are along the unstretched arm; a band stretches with it.
struct Marker {
  double at = 0;        ///< Middle, m from the base.
  double width = 0.01;  ///< m along the arm; > 0.
  ColorConfig color = {0.85, 0.1, 0.1};
};

/// Equal bands, evenly spaced along every section.
struct MarkerBands {
  std::int64_t per_section = 4;                          ///< The last one ends at the section's end.
  std::optional<double> width;                           ///< m; default: a fifth of the spacing.
  std::vector<ColorConfig> colors = {{0.85, 0.1, 0.1}};  ///< Used in turn, from the base on.
};

/// A guide disk: flat, round, across the arm.
struct Disk {
  double at = 0;             ///< Middle, m from the base along the unstretched arm.
  double radius = 0.03;      ///< m.
  double thickness = 0.004;  ///< m.
};

/// Appearance of the arm in a camera, apart from its shape.
struct LookConfig {
  ColorConfig color = {0.08, 0.08, 0.09};  ///< Colour of the tube.
  TipKind tip = TipKind::flat;
  std::optional<MarkerBands> bands;
  std::vector<Marker> marker;  ///< Single markers, in addition to the bands.
  std::vector<Disk> disk;
  ColorConfig disk_color = {0.35, 0.35, 0.37};

  /// Returns all markers of an arm, base first: those of the bands and the single ones.
  [[nodiscard]] std::vector<Marker> markers(const Arm& arm) const;
};

const std::vector<std::string>& names_of(const TipKind*);
const Table<Marker>& fields_of(const Marker*);
const Table<MarkerBands>& fields_of(const MarkerBands*);
const Table<Disk>& fields_of(const Disk*);
const Table<LookConfig>& fields_of(const LookConfig*);

/// Reports to `reader` the markers and disks at `path` that are not on the arm, or overlap.
void check_look(const LookConfig& look, const Arm& arm, const std::string& path, Reader& reader);

}  // namespace flexura
