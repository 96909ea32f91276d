#include "flexura/safety/tube.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "flexura/math/series.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// Thousands are rare; this keeps a case that nobody thought of from filling the memory.
constexpr int most_steps = 200'000;
constexpr int few_steps = 200;
constexpr int few_cuts = 60;  // of an arc before an obstacle, each of which takes longer

// A piece of a tube between two fractions.
struct Piece {
  double from = 0;
  double to = 1;
  Eigen::Vector3d start;
  Eigen::Vector3d end;

  [[nodiscard]] double middle() const { return (from + to) / 2; }
  [[nodiscard]] double at(double chord_fraction) const { return from + chord_fraction * (to - from); }
};

Piece piece_of(const TubeArc& tube, double from, double to) {
  return {from, to, tube.point(from), tube.point(to)};
}

// How far the backbone may be from the chord.
double slack_of(const TubeArc& tube, const Piece& piece) {
  const double part = piece.to - piece.from;
  return tube.length * part * std::min(tube.bend.norm() * part / 8, 0.5);
}

double clamped(double x) { return std::clamp(x, 0.0, 1.0); }

// Two chords as cones: points of either, radii linear between their ends. Their distance less the radii is
// convex in the fractions (x, y).
struct Chords {
  Eigen::Vector3d between;  // from the start of b to that of a
  Eigen::Vector3d along_a;
  Eigen::Vector3d along_b;
  double radius = 0;  // of both at their starts
  double grow_a = 0;  // of the radius from start to end
  double grow_b = 0;
  double x = 0;
  double y = 0;

  // The x in [0, 1] where |p + x along| - grow x is least.
  static double least(const Eigen::Vector3d& p, const Eigen::Vector3d& along, double grow) {
    const double squared = along.squaredNorm();
    if (!(squared > grow * grow)) return grow > 0 ? 1 : 0;
    const double foot = -p.dot(along) / squared;
    const double away = (p + foot * along).norm();
    return clamped(foot + away * grow / std::sqrt(squared * (squared - grow * grow)));
  }
  // Goes towards the least: the nearest points of the axes (Ericson, Real-Time Collision Detection, 5.1.9),
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
  // A convex function is nowhere below its tangent plane: a bound wherever (x, y) is, and close at the least.
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

// Two pieces, and what they cannot come nearer than.
struct PairNode {
  Piece a;
  Piece b;
  double low = 0;
};

// The node of least bound first.
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

class PairSearch {
 public:
  PairSearch(const TubeArc& a, const TubeArc& b, double least_turn, const DistanceWish& wish)
      : a_(a), b_(b), least_turn_(least_turn), enough_(wish.enough), best_(wish.cap) {}

