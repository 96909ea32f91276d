#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "flexura/math/se3.h"
#include "flexura/mechanics/rod.h"

namespace flexura {

/// Nodes of a section and the values of its strain modes there. Positions are fractions t of the section's
/// length. Mode j is a Legendre polynomial of one strain. Modes of one strain are adjacent, in the order of
/// their degrees.
struct RodGrid {
  /// `at`: further positions, from 0 to 1, that become nodes.
  RodGrid(const RodSection& section, std::span<const double> at);

  /// For each strain: index of its first mode, and number of modes.
  std::array<int, 6> first{}, count{};
  int size = 0;  ///< Number of all modes.

  std::vector<double> t;          ///< Positions of the nodes, from 0 to 1.
  std::vector<double> weight;     ///< Quadrature weights of the nodes in an integral over t; the sum is 1.
  Eigen::MatrixXd at_node;        ///< Modes x nodes: value of each mode.
  Eigen::MatrixXd slope_at_node;  ///< Modes x nodes: derivative of each mode with respect to arc length, 1/m.
  /// Matrix, nodes x nodes, that integrates nodal values over t from 0 to each node.
  Eigen::MatrixXd cumulative;
  /// Modes x intervals between nodes: the three moments (magnus_moments) of each mode in each interval.
  std::array<Eigen::MatrixXd, 3> moments;
  /// At the nodes: stiffness, undeformed strain, and its derivative with respect to arc length.
  std::vector<Vector6d> stiffness, rest, rest_slope;
  std::vector<std::array<Vector6d, 3>> rest_moments;  ///< Moments of the undeformed strain in the intervals.
  std::vector<double> mass_per_length;                ///< At the nodes, kg/m.
  std::vector<std::size_t>
      disks;  ///< Indices of the nodes at disks, including base and end; empty without disks.
  std::vector<std::size_t> mass_nodes;  ///< Indices of the nodes with the section's point masses.

  /// Multiplies the section's original undeformed length by this factor, through its undeformed stretch.
  void stretch_rest(double factor);
  /// Returns the index of the node at the position `place`, 0 to 1, at which a node must exist.
  [[nodiscard]] std::size_t node_at(double place) const;
  /// Calls f(c, j) for each mode j of each strain c.
  template <typename Function>
  void for_modes(Function&& f) const {
    for (int c = 0; c < 6; ++c) {
      const auto strain = static_cast<std::size_t>(c);
      for (int j = first[strain]; j < first[strain] + count[strain]; ++j) f(c, j);
    }
  }
  /// Returns the strain for the mode values q, or a moment of this strain. `at_rest` is the undeformed value,
  /// and `modes` a column of `at_node` or `moments`.
  template <typename Column>
  [[nodiscard]] Vector6d strain(const Vector6d& at_rest, const Eigen::VectorXd& q,
                                const Column& modes) const {
    Vector6d sum = at_rest;
    for_modes([&](int c, int j) { sum[c] += q[j] * modes[j]; });
    return sum;
  }

 private:
  void integrate_nodes();
};

}  // namespace flexura
