#include "flexura/mechanics/rod.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flexura {
namespace {

constexpr int max_modes = 20, max_nodes = 64, max_disks = 1000;

double between(const std::array<double, 2>& ends, double t) { return ends[0] + (ends[1] - ends[0]) * t; }

bool is_positive(double value) { return std::isfinite(value) && value > 0; }
bool is_at_least_0(double value) { return std::isfinite(value) && value >= 0; }

// Returns value and first two derivatives of a polynomial.
std::array<double, 3> polynomial(const std::vector<double>& coefficients, double s) {
  std::array<double, 3> p{};
  for (std::size_t i = coefficients.size(); i-- > 0;) {
    p[2] = p[2] * s + 2 * p[1];
    p[1] = p[1] * s + p[0];
    p[0] = p[0] * s + coefficients[i];
  }
  return p;
}

std::string section_problem(const RodSection& section) {
  if (!is_positive(section.length)) return "length must be above 0";
  for (const double t : {0.0, 1.0}) {
    const double outer = between(section.radius, t), inner = between(section.inner_radius, t);
    if (!is_positive(outer)) return "radius must be above 0";
    if (!is_at_least_0(inner) || inner >= outer)
      return "inner radius must be at least 0 and below the radius";
  }
  if (section.stiffness) {
    for (const double k : *section.stiffness)
      if (!is_positive(k)) return "every stiffness must be above 0";
  } else if (!is_positive(section.youngs_modulus) || !is_positive(section.shear_modulus)) {
    return "Young's modulus and shear modulus must be above 0";
  }
  if (!is_at_least_0(section.density) || !is_at_least_0(section.mass_per_length.value_or(0)))
    return "density and mass must be at least 0";
  if (!is_at_least_0(section.damping_time) ||
      !std::ranges::all_of(section.damping.value_or(Vector6d::Zero()), is_at_least_0))
    return "damping must be at least 0";
  for (const auto& coefficient : section.rest_curvature)
    if (!coefficient.allFinite()) return "the curvature at rest is not finite";
  for (const PointMass& mass : section.masses) {
    if (!is_at_least_0(mass.mass) || !mass.offset.allFinite()) return "a mass must be at least 0";
    if (!is_at_least_0(mass.at) || mass.at > 1) return "a mass must lie within the section, from 0 to 1";
  }
  const auto counts = section.modes.counts();
  if (std::ranges::any_of(counts, [](int count) { return count < 0 || count > max_modes; }))
    return fmt::format("a strain must have from 0 to {} modes", max_modes);
  if (section.nodes != 0 && (section.nodes < 2 || section.nodes > max_nodes))
    return fmt::format("there must be from 2 to {} nodes, or 0 for as many as are needed", max_nodes);
  if (section.disks < 0 || section.disks > max_disks)
    return fmt::format("there must be from 0 to {} pieces between disks", max_disks);
  return "";
}

std::string tendon_problem(const TendonRoute& tendon, std::size_t sections) {
  if (tendon.section >= sections) return "ends at a section that the rod does not have";
  bool is_finite = true;
  for (const double value : {tendon.radius, tendon.radius_slope, tendon.angle, tendon.angle_slope})
    is_finite = is_finite && std::isfinite(value);
  for (const auto* coefficients : {&tendon.x, &tendon.y})
    for (const double value : *coefficients) is_finite = is_finite && std::isfinite(value);
  if (!is_finite) return "has a path that is not finite";
  if (!is_at_least_0(tendon.compliance)) return "must have a compliance of at least 0";
  if (!is_at_least_0(tendon.friction)) return "must have a friction of at least 0";
  return "";
}

}  // namespace

Vector6d RodSection::stiffness_at(double t) const {
  if (stiffness) return *stiffness;
  const double outer = between(radius, t), inner = between(inner_radius, t);
  const double area = std::numbers::pi * (outer * outer - inner * inner);
  const double second = std::numbers::pi / 4 * (std::pow(outer, 4) - std::pow(inner, 4));
  Vector6d k;
  k << shear_modulus * area, shear_modulus * area, youngs_modulus * area, youngs_modulus * second,
      youngs_modulus * second, shear_modulus * 2 * second;
  return k;
}

double RodSection::mass_per_length_at(double t) const {
  if (mass_per_length) return *mass_per_length;
  const double outer = between(radius, t), inner = between(inner_radius, t);
  return density * std::numbers::pi * (outer * outer - inner * inner);
}

Vector6d RodSection::damping_at(double t) const {
  return damping ? *damping : Vector6d(damping_time * stiffness_at(t));
}

Eigen::Vector3d RodSection::slice_inertia_at(double t) const {
  const double outer = between(radius, t), inner = between(inner_radius, t);
  const double square = mass_per_length_at(t) * (outer * outer + inner * inner);
  return {square / 4, square / 4, square / 2};
}

Vector6d RodSection::rest_strain_at(double t) const {
  Vector6d strain = Vector6d::Zero();
  strain[2] = 1;
  for (std::size_t i = rest_curvature.size(); i-- > 0;) {
    const Eigen::Vector3d next = strain.tail<3>() * t + rest_curvature[i];
    strain.tail<3>() = next;
  }
  return strain;
}

Vector6d RodSection::rest_strain_slope_at(double t) const {
  Vector6d slope = Vector6d::Zero();
  for (std::size_t i = rest_curvature.size(); i-- > 1;) {
    const Eigen::Vector3d next = slope.tail<3>() * t + static_cast<double>(i) * rest_curvature[i];
    slope.tail<3>() = next;
  }
  return slope / length;
}

TendonRoute::Offset TendonRoute::at(double s) const {
  const double a = angle + angle_slope * s, r = radius + radius_slope * s;
  const Eigen::Vector3d out(std::cos(a), std::sin(a), 0), around(-out.y(), out.x(), 0);
  const auto px = polynomial(x, s), py = polynomial(y, s);
  return {.value = r * out + Eigen::Vector3d(px[0], py[0], 0),
          .slope = radius_slope * out + r * angle_slope * around + Eigen::Vector3d(px[1], py[1], 0),
          .second = 2 * radius_slope * angle_slope * around - r * angle_slope * angle_slope * out +
                    Eigen::Vector3d(px[2], py[2], 0)};
}

double Rod::length() const {
  double sum = 0;
  for (const RodSection& section : sections) sum += section.length;
  return sum;
}

std::vector<std::string> rod_problems(const Rod& rod) {
  std::vector<std::string> problems;
  if (rod.sections.empty()) problems.emplace_back("a rod must have a section");
  for (std::size_t i = 0; i < rod.sections.size(); ++i) {
    const std::string problem = section_problem(rod.sections[i]);
    if (!problem.empty()) problems.push_back(fmt::format("section {}: {}", i + 1, problem));
  }
  for (std::size_t i = 0; i < rod.tendons.size(); ++i) {
    const std::string problem = tendon_problem(rod.tendons[i], rod.sections.size());
    if (!problem.empty()) problems.push_back(fmt::format("tendon {}: {}", i + 1, problem));
  }
  return problems;
}

}  // namespace flexura
