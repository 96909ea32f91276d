#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "flexura/model/backbone.h"
#include "flexura/model/obstacle.h"

namespace flexura {

/// A brute-force reference for contact checks: the arm's tubes as points, without bounds or shortcuts. Every
/// clearance found here occurs, so every contact found here is real.
class SampledArm {
 public:
  SampledArm(const Arm& arm, const ArmState& state) : arm_(arm), backbone_(arm, state) {
    double turn = 0;
    double length = 0;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      turns_.push_back(turn);
      lengths_.push_back(length);
      length += backbone_.arcs()[i].length;
      turn += backbone_.arcs()[i].bend.norm();
      for (int k = 0; k <= cuts; ++k) points_.push_back(point(i, fraction(k)));
    }
  }

  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const { return points_; }

  /// Returns the clearance of section i to an obstacle, m. It is exact to rounding if below `need`; otherwise
  /// the true one is not below `need` either.
  [[nodiscard]] double clearance(std::size_t i, const Obstacle& obstacle, double need) const {
    const auto at = [&](double u) { return obstacle.distance(point(i, u)) - radius(i, u); };
    int best = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= cuts; ++k) {
      const double now = obstacle.distance(points_[index(i, k)]) - radius(i, fraction(k));
      if (now < nearest) nearest = now, best = k;
    }
    if (nearest - spacing(i) >= need) return nearest;
    return descended([&](double u, double) { return at(u); }, fraction(best), 0, nearest);
  }

  /// Returns the clearance of the arm to itself over all sections, m.
  [[nodiscard]] double clearance(double need) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      for (std::size_t j = i; j < turns_.size(); ++j) least = std::min(least, clearance(i, j, need));
    }
    return least;
  }

  /// Returns the clearance between the sections i and j >= i, m, over points that are not neighbours;
  /// accuracy as above. The backbone between such points has half a turn or more. If a section between them
  /// is thinner, it is instead longer than half a circle of their mean radius.
  [[nodiscard]] double clearance(std::size_t i, std::size_t j, double need) const {
    if (turn(j, 1) - turns_[i] < half_turn && !is_thinner_between(i, j))
      return std::numeric_limits<double>::infinity();
    double nearest = std::numeric_limits<double>::infinity();
    std::pair<int, int> best;
    for (int k = 0; k <= cuts; ++k) {
      for (int m = 0; m <= cuts; ++m) {
        if (are_neighbours(i, fraction(k), j, fraction(m))) continue;
        const double now = (points_[index(i, k)] - points_[index(j, m)]).norm() - radius(i, fraction(k)) -
                           radius(j, fraction(m));
        if (now < nearest) nearest = now, best = {k, m};
      }
    }
    if (nearest - spacing(i) - spacing(j) >= need) return nearest;
    const auto at = [&](double u, double v) {
      if (are_neighbours(i, u, j, v)) return std::numeric_limits<double>::infinity();
      return (point(i, u) - point(j, v)).norm() - radius(i, u) - radius(j, v);
    };
    return descended(at, fraction(best.first), fraction(best.second), nearest);
  }

 private:
  static constexpr int cuts = 20;
  static constexpr double half_turn = std::numbers::pi;

  static double fraction(int k) { return static_cast<double>(k) / cuts; }
  static std::size_t index(std::size_t i, int k) { return i * (cuts + 1) + static_cast<std::size_t>(k); }
  // Point on a circular arc; bends below rounding count as straight.
  [[nodiscard]] Eigen::Vector3d point(std::size_t i, double u) const {
    const Arc& arc = backbone_.arcs()[i];
    const double turn = arc.bend.norm();
    if (turn < 1e-9) return arc.X_WS.position + arc.length * u * arc.X_WS.rotation.col(2);
    const Eigen::Vector2d across = (1 - std::cos(turn * u)) / turn * arc.bend;
    return arc.X_WS.position +
           arc.length / turn *
               (arc.X_WS.rotation * Eigen::Vector3d(across.x(), across.y(), std::sin(turn * u)));
  }
  [[nodiscard]] double radius(std::size_t i, double u) const {
    const auto& r = arm_.sections[i].radius;
    return r[0] + u * (r[1] - r[0]);
  }
  [[nodiscard]] double turn(std::size_t i, double u) const {
    return turns_[i] + u * backbone_.arcs()[i].bend.norm();
  }
  // Returns whether a section from i to j is thinner than the mean of i and j.
  [[nodiscard]] bool is_thinner_between(std::size_t i, std::size_t j) const {
    const auto thickness = [&](std::size_t k) {
      return std::max(arm_.sections[k].radius[0], arm_.sections[k].radius[1]);
    };
    double thinnest = thickness(i);
    for (std::size_t k = i + 1; k <= j; ++k) thinnest = std::min(thinnest, thickness(k));
    return thinnest < (thickness(i) + thickness(j)) / 2 * (1 - 1e-9);
  }
  [[nodiscard]] bool are_neighbours(std::size_t i, double u, std::size_t j, double v) const {
    if (turn(j, v) - turn(i, u) >= half_turn) return false;
    if (!is_thinner_between(i, j)) return true;
    const double length =
        lengths_[j] + v * backbone_.arcs()[j].length - lengths_[i] - u * backbone_.arcs()[i].length;
    return length < half_turn * (radius(i, u) + radius(j, v)) / 2;
  }
  // Returns how much nearer something may be between two sampled points, m.
  [[nodiscard]] double spacing(std::size_t i) const {
    const auto& r = arm_.sections[i].radius;
    return (backbone_.arcs()[i].length + std::abs(r[1] - r[0])) / cuts;
  }

  // Descends from (u, v), where the value is `best`, with decreasing steps.
  template <class Value>
  static double descended(const Value& value, double u, double v, double best) {
    constexpr std::array<std::pair<int, int>, 8> ways{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}, {1, 1}, {-1, -1}}};
    for (double h = 0.5 / cuts; h > 1e-6;) {
      const double before = best;
      for (const auto& [i, j] : ways) {
        const double x = std::clamp(u + i * h, 0.0, 1.0);
        const double y = std::clamp(v + j * h, 0.0, 1.0);
        const double now = value(x, y);
        if (now < best) best = now, u = x, v = y;
      }
      if (best == before) h /= 2;
    }
    return best;
  }

  const Arm& arm_;
  Backbone backbone_;
  std::vector<double> turns_;            // Turn from the base to each section's start, rad.
  std::vector<double> lengths_;          // Length from the base to each section's start, m.
  std::vector<Eigen::Vector3d> points_;  // cuts + 1 points per section.
};

}  // namespace flexura
