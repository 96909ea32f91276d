#include "flexura/mechanics/rod_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "flexura/math/magnus.h"
#include "flexura/math/quadrature.h"

namespace flexura {
namespace {

// A point nearer to a node than this counts as the node.
constexpr double at_the_node = 1e-9;

}  // namespace

RodPoints::RodPoints(const RodLayout& layout, std::span<const RodPlace> places) {
  const std::array<double, 3> gauss = magnus_points();
  for (const RodPlace& place : places) {
    if (place.section >= layout.ends.size() || !(place.at >= 0) || !(place.at <= 1))
      throw std::invalid_argument(
          fmt::format("the point at {} of section {} is outside the rod", place.at, place.section + 1));
    const std::size_t element = layout.element_of(place);
    const RodLayout::Section& section = layout.sections[element];
    const RodSection& from = section.part.rod;
    const double at = section.part.within(place.at);
    const RodGrid& grid = section.grid;
    Point& point = points.emplace_back();
    point.section = element;
    const std::size_t node = grid.node_at(at);
    if (std::abs(grid.t[node] - at) <= at_the_node) {
      point.is_node = true;
      point.interval = std::min(node, section.intervals - 1);
      point.node = section.first_node + node;
      point.part = node < section.intervals ? 0 : 1;
      continue;
    }
    point.interval = static_cast<std::size_t>(std::ranges::upper_bound(grid.t, at) - grid.t.begin()) - 1;
    point.node = section.first_node + point.interval;
    const double begin = grid.t[point.interval], run = at - begin;
    point.part = run / (grid.t[point.interval + 1] - begin);
    point.first_moment = moments.size();
    const auto modes_at = [&](double part) {
      Eigen::VectorXd modes(grid.size);
      grid.for_modes([&](int c, int j) {
        modes[j] = legendre(j - grid.first[static_cast<std::size_t>(c)], 2 * (begin + part * run) - 1);
      });
      return modes;
    };
    const auto rest_at = [&](double part) { return from.rest_strain_at(begin + part * run); };
    const double length = run * section.length;
    for (const Eigen::VectorXd& of_modes :
         magnus_moments(length, modes_at(gauss[0]), modes_at(gauss[1]), modes_at(gauss[2])))
      moments.insert(moments.end(), of_modes.begin(), of_modes.end());
    for (const Vector6d& at_rest :
         magnus_moments(length, rest_at(gauss[0]), rest_at(gauss[1]), rest_at(gauss[2])))
      moments.insert(moments.end(), at_rest.begin(), at_rest.end());
  }
}

}  // namespace flexura
