#include "flexura/kinematics/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace flexura {
namespace {

// The chord of a piece turned by psi on radius R is off by R (1 - cos(psi / 2)) = 2 R sin^2(psi / 4).
int pieces(const Arc& arc, double tolerance) {
  const double theta = arc.bend.norm();
  if (theta == 0.0) return 1;
  const double quarter_psi = std::asin(std::min(1.0, std::sqrt(0.5 * tolerance * (theta / arc.length))));
  const double for_tolerance = theta / (4.0 * quarter_psi);
  return std::max(1, static_cast<int>(std::ceil(std::max(for_tolerance, theta / (0.5 * std::numbers::pi)))));
}

}  // namespace

std::vector<double> sample_arc_lengths(const Backbone& backbone, double tolerance) {
  if (!(tolerance >= 1e-12 * backbone.length())) {
    throw std::invalid_argument("a sampling tolerance of " + std::to_string(tolerance) +
                                " m is below 1e-12 of the backbone's length");
  }
  std::vector<double> s;
  for (const Arc& arc : backbone.arcs()) {
    const int count = pieces(arc, tolerance);
    for (int i = 0; i < count; ++i) s.push_back(arc.s + arc.length * i / count);
  }
  s.push_back(backbone.length());
  return s;
}

}  // namespace flexura
