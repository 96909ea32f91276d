#include "flexura/mechanics/rod_grid.h"

#include <algorithm>
#include <cmath>

#include "flexura/math/magnus.h"
#include "flexura/math/quadrature.h"

namespace flexura {
namespace {

constexpr double same_place = 1e-9;

// With fewer nodes modes cannot be distinguished, and the integration of loads is too coarse.
int nodes_needed(const std::array<int, 6>& counts) {
  return std::max(5, *std::ranges::max_element(counts) + 2);
}

}  // namespace

RodGrid::RodGrid(const RodSection& section, std::span<const double> at) : count(section.modes.counts()) {
  for (std::size_t c = 0; c < 6; ++c) {
    first[c] = size;
    size += count[c];
  }

  const Quadrature rule = gauss_lobatto(section.nodes > 0 ? section.nodes : nodes_needed(count));
  struct Node {
    double t, weight;
  };
  std::vector<Node> nodes;
  nodes.reserve(rule.nodes.size());
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    nodes.push_back({0.5 * (rule.nodes[i] + 1), 0.5 * rule.weights[i]});
  const auto add = [&](double place) {
    if (std::ranges::none_of(nodes, [&](const Node& n) { return std::abs(n.t - place) < same_place; }))
      nodes.push_back({place, 0});
  };
  for (const double place : at) add(place);
  for (const PointMass& mass : section.masses) add(mass.at);
  for (int i = 1; i < section.disks; ++i) add(static_cast<double>(i) / section.disks);
  std::ranges::sort(nodes, {}, &Node::t);
  for (const Node& node : nodes) {
    t.push_back(node.t);
    weight.push_back(node.weight);
  }

  const auto modes_at = [&](double place) {
    Eigen::VectorXd modes(size);
    for_modes(
        [&](int c, int j) { modes[j] = legendre(j - first[static_cast<std::size_t>(c)], 2 * place - 1); });
    return modes;
  };
  at_node.resize(size, static_cast<Eigen::Index>(t.size()));
  slope_at_node.resize(size, static_cast<Eigen::Index>(t.size()));
  for (std::size_t k = 0; k < t.size(); ++k) {
    at_node.col(static_cast<Eigen::Index>(k)) = modes_at(t[k]);
    for_modes([&](int c, int j) {
      const int degree = j - first[static_cast<std::size_t>(c)];
      slope_at_node(j, static_cast<Eigen::Index>(k)) =
          2 / section.length * legendre_slope(degree, 2 * t[k] - 1);
    });
    stiffness.push_back(section.stiffness_at(t[k]));
    rest_slope.push_back(section.rest_strain_slope_at(t[k]));
    rest.push_back(section.rest_strain_at(t[k]));
    mass_per_length.push_back(section.mass_per_length_at(t[k]));
  }
  const std::array<double, 3> points = magnus_points();
  for (Eigen::MatrixXd& moment : moments) moment.resize(size, static_cast<Eigen::Index>(t.size()) - 1);
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double part = t[i + 1] - t[i], h = part * section.length;
    std::array<double, 3> at_gauss{};
    for (std::size_t g = 0; g < 3; ++g) at_gauss[g] = t[i] + points[g] * part;
    const auto of_modes =
        magnus_moments(h, modes_at(at_gauss[0]), modes_at(at_gauss[1]), modes_at(at_gauss[2]));
    for (std::size_t m = 0; m < 3; ++m) moments[m].col(static_cast<Eigen::Index>(i)) = of_modes[m];
    rest_moments.push_back(magnus_moments(h, section.rest_strain_at(at_gauss[0]),
                                          section.rest_strain_at(at_gauss[1]),
                                          section.rest_strain_at(at_gauss[2])));
  }
  integrate_nodes();
  for (const PointMass& mass : section.masses) mass_nodes.push_back(node_at(mass.at));
  for (int i = 0; section.disks > 0 && i <= section.disks; ++i)
    disks.push_back(node_at(static_cast<double>(i) / section.disks));
}

void RodGrid::stretch_rest(double factor) {
  constexpr int stretch = 2;
  const double change = factor - rest.front()[stretch];
  if (change == 0) return;
  for (Vector6d& strain : rest) strain[stretch] = factor;
  // The first moment is an integral over arc length, so it is proportional to a constant strain.
  for (auto& of_interval : rest_moments) of_interval[0][stretch] *= factor / (factor - change);
}

void RodGrid::integrate_nodes() {
  // Lagrange polynomials of the nodes used in integrals.
  const auto nodes = static_cast<Eigen::Index>(t.size());
  cumulative.setZero(nodes, nodes);
  std::vector<std::size_t> counting;
  for (std::size_t m = 0; m < t.size(); ++m)
    if (weight[m] != 0) counting.push_back(m);
  const Quadrature rule = gauss_legendre(static_cast<int>(counting.size()));
  for (std::size_t k = 1; k < t.size(); ++k) {
    for (const std::size_t m : counting) {
      const auto lagrange = [&](double at) {
        double product = 1;
        for (const std::size_t i : counting)
          if (i != m) product *= (at - t[i]) / (t[m] - t[i]);
        return product;
      };
      cumulative(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(m)) =
          integrate(rule, lagrange, 0, t[k]);
    }
  }
}

std::size_t RodGrid::node_at(double place) const {
  const auto nearest =
      std::ranges::min_element(t, {}, [place](double each) { return std::abs(each - place); });
  return static_cast<std::size_t>(nearest - t.begin());
}

}  // namespace flexura