  // Whether the least distance was found, or one below what is enough, within so many steps.
  bool find(int steps) {
    add(piece_of(a_, 0, 1), piece_of(b_, 0, 1));
    for (int step = 0; !open_.empty() && best_ >= enough_; ++step) {
      const PairNode node = open_.pop();
      if (node.low >= best_ - distance_tolerance) break;
      if (step == steps) return false;
      if (slack_of(a_, node.a) >= slack_of(b_, node.b)) {
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
  static std::pair<Piece, Piece> halves(const TubeArc& tube, const Piece& piece) {
    const double middle = piece.middle();
    const Eigen::Vector3d at = tube.point(middle);
    return {{piece.from, middle, piece.start, at}, {middle, piece.to, at, piece.end}};
  }

  void add(const Piece& a, const Piece& b) {
    if (b_.turn_at(b.to) - a_.turn_at(a.from) < least_turn_) return;
    Chords chords{a.start - b.start, a.end - a.start, b.end - b.start};
    chords.radius = a_.radius_at(a.from) + b_.radius_at(b.from);
    chords.grow_a = a_.radius_at(a.to) - a_.radius_at(a.from);
    chords.grow_b = b_.radius_at(b.to) - b_.radius_at(b.from);
    chords.approach();
    const double low = chords.bound() - slack_of(a_, a) - slack_of(b_, b);
    if (low >= best_ - distance_tolerance) return;
    const double u = a.at(chords.x);
    const double v = b.at(chords.y);
    // The nearest points of the chords show where to look; the outer ends always turn enough.
    try_pair(u, v);
    try_pair(a.from, v);
    try_pair(u, b.to);
    try_pair(a.from, b.to);
    open_.push({a, b, low});
  }

  void try_pair(double u, double v) {
    if (b_.turn_at(v) - a_.turn_at(u) < least_turn_) return;
    best_ = std::min(best_, (a_.point(u) - b_.point(v)).norm() - a_.radius_at(u) - b_.radius_at(v));
  }

  const TubeArc& a_;
  const TubeArc& b_;
  double least_turn_;
  double enough_;
  double best_;
  Queue<PairNode> open_;
};

struct Least {
  double value = 0;  // below the least by no more than a part of the tolerance
  double at = 0;     // fraction of the chord
};

// The least distance from a piece's chord, less the tube's radius, to an obstacle: golden section search,
// which finds the minimum of a convex function. The value changes no faster than place and radius, so what is
// left of the interval says how wrong it may be.
Least least(const TubeArc& tube, const Piece& piece, const Obstacle& obstacle) {
  constexpr double golden = 0.6180339887498949;
  const double radius = tube.radius_at(piece.from);
  const double grow = tube.radius_at(piece.to) - radius;
  const auto value = [&](double x) {
    return obstacle.distance(piece.start + x * (piece.end - piece.start)) - radius - x * grow;
  };
  const double rate = (piece.end - piece.start).norm() + std::abs(grow);
  double low = 0;
  double high = 1;
  double x = high - golden;
  double y = golden;
  double at_x = value(x);
  double at_y = value(y);
  while ((high - low) * rate > distance_tolerance / 4) {
    if (at_x <= at_y) {
      high = y, y = x, at_y = at_x;
      x = high - golden * (high - low);
      at_x = value(x);
    } else {
      low = x, x = y, at_x = at_y;
      y = low + golden * (high - low);
      at_y = value(y);
    }
  }
  return {std::min(at_x, at_y) - (high - low) * rate, (low + high) / 2};
}

struct ObstacleNode {
  Piece piece;
  double low = 0;
};

class ObstacleSearch {
 public:
  ObstacleSearch(const TubeArc& tube, const Obstacle& obstacle, const DistanceWish& wish)
      : tube_(tube), obstacle_(obstacle), enough_(wish.enough), best_(wish.cap) {}

  // As PairSearch::find.
  bool find(double from, int steps) {
    if (from > 1) return true;
    if (obstacle_.normal) {
      find_on_plane(from);
      return true;
    }
    add(piece_of(tube_, from, 1));
    for (int step = 0; !open_.empty() && best_ >= enough_; ++step) {
      const ObstacleNode node = open_.pop();
      if (node.low >= best_ - distance_tolerance) break;
      if (step == steps) return false;
      add(piece_of(tube_, node.piece.from, node.piece.middle()));
      add(piece_of(tube_, node.piece.middle(), node.piece.to));
    }
    return true;
  }
  [[nodiscard]] double best() const { return best_; }

 private:
  void try_at(double u) { best_ = std::min(best_, obstacle_.distance(tube_.point(u)) - tube_.radius_at(u)); }

  void add(const Piece& piece) {
    const double slack = slack_of(tube_, piece);
    const double reach = (piece.end - piece.start).norm() / 2;
    const double radius = std::max(tube_.radius_at(piece.from), tube_.radius_at(piece.to));
    const double rough = obstacle_.distance((piece.start + piece.end) / 2) - reach - radius - slack;
    if (rough >= best_ - distance_tolerance) return;
    const Least chord = least(tube_, piece, obstacle_);
    try_at(piece.at(chord.at));
    if (chord.value - slack < best_ - distance_tolerance) open_.push({piece, chord.value - slack});
  }

  // Along an arc that has turned by t so far the distance to a plane changes by (length / turn) size sin(t +
  // phase) per rad, the radius by grow / turn: the difference is least at an end, or where both are the same.
  // From one such place to the next, 2 pi further on, it changes by the same amount, so that the first and
  // the last will do.
  void find_on_plane(double from) {
    try_at(from);
    try_at(1);
    const double turn = tube_.bend.norm();
    if (turn == 0) return;
    const Eigen::Vector3d normal = tube_.X_WS.rotation.transpose() * *obstacle_.normal;
    const double inward = normal.head<2>().dot(tube_.bend) / turn;
    const double size = tube_.length * std::hypot(inward, normal.z());
    const double grow = tube_.radius[1] - tube_.radius[0];
    if (!(size > std::abs(grow))) return;
    // Where the slope goes up through `grow`: on the rising half of the sine.
    const double place = std::asin(grow / size) - std::atan2(normal.z(), inward);
    constexpr double round = 2 * std::numbers::pi;
    const double first = place + round * std::ceil((from * turn - place) / round);
    const double last = place + round * std::floor((turn - place) / round);
    try_at(std::clamp(first / turn, from, 1.0));
    try_at(std::clamp(last / turn, from, 1.0));
  }

  const TubeArc& tube_;
  const Obstacle& obstacle_;
  double enough_;
  double best_;
  Queue<ObstacleNode> open_;
};

}  // namespace

Eigen::Vector3d TubeArc::point(double u) const {
  const Eigen::Vector2d part = bend * u;
  const double t = part.norm();
  const Eigen::Vector2d across = cosc(t) * part;
  return X_WS.position + (length * u) * (X_WS.rotation * Eigen::Vector3d(across.x(), across.y(), sinc(t)));
}

std::vector<TubeArc> tube_arcs(const Arm& arm, const ArmState& state) {
  const Backbone backbone(arm, state);
  std::vector<TubeArc> tubes;
  tubes.reserve(arm.sections.size());
  double turn = 0;
  for (const Arc& arc : backbone.arcs()) {
    tubes.push_back({arc.X_WS, arc.bend, arc.length, arm.sections[tubes.size()].radius, turn});
    turn += arc.bend.norm();
  }
  return tubes;
}

double tube_distance(const TubeArc& a, const TubeArc& b, double least_turn, double cap) {
  PairSearch search(a, b, least_turn, {.cap = cap});
  (void)search.find(most_steps);
  return search.best();
}

bool stay_apart(const TubeArc& a, const TubeArc& b, double least_turn, double distance) {
  PairSearch search(a, b, least_turn, {distance, distance});
  return search.find(few_steps) && search.best() >= distance;
}

bool come_within(const TubeArc& a, const TubeArc& b, double least_turn, double distance) {
  PairSearch search(a, b, least_turn, {distance, distance});
  return search.find(few_steps) && search.best() < distance;
}

double obstacle_distance(const TubeArc& tube, double from, const Obstacle& obstacle,
                         const DistanceWish& wish) {
  ObstacleSearch search(tube, obstacle, wish);
  (void)search.find(from, most_steps);
  return search.best();
}

bool stays_clear(const TubeArc& tube, double from, const Obstacle& obstacle, double distance) {
  ObstacleSearch search(tube, obstacle, {distance, distance});
  return search.find(from, few_cuts) && search.best() >= distance;
}

bool comes_within(const TubeArc& tube, double from, const Obstacle& obstacle, double distance) {
  ObstacleSearch search(tube, obstacle, {distance, distance});
  return search.find(from, few_cuts) && search.best() < distance;
}

}  // namespace flexura
