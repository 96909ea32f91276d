#include <algorithm>
#include <cmath>
#include <utility>

#include "flexura/safety/tube_pieces.h"

namespace flexura {
namespace {

constexpr int few_steps = 200;

double clamped(double x) { return std::clamp(x, 0.0, 1.0); }

// Two chords as cones: points on both, radii linear between their ends. Their distance minus the radii is
// convex in the fractions (x, y).
struct Chords {
  Eigen::Vector3d between;  // From the start of b to that of a.
  Eigen::Vector3d along_a;
  Eigen::Vector3d along_b;
  double radius = 0;  // Sum of both at their starts.
  double grow_a = 0;  // Change of the radius from start to end.
  double grow_b = 0;
  double x = 0;
  double y = 0;

  // Returns the x in [0, 1] that minimizes |p + x along| - grow x.
  static double least(const Eigen::Vector3d& p, const Eigen::Vector3d& along, double grow) {
    const double squared = along.squaredNorm();
    if (!(squared > grow * grow)) return grow > 0 ? 1 : 0;
    const double foot = -p.dot(along) / squared;
    const double away = (p + foot * along).norm();
    return clamped(foot + away * grow / std::sqrt(squared * (squared - grow * grow)));
  }
  // Approaches the minimum: the nearest points of the axes (Ericson, Real-Time Collision Detection, 5.1.9),
  // then along each in turn.
  void approach() {
    const double aa = along_a.squaredNorm();
    const double ab = along_a.dot(along_b);
    const double bb = along_b.squaredNorm();
    const double determinant = aa * bb - ab * ab;
    if (determinant > 0) x = clamped((ab * along_b.dot(between) - along_a.dot(between) * bb) / determinant);
    const int turns = grow_a == 0 && grow_b == 0 ? 1 : 3;
    for (int k = 0; k < turns; ++k) {
      y = least(-between - x * along_a, along_b, grow_b);
      x = least(between - y * along_b, along_a, grow_a);
    }
  }
  // Returns a lower bound: a convex function is never below its tangent plane. Valid for any (x, y), and
  // tight at the minimum.
  [[nodiscard]] double bound() const {
    const Eigen::Vector3d apart = between + x * along_a - y * along_b;
    const double distance = apart.norm();
    if (distance == 0) return -radius - std::max(grow_a, 0.0) - std::max(grow_b, 0.0);
    const double slope_x = apart.dot(along_a) / distance - grow_a;
    const double slope_y = -apart.dot(along_b) / distance - grow_b;
    return distance - radius - x * grow_a - y * grow_b + std::min(-x * slope_x, (1 - x) * slope_x) +
           std::min(-y * slope_y, (1 - y) * slope_y);
  }
};

// Two pieces, and a lower bound on their distance.
struct PairNode {
  Piece a;
  Piece b;
  double low = 0;
};

class PairSearch {
 public:
  PairSearch(const SectionTube& a, const SectionTube& b, const PairRule& rule, const DistanceQuery& query)
      : a_(a), b_(b), rule_(rule), enough_(query.enough), best_(query.cap) {}

  // Returns true if the least distance, or one below `enough`, was found within this number of steps.
  bool find(int steps) {
    add(piece_of(a_, 0, 1), piece_of(b_, 0, 1));
    for (int step = 0; !open_.empty() && best_ >= enough_; ++step) {
      const PairNode node = open_.pop();
      if (node.low >= best_ - distance_tolerance) break;
      if (step == steps) return false;
      if (halves_first(node)) {
        const auto [first, second] = halves(a_, node.a);
        add(first, node.b);
        add(second, node.b);
      } else {
        const auto [first, second] = halves(b_, node.b);
        add(node.a, first);
        add(node.a, second);
      }
    }
    return true;
  }
  [[nodiscard]] double best() const { return best_; }

 private:
  static std::pair<Piece, Piece> halves(const SectionTube& tube, const Piece& piece) {
    const double middle = piece.middle();
    const Eigen::Vector3d at = tube.point(middle);
    return {{piece.from, middle, piece.start, at}, {middle, piece.to, at, piece.end}};
  }

