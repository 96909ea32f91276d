#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
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
  /// Where a tendon passes a node: its offset in the cross-section and the derivatives of that by arc length.
  struct Passage {
    Triple<double> offset{}, slope{}, second{};
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

  /// A piece of a tendon that rubs, in which its tension is one number: around a node of a channel, or
  /// between two disks. Between a piece and the one before it friction holds the tendon.
  struct Piece {
    std::size_t section = 0;
    std::size_t at = 0;  ///< The node of the section, or the number of the chord between its disks.
    double run = 0;      ///< Metres of rod for which it stands.
    double held = 0;     ///< Metres of rod between its middle and that of the one before; 0 of the first.
  };
  /// A tendon that rubs.
  struct Rubbing {
    std::size_t tendon = 0;
    double friction = 0;
    std::size_t first = 0;           ///< Of its pieces among those of all tendons that rub.
    std::vector<Piece> pieces = {};  ///< From the base on.
  };

  RodLayout(const Rod& rod, const std::vector<RodGrid>& grids, bool rotary_inertia);

  /// Each section's own length at rest becomes a factor of what the rod says, that changes at a rate, 1/s;
  /// one of both a section (RodChain::stretch_rest).
  void stretch_rest(std::span<const double> factors, std::span<const double> factor_rates);

  std::vector<Section> sections;
  std::size_t modes = 0, intervals = 0, nodes = 0, tendons = 0;
  std::size_t padded = 0;  ///< Intervals, a multiple of what one instruction takes.
  std::vector<Body> bodies;
  std::vector<double> run;  ///< Of the nodes: metres of rod for each in an integral along it.
  /// 18 x padded: of the three moments of the six strains at rest.
  std::vector<double> rest;
  /// Of each moment m: of the modes of all sections, each in the intervals of its section.
  std::array<std::vector<double>, 3> moments;
  std::vector<Rubbing> rubbing;   ///< Tendons without friction are not there.
  std::size_t pieces = 0;         ///< Of all of these.
  std::vector<double> stretches;  ///< How fast each section's length at rest changes, parts of it a second.
  bool is_driven = false;         ///< Any does.

 private:
  void find_rubbing(const Rod& rod);
};

}  // namespace flexura
