#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstddef>
#include <functional>
#include <vector>

#include "flexura/calibrate/marker_match.h"

namespace flexura {

/// A visible feature of an arm in a picture: a marker or an end of the arm.
struct MarkerFeature {
  /// Value of `kind` for an end of the arm. Marker colours have the kinds 0, 1, ...
  static constexpr int end_kind = -1;
  std::complex<double> at;
  int kind = 0;
  std::size_t number = 0;  ///< Number of the marker; for ends 0 (base) or 1 (tip).
};

/// Classifies the distinguishable colours of markers as kinds; a gray picture has only one kind.
class MarkerPalette {
 public:
  MarkerPalette(const MarkerScene& expected, const MarkerScene& seen);
  [[nodiscard]] int kind(const Eigen::Vector3d& color) const;

 private:
  std::vector<Eigen::Vector3d> colors_;
  bool has_colors_ = false;
};

/// Returns the visible markers in order, then the visible ends.
[[nodiscard]] std::vector<MarkerFeature> features_of(const MarkerScene& scene, const MarkerPalette& palette);

/// Returns, for each expected feature, the largest distance of a matching seen feature, px. The result is a
/// third of the distance to the nearest other expected feature of equal kind, and at most 40 px.
[[nodiscard]] std::vector<double> tolerances(const std::vector<MarkerFeature>& expected);

/// Receives a similarity that may map the expected picture to the seen picture. `turn`: complex factor for
/// rotation and scale. The similarity maps the point `from` to `to`.
using MarkerMove = std::function<void(const std::complex<double>& turn, const std::complex<double>& from,
                                      const std::complex<double>& to)>;
/// Calls `move` for each similarity that maps a pair of expected features to a pair of seen features of equal
/// kinds. Uses at most twelve pairs of seen features, the pairs with the largest distances. Each feature is
/// in at most three pairs.
void for_likely_moves(const std::vector<MarkerFeature>& expected, const std::vector<MarkerFeature>& seen,
                      const MarkerMove& move);

/// An assignment of seen to expected features, and its score.
struct MarkerPairs {
  struct Pair {
    std::size_t seen = 0, expected = 0;
    bool operator==(const Pair&) const = default;
  };
  std::vector<Pair> pairs;  ///< Pairs in the order of the seen features.
  /// Number of pairs, minus the number of unpaired seen features, minus half the number of unpaired expected
  /// features.
  double score = 0;
  double off = 0;  ///< Sum of the squared distances of all pairs, px^2.
};

/// Pairs each seen feature with the nearest expected feature of equal kind. Leaves it unpaired if the
/// distance exceeds `scale` times the expected feature's tolerance, or if another seen feature is nearer to
/// the expected feature.
[[nodiscard]] MarkerPairs nearest_pairs(const std::vector<MarkerFeature>& expected,
                                        const std::vector<double>& tolerance, double scale,
                                        const std::vector<MarkerFeature>& seen,
                                        const std::array<int, 2>& size);

}  // namespace flexura