  // Returns true if some pair of points of the pieces may count.
  [[nodiscard]] bool may_count(const Piece& a, const Piece& b) const {
    if (b_.turn_at(b.to) - a_.turn_at(a.from) >= rule_.turn) return true;
    // The gap is linear in either fraction.
    return std::max(beyond(b.from), beyond(b.to)) - std::min(reach(a.from), reach(a.to)) >= rule_.gap;
  }
  [[nodiscard]] bool counts(double u, double v) const {
    return b_.turn_at(v) - a_.turn_at(u) >= rule_.turn || beyond(v) - reach(u) >= rule_.gap;
  }
  // Returns true if all pairs count by their gap, or all by their turn.
  [[nodiscard]] bool all_count(const PairNode& node) const {
    return b_.turn_at(node.b.from) - a_.turn_at(node.a.to) >= rule_.turn ||
           std::min(beyond(node.b.from), beyond(node.b.to)) -
                   std::max(reach(node.a.from), reach(node.a.to)) >=
               rule_.gap;
  }
  // reach() returns how far along the arm the neighbours of a point of `a` extend, as far as this depends on
  // the point. beyond() returns where those of a point of `b` begin.
  [[nodiscard]] double reach(double u) const { return a_.arc_at(u) + a_.girth_at(u); }
  [[nodiscard]] double beyond(double v) const { return b_.arc_at(v) - b_.girth_at(v); }

  // Returns true if `a` is to be halved: the piece with the larger distance from its chord, or the longer one
  // while pairs still have to be separated from neighbours.
  [[nodiscard]] bool halves_first(const PairNode& node) const {
    if (rule_.gap < no_distance && !all_count(node))
      return a_.length * (node.a.to - node.a.from) >= b_.length * (node.b.to - node.b.from);
    return slack_of(a_, node.a) >= slack_of(b_, node.b);
  }

  void add(const Piece& a, const Piece& b) {
    if (!may_count(a, b)) return;
    Chords chords{a.start - b.start, a.end - a.start, b.end - b.start};
    chords.radius = a_.radius_at(a.from) + b_.radius_at(b.from);
    chords.grow_a = a_.radius_at(a.to) - a_.radius_at(a.from);
    chords.grow_b = b_.radius_at(b.to) - b_.radius_at(b.from);
    chords.approach();
    // No pair is deeper than two points at one place, which is soon found for a tube that crosses itself.
    const double deepest = -std::max(a_.radius_at(a.from), a_.radius_at(a.to)) -
                           std::max(b_.radius_at(b.from), b_.radius_at(b.to));
    const double low = std::max(chords.bound() - slack_of(a_, a) - slack_of(b_, b), deepest);
    if (low >= best_ - distance_tolerance) return;
    const double u = a.at(chords.x);
    const double v = b.at(chords.y);
    // Starts at the nearest points of the chords; the outer ends are farthest along the arm.
    try_pair(u, v);
    try_pair(a.from, v);
    try_pair(u, b.to);
    try_pair(a.from, b.to);
    open_.push({a, b, low});
  }

  void try_pair(double u, double v) {
    if (!counts(u, v)) return;
    best_ = std::min(best_, (a_.point(u) - b_.point(v)).norm() - a_.radius_at(u) - b_.radius_at(v));
  }

  const SectionTube& a_;
  const SectionTube& b_;
  PairRule rule_;
  double enough_;
  double best_;
  Queue<PairNode> open_;
};

}  // namespace

double tube_distance(const SectionTube& a, const SectionTube& b, const PairRule& rule,
                     const DistanceQuery& query) {
  PairSearch search(a, b, rule, query);
  (void)search.find(most_steps);
  return search.best();
}

bool stay_apart(const SectionTube& a, const SectionTube& b, const PairRule& rule, double distance) {
  PairSearch search(a, b, rule, {distance, distance});
  return search.find(few_steps) && search.best() >= distance;
}

bool come_within(const SectionTube& a, const SectionTube& b, const PairRule& rule, double distance) {
  PairSearch search(a, b, rule, {distance, distance});
  return search.find(few_steps) && search.best() < distance;
}

}  // namespace flexura
