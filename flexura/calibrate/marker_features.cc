#include "flexura/calibrate/marker_features.h"

#include <algorithm>
#include <functional>

namespace flexura {
namespace {

Eigen::Vector3d chromaticity(const Eigen::Vector3d& color) {
  const double sum = color.sum();
  return sum > 0 ? Eigen::Vector3d(color / sum) : Eigen::Vector3d::Constant(1.0 / 3);
}

std::vector<std::array<std::size_t, 2>> anchors(const std::vector<MarkerFeature>& seen) {
  std::vector<std::array<std::size_t, 2>> all, chosen;
  for (std::size_t i = 0; i < seen.size(); ++i)
    for (std::size_t j = i + 1; j < seen.size(); ++j) all.push_back({i, j});
  std::ranges::stable_sort(all, std::ranges::greater{},
                           [&](const auto& pair) { return std::abs(seen[pair[0]].at - seen[pair[1]].at); });
  constexpr std::size_t most = 12;
  constexpr int most_each = 3;
  std::vector<int> count(seen.size(), 0);
  for (const auto& [i, j] : all) {
    if (chosen.size() == most) break;
    if (count[i] == most_each || count[j] == most_each) continue;
    ++count[i], ++count[j];
    chosen.push_back({i, j});
  }
  return chosen;
}

}  // namespace

MarkerPalette::MarkerPalette(const MarkerScene& expected, const MarkerScene& seen) {
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

int MarkerPalette::kind(const Eigen::Vector3d& color) const {
  if (!has_colors_ || colors_.empty()) return 0;
  const auto nearest = std::ranges::min_element(
      colors_, {}, [&](const Eigen::Vector3d& other) { return (other - chromaticity(color)).norm(); });
  return static_cast<int>(nearest - colors_.begin());
}

std::vector<MarkerFeature> features_of(const MarkerScene& scene, const MarkerPalette& palette) {
  std::vector<MarkerFeature> features;
  for (std::size_t i = 0; i < scene.markers.size(); ++i) {
    if (const auto& marker = scene.markers[i])
      features.push_back({{marker->pixel.x(), marker->pixel.y()}, palette.kind(marker->color), i});
  }
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
    if (const auto& end = scene.ends[i])
      features.push_back({{end->x(), end->y()}, MarkerFeature::end_kind, i});
  return features;
}

std::vector<double> tolerances(const std::vector<MarkerFeature>& expected) {
  std::vector<double> result;
  constexpr double third = 0.35, farthest = 40;  // Share of the distance to the next feature; px.
  for (const MarkerFeature& one : expected) {
    double nearest = farthest / third;
    for (const MarkerFeature& other : expected)
      if (&one != &other && one.kind == other.kind) nearest = std::min(nearest, std::abs(one.at - other.at));
    result.push_back(third * nearest);
  }
  return result;
}

void for_likely_moves(const std::vector<MarkerFeature>& expected, const std::vector<MarkerFeature>& seen,
                      const MarkerMove& move) {
  for (const auto& [i, j] : anchors(seen)) {
    for (const MarkerFeature& a : expected) {
      for (const MarkerFeature& b : expected) {
        if (&a == &b || a.kind != seen[i].kind || b.kind != seen[j].kind) continue;
        const std::complex<double> way = b.at - a.at;
        if (std::abs(way) > 1) move((seen[j].at - seen[i].at) / way, a.at, seen[i].at);
      }
    }
  }
}

MarkerPairs nearest_pairs(const std::vector<MarkerFeature>& expected, const std::vector<double>& tolerance,
                          double scale, const std::vector<MarkerFeature>& seen,
                          const std::array<int, 2>& size) {
  constexpr double far = 1e300;
  std::vector<double> least(expected.size(), far);
  std::vector<std::size_t> taken(expected.size(), seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::size_t nearest = expected.size();
    double off = far;
    for (std::size_t a = 0; a < expected.size(); ++a) {
      if (expected[a].kind != seen[i].kind) continue;
      const double distance = std::abs(expected[a].at - seen[i].at);
      if (distance < off) nearest = a, off = distance;
    }
    if (nearest == expected.size() || off > tolerance[nearest] * scale || !(off < least[nearest])) continue;
    least[nearest] = off, taken[nearest] = i;
  }
  const auto is_inside = [&](const std::complex<double>& at) {
    return at.real() > 0 && at.imag() > 0 && at.real() < size[0] - 1 && at.imag() < size[1] - 1;
  };
  MarkerPairs result;
  double unseen = 0;
  for (std::size_t a = 0; a < expected.size(); ++a) {
    if (taken[a] < seen.size()) {
      result.pairs.push_back({taken[a], a});
      result.off += least[a] * least[a];
    } else if (is_inside(expected[a].at)) {
      unseen += 0.5;
    }
  }
  std::ranges::sort(result.pairs, {}, &MarkerPairs::Pair::seen);
  const auto found = static_cast<double>(result.pairs.size());
  result.score = found - (static_cast<double>(seen.size()) - found) - unseen;
  return result;
}

}  // namespace flexura
