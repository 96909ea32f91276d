#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "flexura/math/se3.h"
#include "flexura/mechanics/rod.h"

namespace flexura {

/// Where a section of a rod is looked at, and what its strain modes are there. Places are parts t of its
/// length. Mode j is a Legendre polynomial of one strain; modes of a strain lie together, by rising degree.
struct RodGrid {
  /// `at`: places, from 0 to 1, that are to be nodes too.
  RodGrid(const RodSection& section, std::span<const double> at);

  /// Of a strain: the first of its modes, and how many it has.
  std::array<int, 6> first{}, count{};
  int size = 0;  ///< Of all modes.

  std::vector<double> t;          ///< Of the nodes, from 0 to 1.
  std::vector<double> weight;     ///< Of the nodes in an integral over t; their sum is 1.
  Eigen::MatrixXd at_node;        ///< Modes x nodes: what each mode is there.
  Eigen::MatrixXd slope_at_node;  ///< The same by arc length, 1/m.
  /// Nodes x nodes: integrals over t up to each node, of what has values at the nodes.
  Eigen::MatrixXd cumulative;
  /// Modes x intervals between nodes: the three moments (magnus_moments) of each mode in each.
  std::array<Eigen::MatrixXd, 3> moments;
  /// At the nodes: of the section, its strain at rest, and that by arc length.
  std::vector<Vector6d> stiffness, rest, rest_slope;
  std::vector<std::array<Vector6d, 3>> rest_moments;  ///< Of that in the intervals.
  std::vector<double> mass_per_length;                ///< At the nodes, kg/m.
  std::vector<std::size_t> disks;       ///< The nodes that are disks, base and end among them; or none.
  std::vector<std::size_t> mass_nodes;  ///< Of the section's point masses.

  /// The section's own length at rest becomes a factor of what it was: its stretch at rest, whatever pulls.
  void stretch_rest(double factor);
  /// The node at t. It is one.
  [[nodiscard]] std::size_t node_at(double place) const;
  /// Where the mode j of strain c is: f(c, j) for all.
  template <typename Function>
  void for_modes(Function&& f) const {
    for (int c = 0; c < 6; ++c) {
      const auto strain = static_cast<std::size_t>(c);
      for (int j = first[strain]; j < first[strain] + count[strain]; ++j) f(c, j);
    }
  }
  /// The strain, or its moment, that modes of the amounts q make beside that at rest; `modes` is a column of
  /// the above.
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
