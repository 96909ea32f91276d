#include "flexura/calibrate/marker_match.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

namespace flexura {
namespace {

using Point = std::complex<double>;

// Kinds of what can be seen. Markers of one colour count from 0.
constexpr int end_kind = -1;

struct Feature {
  Point at;
  int kind = 0;
  std::size_t number = 0;  // Of the marker, or 0 and 1: base and tip.
};

Eigen::Vector3d chromaticity(const Eigen::Vector3d& color) {
  const double sum = color.sum();
  return sum > 0 ? Eigen::Vector3d(color / sum) : Eigen::Vector3d::Constant(1.0 / 3);
}

// The colours that can be told apart. A gray picture shows none.
class Palette {
 public:
  Palette(const MarkerScene& expected, const MarkerScene& seen) {
    constexpr double gray = 0.02;
    const Eigen::Vector3d white = Eigen::Vector3d::Constant(1.0 / 3);
    for (const auto& marker : seen.markers)
      has_colors_ = has_colors_ || (marker && (chromaticity(marker->color) - white).norm() > gray);
    for (const auto& marker : expected.markers) {
      if (!marker) continue;
      const Eigen::Vector3d color = chromaticity(marker->color);
      constexpr double same = 0.1;
      if (std::ranges::none_of(colors_, [&](const auto& other) { return (other - color).norm() < same; }))
        colors_.push_back(color);
    }
  }
  [[nodiscard]] int kind(const Eigen::Vector3d& color) const {
    if (!has_colors_ || colors_.empty()) return 0;
    const auto nearest = std::ranges::min_element(
        colors_, {}, [&](const Eigen::Vector3d& other) { return (other - chromaticity(color)).norm(); });
    return static_cast<int>(nearest - colors_.begin());
  }

 private:
  std::vector<Eigen::Vector3d> colors_;
  bool has_colors_ = false;
};

std::vector<Feature> features_of(const MarkerScene& scene, const Palette& palette) {
  std::vector<Feature> features;
  for (std::size_t i = 0; i < scene.markers.size(); ++i) {
    if (const auto& marker = scene.markers[i])
      features.push_back({{marker->pixel.x(), marker->pixel.y()}, palette.kind(marker->color), i});
  }
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
    if (const auto& end = scene.ends[i]) features.push_back({{end->x(), end->y()}, end_kind, i});
  return features;
}

// z -> turn z + shift, turn a complex number.
struct Similarity {
  Point turn{1, 0}, shift{0, 0};
  [[nodiscard]] Point operator()(const Point& z) const { return turn * z + shift; }
};

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;  // Seen, expected.

struct Trial {
  Pairs pairs;
  double score = -std::numeric_limits<double>::infinity(), off = 0;
};

class Matcher {
 public:
  Matcher(std::vector<Feature> expected, std::vector<Feature> seen, const std::array<int, 2>& size)
      : expected_(std::move(expected)), seen_(std::move(seen)), size_(size), tolerance_(tolerances()) {}

  Trial best() const {
    Trial best;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      for (std::size_t j = i + 1; j < seen_.size(); ++j) {
        if (seen_.size() > 3 && 2 * (j - i) < seen_.size()) continue;  // Short ways say little.
        for (std::size_t a = 0; a < expected_.size(); ++a)
          for (std::size_t b = 0; b < expected_.size(); ++b) try_pairs(i, j, a, b, best);
      }
    }
    return best;
  }

 private:
  // How far off a feature may be: a third of the way to the nearest of its kind.
  [[nodiscard]] std::vector<double> tolerances() const {
    std::vector<double> result;
    constexpr double third = 0.35, farthest = 40;  // Of the way; px.
    for (const Feature& one : expected_) {
      double nearest = farthest / third;
      for (const Feature& other : expected_)
        if (&one != &other && one.kind == other.kind)
          nearest = std::min(nearest, std::abs(one.at - other.at));
      result.push_back(third * nearest);
    }
    return result;
  }

