#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

#include "flexura/safety/tube.h"

// Shared by the searches for smallest distances (tube_pairs.cc, tube_obstacles.cc).
namespace flexura {

// Limit on the steps of a search. Searches with thousands of steps are rare; the limit prevents an unexpected
// case from exhausting memory.
inline constexpr int most_steps = 200'000;

// A piece of a tube between two fractions of its section.
struct Piece {
  double from = 0;
  double to = 1;
  Eigen::Vector3d start;
  Eigen::Vector3d end;

  [[nodiscard]] double middle() const { return (from + to) / 2; }
  [[nodiscard]] double at(double chord_fraction) const { return from + chord_fraction * (to - from); }
};

inline Piece piece_of(const SectionTube& tube, double from, double to) {
  return {from, to, tube.point(from), tube.point(to)};
}

// Returns a bound on the distance of the backbone from the piece's chord, m.
inline double slack_of(const SectionTube& tube, const Piece& piece) {
  const double part = piece.to - piece.from;
  return tube.length * part * std::min(tube.bend.norm() * part / 8, 0.5);
}

// Priority queue of nodes, the node with the smallest lower bound first.
template <class Node>
class Queue {
 public:
  void push(Node node) {
    nodes_.push_back(std::move(node));
    std::ranges::push_heap(nodes_, later);
  }
  Node pop() {
    std::ranges::pop_heap(nodes_, later);
    Node node = std::move(nodes_.back());
    nodes_.pop_back();
    return node;
  }
  [[nodiscard]] bool empty() const { return nodes_.empty(); }

 private:
  static bool later(const Node& a, const Node& b) { return a.low > b.low; }
  std::vector<Node> nodes_;
};

}  // namespace flexura
