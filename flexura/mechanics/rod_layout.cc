#include "flexura/mechanics/rod_layout.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "flexura/math/lanes.h"

namespace flexura {
namespace {

constexpr std::size_t widest = lanes_of<Lanes>;

Triple<double> triple(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// Combines a slice of the rod and its point masses, if wanted, into one body.
RodLayout::Body body_of(const RodSection& section, const RodGrid& grid, std::size_t node, bool rotary_inertia,
                        bool with_masses) {
  struct Part {
    double mass;
    Eigen::Vector3d centre;
  };
  const double run = grid.weight[node] * section.length;
  std::vector<Part> parts = {{run * grid.mass_per_length[node], Eigen::Vector3d::Zero()}};
  for (std::size_t i = 0; with_masses && i < section.masses.size(); ++i)
    if (grid.mass_nodes[i] == node) parts.push_back({section.masses[i].mass, section.masses[i].offset});
  double mass = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Part& part : parts) {
    mass += part.mass;
    centre += part.mass * part.centre;
  }
  if (mass > 0) centre /= mass;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  if (rotary_inertia) inertia.diagonal() = run * section.slice_inertia_at(grid.t[node]);
  for (const Part& part : parts) {
    const Eigen::Vector3d off = part.centre - centre;
    inertia += part.mass * (off.squaredNorm() * Eigen::Matrix3d::Identity() - off * off.transpose());
  }
  return {.mass = mass,
          .centre = triple(centre),
          .inertia = {triple(inertia.row(0)), triple(inertia.row(1)), triple(inertia.row(2))}};
}

}  // namespace

RodLayout::RodLayout(const RodChain& chain, bool rotary_inertia) : tendons(chain.tendons()) {
  const Rod& rod = chain.rod();
  for (const RodElement& element : chain.elements()) {
    const RodPart& part = element.part();
    const RodSection& from = part.rod;
    if (part.is_last) ends.push_back(sections.size());
    Section& section =
        sections.emplace_back(Section{.part = part, .grid = element.grid(), .length = from.length});
    const RodGrid& grid = section.grid;
    section.first_mode = modes;
    section.first_interval = intervals;
    section.first_node = nodes;
    section.modes = static_cast<std::size_t>(grid.size);
    section.intervals = grid.t.size() - 1;
    section.disks = grid.disks;
    section.strain.resize(section.modes);
    section.stiffness.setZero(grid.size, grid.size);
    section.damping.setZero(grid.size, grid.size);
    grid.for_modes(
        [&](int c, int j) { section.strain[static_cast<std::size_t>(j)] = static_cast<std::size_t>(c); });
    for (std::size_t k = 0; k < grid.t.size(); ++k) {
      const double length = grid.weight[k] * from.length;
      const Vector6d damping = from.damping_at(grid.t[k]);
      run.push_back(length);
      bodies.push_back(body_of(from, grid, k, rotary_inertia, true));
      slices.push_back(body_of(from, grid, k, rotary_inertia, false));
      const auto at = grid.at_node.col(static_cast<Eigen::Index>(k));
      for (int j = 0; j < grid.size; ++j) {
        for (int l = 0; l < grid.size; ++l) {
          const std::size_t c = section.strain[static_cast<std::size_t>(j)];
          if (section.strain[static_cast<std::size_t>(l)] != c) continue;
          const double both = length * at[j] * at[l];
          section.stiffness(j, l) += grid.stiffness[k][static_cast<Eigen::Index>(c)] * both;
          section.damping(j, l) += damping[static_cast<Eigen::Index>(c)] * both;
        }
      }
    }
    for (std::size_t i = 0; i < rod.tendons.size(); ++i) {
      if (rod.tendons[i].section < part.section) continue;
      section.tendons.push_back(i);
      for (const double t : grid.t) {
        const TendonRoute::Offset offset = rod.tendons[i].at(part.s_base + t * from.length);
        section.passages.push_back({triple(offset.value), triple(offset.slope), triple(offset.second)});
      }
    }
    for (std::size_t m = 0; m < 3; ++m) {
      section.first_moment = m == 0 ? moments[0].size() : section.first_moment;
      for (int j = 0; j < grid.size; ++j)
        for (std::size_t i = 0; i < section.intervals; ++i)
          moments[m].push_back(grid.moments[m](j, static_cast<Eigen::Index>(i)));
    }
    modes += section.modes;
    intervals += section.intervals;
    nodes += grid.t.size();
  }
  padded = (intervals + widest - 1) / widest * widest;
  rest.assign(18 * padded, 0.0);
  for (const Section& section : sections)
    for (std::size_t i = 0; i < section.intervals; ++i)
      for (std::size_t m = 0; m < 3; ++m)
        for (std::size_t c = 0; c < 6; ++c)
          rest[(6 * m + c) * padded + section.first_interval + i] =
              section.grid.rest_moments[i][m][static_cast<Eigen::Index>(c)];
  stretches.assign(sections.size(), 0.0);
  find_rubbing(rod);
}

std::size_t RodLayout::element_of(const RodPlace& place) const {
  const auto found =
      std::ranges::find_if(sections, [&](const Section& section) { return section.part.holds(place); });
  if (found == sections.end()) throw std::invalid_argument("the place is outside the rod");
  return static_cast<std::size_t>(found - sections.begin());
}

std::size_t RodLayout::node_of(const RodPlace& place) const {
  constexpr double same_place = 1e-9;
  const Section& section = sections[element_of(place)];
  const std::size_t at = section.grid.node_at(section.part.within(place.at));
  if (!(std::abs(section.part.of_section(section.grid.t[at]) - place.at) <= same_place))
    throw std::invalid_argument("no node is at this place");
  return section.first_node + at;
}

void RodLayout::find_rubbing(const Rod& rod) {
  for (std::size_t i = 0; i < rod.tendons.size(); ++i) {
    if (!(rod.tendons[i].friction > 0)) continue;
    Rubbing& one = rubbing.emplace_back(
        Rubbing{.tendon = i, .friction = rod.tendons[i].friction, .first = pieces, .pieces = {}});
    for (std::size_t s = 0; s <= ends[rod.tendons[i].section]; ++s) {
      const Section& section = sections[s];
      if (section.disks.empty()) {
        for (std::size_t k = 0; k <= section.intervals; ++k)
          if (run[section.first_node + k] != 0) one.pieces.push_back({s, k, run[section.first_node + k], 0});
      } else {
        for (std::size_t k = 0; k + 1 < section.disks.size(); ++k)
          one.pieces.push_back({s, k, section.length / static_cast<double>(section.disks.size() - 1), 0});
      }
    }
    for (std::size_t k = 1; k < one.pieces.size(); ++k)
      one.pieces[k].held = (one.pieces[k - 1].run + one.pieces[k].run) / 2;
    pieces += one.pieces.size();
  }
}

void RodLayout::stretch_rest(std::span<const double> factors, std::span<const double> factor_rates) {
  constexpr std::size_t stretch = 2;  // Index among the strains.
  is_driven = false;
  for (std::size_t s = 0; s < sections.size(); ++s) {
    Section& section = sections[s];
    const std::size_t of = section.part.section;
    section.grid.stretch_rest(factors[of]);
    stretches[s] = factor_rates[of];
    is_driven = is_driven || factor_rates[of] != 0;
    for (std::size_t i = 0; i < section.intervals; ++i)
      rest[stretch * padded + section.first_interval + i] = section.grid.rest_moments[i][0][stretch];
  }
}

}  // namespace flexura