  void try_pairs(std::size_t i, std::size_t j, std::size_t a, std::size_t b, Trial& best) const {
    if (a == b || expected_[a].kind != seen_[i].kind || expected_[b].kind != seen_[j].kind) return;
    const Point way = expected_[b].at - expected_[a].at;
    if (!(std::abs(way) > 1)) return;
    Similarity map;
    map.turn = (seen_[j].at - seen_[i].at) / way;
    if (!is_plausible(map.turn)) return;
    map.shift = seen_[i].at - map.turn * expected_[a].at;
    Trial trial = tried(map);
    for (int round = 0; round < 2 && trial.pairs.size() > 2; ++round) {
      const Similarity fitted = fit(trial.pairs);
      if (!is_plausible(fitted.turn)) break;
      trial = tried(fitted);
    }
    if (trial.score > best.score || (trial.score == best.score && trial.off < best.off))
      best = std::move(trial);
  }
  static bool is_plausible(const Point& turn) {
    constexpr double quarter_pi = 0.785398163397448;
    return std::abs(turn) > 0.5 && std::abs(turn) < 2 && std::abs(std::arg(turn)) < quarter_pi;
  }

  [[nodiscard]] Trial tried(const Similarity& map) const {
    Trial trial;
    std::vector<double> least(expected_.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> taken(expected_.size(), seen_.size());
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const auto [a, off] = nearest(map, seen_[i]);
      if (a == expected_.size() || off > tolerance_[a] * std::abs(map.turn) || !(off < least[a])) continue;
      least[a] = off, taken[a] = i;
    }
    double unseen = 0;
    for (std::size_t a = 0; a < expected_.size(); ++a) {
      if (taken[a] < seen_.size()) {
        trial.pairs.emplace_back(taken[a], a);
        trial.off += least[a] * least[a];
      } else if (is_inside(map(expected_[a].at))) {
        unseen += 0.5;
      }
    }
    const auto found = static_cast<double>(trial.pairs.size());
    trial.score = found - (static_cast<double>(seen_.size()) - found) - unseen;
    return trial;
  }
  [[nodiscard]] std::pair<std::size_t, double> nearest(const Similarity& map, const Feature& seen) const {
    std::pair<std::size_t, double> best{expected_.size(), std::numeric_limits<double>::infinity()};
    for (std::size_t a = 0; a < expected_.size(); ++a) {
      if (expected_[a].kind != seen.kind) continue;
      const double off = std::abs(map(expected_[a].at) - seen.at);
      if (off < best.second) best = {a, off};
    }
    return best;
  }
  [[nodiscard]] bool is_inside(const Point& at) const {
    return at.real() > 0 && at.imag() > 0 && at.real() < size_[0] - 1 && at.imag() < size_[1] - 1;
  }

  // At least squares of what the pairs are off.
  [[nodiscard]] Similarity fit(const Pairs& pairs) const {
    Point from{0, 0}, to{0, 0};
    for (const auto& [i, a] : pairs) from += expected_[a].at, to += seen_[i].at;
    const auto count = static_cast<double>(pairs.size());
    from /= count, to /= count;
    Point cross{0, 0};
    double size = 0;
    for (const auto& [i, a] : pairs) {
      const Point way = expected_[a].at - from;
      cross += std::conj(way) * (seen_[i].at - to), size += std::norm(way);
    }
    Similarity map;
    map.turn = size > 0 ? cross / size : Point{0, 0};
    map.shift = to - map.turn * from;
    return map;
  }

  std::vector<Feature> expected_, seen_;
  std::array<int, 2> size_;
  std::vector<double> tolerance_;
};

}  // namespace

MarkerMatch match_markers(const MarkerScene& expected, const MarkerScene& seen,
                          const std::array<int, 2>& size) {
  const Palette palette(expected, seen);
  const std::vector<Feature> expected_features = features_of(expected, palette),
                             seen_features = features_of(seen, palette);
  const Trial best = Matcher(expected_features, seen_features, size).best();
  MarkerMatch match;
  match.markers.resize(seen.markers.size());
  std::vector<std::pair<std::size_t, std::size_t>> order;  // Places along what is seen, and along the arm.
  constexpr std::size_t last = std::numeric_limits<std::size_t>::max();
  for (const auto& [i, a] : best.pairs) {
    const Feature &one = seen_features[i], &other = expected_features[a];
    if (one.kind == end_kind) {
      order.emplace_back(one.number == 0 ? 0 : last, other.number == 0 ? 0 : last);
    } else {
      match.markers[one.number] = other.number;
      ++match.count;
      order.emplace_back(one.number + 1, other.number + 1);
    }
  }
  std::ranges::sort(order);
  int rises = 0;
  for (std::size_t i = 1; i < order.size(); ++i) rises += order[i].second > order[i - 1].second ? 1 : -1;
  match.is_reversed = rises < 0;
  return match;
}

}  // namespace flexura
