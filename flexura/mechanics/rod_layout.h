#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "flexura/math/screw.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_grid.h"

namespace flexura {

/// What does not change while a rod moves: its grid, with numbers of the same kind of all intervals side by
/// side, the bodies at its nodes and the ways of its tendons.
struct RodLayout {
  /// A body at a node.
  struct Body {
    double mass = 0;  ///< kg
    /// Of its centre of mass in the section's frame, m.
    Triple<double> centre{};
    /// About that, by rows, kg m^2.
    std::array<Triple<double>, 3> inertia{};
  };
  /// Where a tendon passes a node.
  struct Passage {
    Triple<double> offset{}, slope{};
  };
  struct Section {
    RodGrid grid;
    double length = 0;
    std::size_t first_mode = 0, first_interval = 0, first_node = 0, first_moment = 0;
    std::size_t modes = 0, intervals = 0;
    std::vector<std::size_t> strain = {};          ///< Of each mode.
    Eigen::MatrixXd stiffness = {}, damping = {};  ///< modes x modes.
    std::vector<std::size_t> tendons = {};         ///< That run through it.
    std::vector<Passage> passages = {};            ///< Tendons x nodes, a tendon's after each other.
    std::vector<std::size_t> disks = {};           ///< Nodes of the section.
  };

  RodLayout(const Rod& rod, const std::vector<RodGrid>& grids, bool rotary_inertia);

  std::vector<Section> sections;
  std::size_t modes = 0, intervals = 0, nodes = 0, tendons = 0;
  std::size_t padded = 0;  ///< Intervals, a multiple of what one instruction takes.
  std::vector<Body> bodies;
  std::vector<double> run;  ///< Of the nodes: metres of rod for each in an integral along it.
  /// 18 x padded: of the three moments of the six strains at rest.
  std::vector<double> rest;
  /// Of each moment m: of the modes of all sections, each in the intervals of its section.
  std::array<std::vector<double>, 3> moments;
};

}  // namespace flexura
