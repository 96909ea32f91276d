#include "flexura/estimate/band_match.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>

#include "flexura/estimate/curve_image.h"
#include "flexura/estimate/shape_silhouette.h"
#include "flexura/estimate/space_curve.h"
#include "flexura/math/median.h"

namespace flexura {
namespace {

// A position along the arm of an observed band or a known marker.
struct Place {
  double s = 0;                          // m along the unstretched arm.
  std::optional<Eigen::Vector3d> color;  // Of an observed band.
  std::size_t index = 0;                 // Index of the band in its observation, or of the marker.
};
using Places = std::vector<Place>;

void sort(Places& places) { std::ranges::stable_sort(places, {}, &Place::s); }

Places places_of(const Observation& seen, const SpaceCurve& curve, const Shape& shape, std::size_t number) {
  CurveImage image;
  Places places;
  if (!image.set(corrected(seen.view, error_of(shape, number)), curve)) return places;
  for (std::size_t i = 0; i < seen.bands.size(); ++i) {
    const SeenBand& band = seen.bands[i];
    const CurveImage::Point near = image.nearest(band.pixel, band.heading, image.everywhere());
    places.push_back({curve.s_of(shape.arm, near.place), band.color, i});
  }
  sort(places);
  return places;
}

// Returns the usual distance between neighbours; for a single one, a share of the arm's length.
double spacing(const Places& places, double length) {
  constexpr double of_one = 0.2;
  if (places.size() < 2) return of_one * length;
  std::vector<double> gaps;
  gaps.reserve(places.size());
  for (std::size_t i = 1; i < places.size(); ++i) gaps.push_back(places[i].s - places[i - 1].s);
  return median(std::span(gaps));
}

// Cost of matching two; leaving both out costs 1.
double mismatch(const Place& a, const Place& b, double gate) {
  constexpr double other_color = 120;
  const double off = (a.s - b.s) / gate;
  const double color = a.color && b.color ? (*a.color - *b.color).norm() / other_color : 0;
  return off * off + color * color;
}

using Pairs = std::vector<std::array<std::size_t, 2>>;

// Returns the cheapest order-preserving pairing of two ascending series.
Pairs paired(const Places& a, const Places& b, double gate) {
  const std::size_t rows = a.size() + 1, columns = b.size() + 1;
  constexpr double alone = 0.5;
  std::vector<double> costs(rows * columns, 0.0);
  const auto cost = [&](std::size_t i, std::size_t j) -> double& { return costs[i * columns + j]; };
  const auto together = [&](std::size_t i, std::size_t j) {
    return cost(i - 1, j - 1) + mismatch(a[i - 1], b[j - 1], gate);
  };
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) {
      if (i == 0 || j == 0)
        cost(i, j) = alone * static_cast<double>(i + j);
      else
        cost(i, j) = std::min({cost(i - 1, j) + alone, cost(i, j - 1) + alone, together(i, j)});
    }
  Pairs pairs;
  for (std::size_t i = a.size(), j = b.size(); i > 0 && j > 0;) {
    const bool is_pair = cost(i, j) == together(i, j);
    if (is_pair) pairs.push_back({i - 1, j - 1});
    const bool is_row = is_pair || cost(i, j) == cost(i - 1, j) + alone;
    i -= is_row ? 1 : 0, j -= is_pair || !is_row ? 1 : 0;
  }
  std::ranges::reverse(pairs);
  return pairs;
}

Pairs counted(std::size_t count) {
  Pairs pairs;
  for (std::size_t i = 0; i < count; ++i) pairs.push_back({i, i});
  return pairs;
}

// All sections of an arm of unknown length have a common stretch.
double stretch_of(const Shape& shape) {
  return shape.state.stretches.empty() ? 1.0 : shape.state.stretches.front();
}

// Markers found so far, extended from observation to observation.
class Matching {
 public:
  Matching(const ShapePrior& prior, double sigma)
      : is_known_(!prior.markers.empty()), length_(prior.arm.length()), sigma_(sigma) {
    for (const double s : prior.markers) markers_.push_back({s, std::nullopt, markers_.size()});
    sort(markers_);
    count_ = markers_.size();
  }

  void add(std::size_t observation, const Places& seen) {
    const bool is_first = !is_known_ && markers_.empty();
    std::vector<bool> is_placed(seen.size(), false);
    Pairs pairs;
    if (!is_first) pairs = pairs_with(seen);
    for (const auto& [i, j] : pairs) {
      const Place& marker = markers_[i];
      band_observations_.push_back({observation, seen[j].index, marker.index,
                                    is_known_ ? std::optional<double>(marker.s) : std::nullopt});
      is_placed[j] = true;
    }
    if (is_known_) return;
    for (std::size_t j = 0; j < seen.size(); ++j) {
      if (is_placed[j]) continue;
      band_observations_.push_back({observation, seen[j].index, count_, std::nullopt});
      markers_.push_back({seen[j].s, seen[j].color, count_++});
    }
    sort(markers_);
  }

  std::vector<BandObservation> take() {
    std::vector<std::size_t> observation_counts(count_, 0);
    for (const BandObservation& band_observation : band_observations_)
      ++observation_counts[band_observation.marker];
    std::erase_if(band_observations_, [&](const BandObservation& band_observation) {
      return !band_observation.s && observation_counts[band_observation.marker] < 2;
    });
    return band_observations_;
  }

 private:
  [[nodiscard]] Pairs pairs_with(const Places& seen) const {
    // Share of the distance between markers: a less accurate shape does not distinguish them.
    constexpr double share = 0.4, surely = 0.25;
    const double gate = share * spacing(markers_, length_);
    if (sigma_ < surely * gate) return paired(markers_, seen, gate);
    return markers_.size() == seen.size() && seen.size() > 1 ? counted(seen.size()) : Pairs{};
  }

  bool is_known_;
  double length_, sigma_;
  Places markers_;
  std::size_t count_ = 0;
  std::vector<BandObservation> band_observations_;
};

}  // namespace

std::vector<BandObservation> match_bands(const ShapePrior& prior, const Shape& shape, double sigma,
                                         std::span<const Observation> observations) {
  SpaceCurve curve(ShapeVariables(prior), intervals_a_section(prior));
  curve.set(shape);
  Matching matching(prior, sigma / stretch_of(shape));
  for (std::size_t i = 0; i < observations.size(); ++i)
    matching.add(i, places_of(observations[i], curve, shape, i));
  return matching.take();
}

std::vector<PlacedMarker> placed_markers(const ShapePrior& prior, const Shape& shape,
                                         std::span<const BandObservation> observation_counts,
                                         std::span<const Observation> observations) {
  SpaceCurve curve(ShapeVariables(prior), intervals_a_section(prior));
  curve.set(shape);
  std::map<std::size_t, PlacedMarker> markers;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    for (const Place& place : places_of(observations[i], curve, shape, i)) {
      const auto band_observation = std::ranges::find_if(observation_counts, [&](const BandObservation& one) {
        return one.observation == i && one.band == place.index;
      });
      if (band_observation == observation_counts.end()) continue;
      PlacedMarker& marker = markers[band_observation->marker];
      marker.s += stretch_of(shape) * place.s, ++marker.observation_counts;
    }
  }
  std::vector<PlacedMarker> result;
  result.reserve(markers.size());
  for (const auto& [number, marker] : markers)
    result.push_back({marker.s / static_cast<double>(marker.observation_counts), marker.observation_counts});
  std::ranges::stable_sort(result, {}, &PlacedMarker::s);
  return result;
}

}  // namespace flexura
