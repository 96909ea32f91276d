#include "flexura/calibrate/marker_match.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "flexura/calibrate/marker_features.h"

namespace flexura {
namespace {

using Point = std::complex<double>;

// The map z -> turn z + shift of complex numbers.
struct Similarity {
  Point turn{1, 0}, shift{0, 0};
  [[nodiscard]] Point operator()(const Point& z) const { return turn * z + shift; }
};

struct Trial {
  MarkerPairs found;
  double score = -std::numeric_limits<double>::infinity();
};

class Matcher {
 public:
  Matcher(std::vector<MarkerFeature> expected, std::vector<MarkerFeature> seen,
          const std::array<int, 2>& size, const MatchPrior& match_prior)
      : expected_(std::move(expected)),
        seen_(std::move(seen)),
        size_(size),
        match_prior_(match_prior),
        tolerance_(tolerances(expected_)),
        moved_(expected_) {
    for (const MarkerFeature& one : expected_) middle_ += one.at / static_cast<double>(expected_.size());
  }

  Trial best() {
    Trial best;
    // The unmoved expected picture.
    if (!expected_.empty() && std::isfinite(match_prior_.shift)) try_map({}, best);
    for_likely_moves(expected_, seen_, [&](const Point& turn, const Point& from, const Point& to) {
      try_map({turn, to - turn * from}, best);
    });
    return best;
  }

 private:
  void try_map(const Similarity& map, Trial& best) {
    if (!is_plausible(map)) return;
    Trial trial = tried(map);
    for (int round = 0; round < 2 && trial.found.pairs.size() > 2; ++round) {
      const Similarity fitted = fit(trial.found.pairs);
      if (!is_plausible(fitted)) break;
      trial = tried(fitted);
    }
    if (trial.score > best.score || (trial.score == best.score && trial.found.off < best.found.off))
      best = std::move(trial);
  }
  // Negative log-likelihood of this motion of the picture, doubled: a sum of squares in standard deviations.
  [[nodiscard]] double prior_cost(const Similarity& map) const {
    const double shift = std::abs(map(middle_) - middle_) / match_prior_.shift,
                 turn = std::arg(map.turn) / match_prior_.turn,
                 scale = std::log(std::abs(map.turn)) / match_prior_.scale;
    return shift * shift + turn * turn + scale * scale;
  }
  [[nodiscard]] bool is_plausible(const Similarity& map) const {
    constexpr double quarter_pi = 0.785398163397448, unlikely = 16;
    return std::abs(map.turn) > 0.5 && std::abs(map.turn) < 2 && std::abs(std::arg(map.turn)) < quarter_pi &&
           prior_cost(map) < unlikely;
  }

  [[nodiscard]] Trial tried(const Similarity& map) {
    for (std::size_t a = 0; a < expected_.size(); ++a) moved_[a].at = map(expected_[a].at);
    Trial trial{nearest_pairs(moved_, tolerance_, std::abs(map.turn), seen_, size_), 0};
    trial.score = trial.found.score - 0.5 * prior_cost(map);
    return trial;
  }

  // Least-squares fit to the pairs.
  [[nodiscard]] Similarity fit(const std::vector<MarkerPairs::Pair>& pairs) const {
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

  std::vector<MarkerFeature> expected_, seen_;
  std::array<int, 2> size_;
  MatchPrior match_prior_;
  std::vector<double> tolerance_;
  std::vector<MarkerFeature> moved_;
  Point middle_{0, 0};
};

}  // namespace

MarkerMatch match_markers(const MarkerScene& expected, const MarkerScene& seen,
                          const std::array<int, 2>& size, const MatchPrior& match_prior) {
  const MarkerPalette palette(expected, seen);
  const std::vector<MarkerFeature> expected_features = features_of(expected, palette),
                                   seen_features = features_of(seen, palette);
  const Trial best = Matcher(expected_features, seen_features, size, match_prior).best();
  MarkerMatch match;
  match.markers.resize(seen.markers.size());
  std::vector<std::pair<std::size_t, std::size_t>> order;  // Indices along the picture and along the arm.
  constexpr std::size_t last = std::numeric_limits<std::size_t>::max();
  for (const auto& [i, a] : best.found.pairs) {
    const MarkerFeature &one = seen_features[i], &other = expected_features[a];
    if (one.kind == MarkerFeature::end_kind) {
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
