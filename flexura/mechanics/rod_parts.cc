#include "flexura/mechanics/rod_parts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace flexura {
namespace {

constexpr double one_disk = 1e-9;
// With fewer modes the user wants arcs, or arcs that change linearly.
constexpr int least_bends = 3;
// With more pieces the modes of the whole section are right to about 2e-4 of the length (docs/mechanics.md).
constexpr int most_pieces = 11;
// From so many pieces on, one mode of shear and of twist in each suffices.
constexpr int many_pieces = 8;

// A section's number of modes for a strain, spread over its pieces: each has all of them up to `share`
// pieces, then fewer in proportion to its length, but at least `least`.
int spread_modes(int count, int share, int pieces, int least) {
  if (count == 0) return 0;
  return std::clamp((share * count + pieces - 1) / pieces, least, std::max(least, count));
}

// Within a piece a rod under a chord is a beam under the tension at its ends: its curvature is nearly a
// parabola, its shear linear.
StrainModes modes_of_piece(StrainModes modes, int pieces) {
  const int least = pieces < many_pieces ? 2 : 1;
  modes.shear = spread_modes(modes.shear, 2, pieces, least);
  modes.stretch = spread_modes(modes.stretch, 2, pieces, 1);
  // Its curvature is nearly even about its middle: an even number of polynomials is hardly better than one
  // less.
  const int bend = spread_modes(modes.bend, 3, pieces, 3);
  modes.bend = std::min(modes.bend, bend % 2 == 0 ? bend + 1 : bend);
  modes.twist = spread_modes(modes.twist, 2, pieces, least);
  return modes;
}

// Coefficients of the same polynomial of t on a part from `begin` of the length `size`.
std::vector<Eigen::Vector3d> restricted_powers(std::vector<Eigen::Vector3d> powers, double begin,
                                               double size) {
  for (std::size_t i = 0; i + 1 < powers.size(); ++i)
    for (std::size_t k = powers.size() - 1; k-- > i;) powers[k] += begin * powers[k + 1];
  double scale = 1;
  for (Eigen::Vector3d& power : powers) {
    power *= scale;
    scale *= size;
  }
  return powers;
}

std::array<double, 2> narrowed(const std::array<double, 2>& ends, const RodPart& part) {
  const double rise = ends[1] - ends[0];
  return {ends[0] + part.begin * rise, ends[0] + part.end * rise};
}

RodSection section_of_part(const RodSection& section, const RodPart& part, int pieces) {
  RodSection rod = section;
  const double size = part.end - part.begin;
  rod.length = section.length * size;
  rod.radius = narrowed(section.radius, part);
  rod.inner_radius = narrowed(section.inner_radius, part);
  rod.rest_curvature = restricted_powers(section.rest_curvature, part.begin, size);
  rod.disks = 1;
  rod.modes = modes_of_piece(section.modes, pieces);
  rod.masses.clear();
  for (PointMass mass : section.masses) {
    if (!part.holds({part.section, mass.at})) continue;
    mass.at = part.within(mass.at);
    rod.masses.push_back(mass);
  }
  // So many nodes that the energy of all modes is exact.
  const int nodes = std::max(4, std::ranges::max(rod.modes.counts()) + 1);
  rod.nodes = std::max(nodes, (section.nodes + pieces - 1) / pieces);
  return rod;
}

}  // namespace

bool RodPart::holds(const RodPlace& place) const {
  return place.section == section && (begin == 0 || place.at > begin + one_disk) &&
         (is_last || place.at <= end + one_disk);
}

double RodPart::within(double at) const { return std::clamp((at - begin) / (end - begin), 0.0, 1.0); }

std::vector<RodPart> parts_of(const Rod& rod) {
  std::vector<RodPart> parts;
  double s_base = 0;
  for (std::size_t i = 0; i < rod.sections.size(); s_base += rod.sections[i].length, ++i) {
    const RodSection& section = rod.sections[i];
    if (section.disks == 0 || section.disks > most_pieces || !section.modes.by_piece ||
        section.modes.bend < least_bends) {
      parts.push_back({.section = i, .s_base = s_base, .rod = section});
      continue;
    }
    for (int piece = 0; piece < section.disks; ++piece) {
      RodPart part{.section = i,
                   .begin = static_cast<double>(piece) / section.disks,
                   .end = static_cast<double>(piece + 1) / section.disks,
                   .is_last = piece + 1 == section.disks};
      part.s_base = s_base + part.begin * section.length;
      part.rod = section_of_part(section, part, section.disks);
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

}  // namespace flexura
