#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "flexura/safety/tube_pieces.h"

namespace flexura {
namespace {

constexpr int few_cuts = 60;  // Largest number of subdivisions of an arc near an obstacle. Each takes longer
                              // than a subdivision for a pair.

struct Least {
  double value = 0;  // Below the least by at most a part of the tolerance.
  double at = 0;     // Fraction of the chord.
};

// Returns the least distance from a piece's chord, minus the tube's radius, to an obstacle. Golden section
// search finds the minimum of a convex function. The value changes no faster than position and radius, so the
// rest of the interval bounds the error.
Least least(const SectionTube& tube, const Piece& piece, const Obstacle& obstacle) {
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

// Returns where the part of a tube between two fractions may be lowest along a normal: its ends, or points
// between. Consider an arc that has turned by t. Its height changes by (length / turn) size sin(t + phase)
// per rad, the radius by grow / turn. The difference is least at an end, or where both rates are equal. From
// one such point to the next, 2 pi further on, it changes by the same amount, so the first and the last
// suffice.
std::array<double, 4> lowest_places(const SectionTube& tube, const Eigen::Vector3d& normal_W, double from,
                                    double to) {
  const double turn = tube.bend.norm();
  if (turn == 0) return {from, to, from, to};
  const Eigen::Vector3d normal = tube.X_WS.rotation.transpose() * normal_W;
  const double inward = normal.head<2>().dot(tube.bend) / turn;
  const double size = tube.length * std::hypot(inward, normal.z());
  const double grow = tube.radius[1] - tube.radius[0];
  if (!(size > std::abs(grow))) return {from, to, from, to};
  // The slope increases through `grow`: on the rising half of the sine.
  const double place = std::asin(grow / size) - std::atan2(normal.z(), inward);
  constexpr double round = 2 * std::numbers::pi;
  const double first = place + round * std::ceil((from * turn - place) / round);
  const double last = place + round * std::floor((to * turn - place) / round);
  return {from, to, std::clamp(first / turn, from, to), std::clamp(last / turn, from, to)};
}

struct ObstacleNode {
  Piece piece;
  double low = 0;
};

class ObstacleSearch {
 public:
  ObstacleSearch(const SectionTube& tube, const Obstacle& obstacle, const DistanceQuery& query)
      : tube_(tube), obstacle_(obstacle), enough_(query.enough), best_(query.cap) {}

  // Like PairSearch::find.
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
    // A piece flat on a side has the same distance throughout: its chord need not be distinguished from its
    // arc.
    double low = -no_distance;
    for (const Obstacle::Side& side : obstacle_.sides) low = std::max(low, above_side(piece, side));
    if (low >= best_ - distance_tolerance) return;
    const Least chord = least(tube_, piece, obstacle_);
    try_at(piece.at(chord.at));
    low = std::max(low, chord.value - slack);
    if (low < best_ - distance_tolerance) open_.push({piece, low});
  }

  // Returns the smallest height of the piece above the plane of a side.
  [[nodiscard]] double above_side(const Piece& piece, const Obstacle::Side& side) const {
    double least = no_distance;
    for (const double u : lowest_places(tube_, side.normal, piece.from, piece.to))
      least = std::min(least, side.normal.dot(tube_.point(u)) - side.offset - tube_.radius_at(u));
    return least;
  }

  void find_on_plane(double from) {
    for (const double u : lowest_places(tube_, *obstacle_.normal, from, 1)) try_at(u);
  }

  const SectionTube& tube_;
  const Obstacle& obstacle_;
  double enough_;
  double best_;
  Queue<ObstacleNode> open_;
};

}  // namespace

double obstacle_distance(const SectionTube& tube, double from, const Obstacle& obstacle,
                         const DistanceQuery& query) {
  ObstacleSearch search(tube, obstacle, query);
  (void)search.find(from, most_steps);
  return search.best();
}

bool stays_clear(const SectionTube& tube, double from, const Obstacle& obstacle, double distance) {
  ObstacleSearch search(tube, obstacle, {distance, distance});
  return search.find(from, few_cuts) && search.best() >= distance;
}

bool comes_within(const SectionTube& tube, double from, const Obstacle& obstacle, double distance) {
  ObstacleSearch search(tube, obstacle, {distance, distance});
  return search.find(from, few_cuts) && search.best() < distance;
}

}  // namespace flexura
