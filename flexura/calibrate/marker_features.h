#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstddef>
#include <functional>
#include <vector>

#include "flexura/calibrate/marker_match.h"

namespace flexura {

/// What can be seen of an arm in a picture, px: u + i v.
struct MarkerFeature {
  static constexpr int end_kind = -1;  ///< Markers of one colour count from 0.
  std::complex<double> at;
  int kind = 0;
  std::size_t number = 0;  ///< Of the marker, or 0 and 1: base and tip.
};

/// The colours that can be told apart. A gray picture shows none.
class MarkerPalette {
 public:
  MarkerPalette(const MarkerScene& expected, const MarkerScene& seen);
  [[nodiscard]] int kind(const Eigen::Vector3d& color) const;

 private:
  std::vector<Eigen::Vector3d> colors_;
  bool has_colors_ = false;
};

/// Markers in their order, then the ends, as far as they are there.
[[nodiscard]] std::vector<MarkerFeature> features_of(const MarkerScene& scene, const MarkerPalette& palette);

/// How far from each of these one of its kind may be seen, px: a third of the way to the
/// nearest other one of its kind, and 40 px at most.
[[nodiscard]] std::vector<double> tolerances(const std::vector<MarkerFeature>& expected);

/// What may have turned and enlarged the expected picture (a factor), and brought one place in it to another.
using MarkerMove = std::function<void(const std::complex<double>& turn, const std::complex<double>& from,
                                      const std::complex<double>& to)>;
/// Does that for each two expected features and two seen ones of their kinds. Of the seen ones the pairs that
/// say most: the farthest apart, a dozen at most, and none of which any is in more than three.
void for_likely_moves(const std::vector<MarkerFeature>& expected, const std::vector<MarkerFeature>& seen,
                      const MarkerMove& move);

/// Which seen feature is which expected one, and what speaks for it.
struct MarkerPairs {
  struct Pair {
    std::size_t seen = 0, expected = 0;
    bool operator==(const Pair&) const = default;
  };
  std::vector<Pair> pairs;  ///< In the order of what is seen.
  double score =
      0;  ///< Found ones, less those seen and not expected, less half of those expected and not seen.
  double off = 0;  ///< Sum of the pairs' distances squared, px^2.
};

/// Each seen feature is the nearest expected one of its kind, if it is within that one's tolerance, times
/// `scale`, and none is nearer to it.
[[nodiscard]] MarkerPairs nearest_pairs(const std::vector<MarkerFeature>& expected,
                                        const std::vector<double>& tolerance, double scale,
                                        const std::vector<MarkerFeature>& seen,
                                        const std::array<int, 2>& size);

}  // namespace flexura
