#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/screw.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/rod_grid.h"
#include "flexura/mechanics/rod_parts.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// Constant data of a moving rod: its grid, the bodies at its nodes and the paths of its tendons. The same
/// quantity of all intervals is stored contiguously.
struct RodLayout {
  /// A body at a node.
  struct Body {
    double mass = 0;  ///< kg
    /// Centre of mass in the frame of the cross-section, m.
    Triple<double> centre{};
    /// Inertia about the centre of mass, in row-major order, kg m^2.
    std::array<Triple<double>, 3> inertia{};
  };
  /// Passage of a tendon at a node: its offset in the cross-section and the derivatives with respect to arc
  /// length.
  struct Passage {
    Triple<double> offset{}, slope{}, second{};
  };
  /// Constant data of an element of the rod (RodChain).
  struct Section {
    RodPart part;
    RodGrid grid;
    double length = 0;
    std::size_t first_mode = 0, first_interval = 0, first_node = 0, first_moment = 0;
    std::size_t modes = 0, intervals = 0;
    std::vector<std::size_t> strain = {};          ///< Strain of each mode.
    Eigen::MatrixXd stiffness = {}, damping = {};  ///< modes x modes.
    std::vector<std::size_t> tendons = {};         ///< Indices of tendons that run through the section.
    std::vector<Passage> passages = {};            ///< Passages, tendons x nodes, stored tendon by tendon.
    std::vector<std::size_t> disks = {};           ///< Indices of the nodes at disks.
  };

  /// A piece of a tendon with friction in which the tension is constant: around a node of a channel, or
  /// between two disks. Friction acts between a piece and the previous piece.
  struct Piece {
    std::size_t section = 0;
    std::size_t at = 0;  ///< Node of the section, or number of the chord between its disks.
    double run = 0;      ///< Length of rod that the piece represents, m.
    /// Length of rod between the middles of this piece and of the previous piece, m; 0 for the first piece.
    double held = 0;
  };
  /// A tendon with friction.
  struct Rubbing {
    std::size_t tendon = 0;
    double friction = 0;
    std::size_t first = 0;  ///< Index of the tendon's first piece among all pieces of tendons with friction.
    std::vector<Piece> pieces = {};  ///< Pieces, in the order from base to end.
  };

  RodLayout(const RodChain& chain, bool rotary_inertia);

  /// The following functions return the index of the element that contains a place, and the index among all
  /// nodes of the node at a place. Both functions throw std::invalid_argument for a place outside the rod.
  /// node_of() also throws std::invalid_argument if no node is at the place.
  [[nodiscard]] std::size_t element_of(const RodPlace& place) const;
  [[nodiscard]] std::size_t node_of(const RodPlace& place) const;

  /// Multiplies the undeformed length of each section of the rod by a factor that changes at a rate, 1/s
  /// (RodChain::stretch_rest). Both lists have one number per section of the rod.
  void stretch_rest(std::span<const double> factors, std::span<const double> factor_rates);

  std::vector<Section> sections;
  std::vector<std::size_t> ends;  ///< Index of the last element of each section of the rod.
  std::size_t modes = 0, intervals = 0, nodes = 0, tendons = 0;
  std::size_t padded = 0;  ///< Number of intervals, rounded up to a multiple of an instruction's lanes.
  std::vector<Body> bodies;
  std::vector<Body> slices;  ///< Bodies at the nodes without point masses: only the slices of the rod.
  std::vector<double> run;   ///< Length of rod that each node represents in an integral along the rod, m.
  /// 18 x padded: the three moments of the six undeformed strains.
  std::vector<double> rest;
  /// The three moments of each mode of all sections, in each interval of the mode's section.
  std::array<std::vector<double>, 3> moments;
  std::vector<Rubbing> rubbing;   ///< Tendons with friction.
  std::size_t pieces = 0;         ///< Number of pieces of all tendons in `rubbing`.
  std::vector<double> stretches;  ///< Relative rate of change of each element's undeformed length, 1/s.
  bool is_driven = false;         ///< Whether any entry of `stretches` is not 0.

 private:
  void find_rubbing(const Rod& rod);
};

}  // namespace flexura
