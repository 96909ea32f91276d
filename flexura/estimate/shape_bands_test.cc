#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/estimate/band_match.h"
#include "flexura/estimate/shape_estimator.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// Also in a sanitized build, since the cases are evaluated together.
template <typename Body>
void for_five_cases(Body&& body) {
  for (int index = 0; index < 5; ++index) {
    TestRandom random(case_seed(index));
    body(random);
  }
}

const std::vector<double> band_places = {0.1, 0.22, 0.37, 0.5, 0.66, 0.81, 0.9};

// A band at arc length s as seen by a camera, with an error of `off` px along the curve.
SeenBand band_at(const Backbone& backbone, const View& view, double s, double off) {
  const Pose X_WS = backbone.pose(s);
  const Eigen::Vector2d pixel = view.project(X_WS.position).value(),
                        ahead = view.project(X_WS.position + 1e-4 * X_WS.rotation.col(2)).value();
  const Eigen::Vector2d heading = (ahead - pixel).normalized();
  return {pixel + off * heading, heading, 0.2, {200, 30, 30}};
}

struct BandedCase {
  Arm arm = three_section_arm();
  Backbone truth;
  std::vector<Observation> plain, banded;

  explicit BandedCase(TestRandom& random)
      : truth(arm, random_bends(random, arm, 1.3)), plain(observations_of(truth, random, 0.05)) {
    // Ends have an error of 0.3 px along the curve.
    for (Observation& seen : plain)
      for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
        seen.ends[end]->pixel =
            band_at(truth, seen.view, static_cast<double>(end) * 0.9999, random.uniform(-0.5, 0.5)).pixel;
    banded = plain;
    for (Observation& seen : banded)
      for (const double s : band_places)
        seen.bands.push_back(band_at(truth, seen.view, s, random.uniform(-0.3, 0.3)));
  }
};

// Errors of many fits.
struct Errors {
  double sum = 0, worst = 0;
  void add(double error) { sum += error, worst = std::max(worst, error); }
};

// The ends, known to half a pixel, determine the position of the curve along itself; so do bands, and there
// are more of them.
TEST(ShapeBands, TellWhereAnArmOfUnknownMakeLiesAlongItself) {
  Errors plain, shared, known;
  for_five_cases([&](TestRandom& random) {
    const BandedCase one(random);
    const auto error = [&](const ShapePrior& prior, const std::vector<Observation>& seen,
                           std::size_t markers) {
      const ShapeEstimate found = ShapeEstimator(prior).estimate(seen);
      EXPECT_TRUE(found.is_found) << found.reason;
      EXPECT_EQ(found.markers.size(), markers);
      return shape_error(found.shape, one.truth);
    };
    ShapePrior prior = unknown_arm(std::nullopt, std::nullopt, 12);
    plain.add(error(prior, one.plain, 0));
    shared.add(error(prior, one.banded, band_places.size()));
    // The length is 1.
    prior.markers = band_places;
    known.add(error(prior, one.banded, band_places.size()));
  });
  EXPECT_LT(shared.sum, 1.02 * plain.sum);
  EXPECT_LT(known.sum, 0.8 * plain.sum);
}

TEST(ShapeBands, ThatAreFalseOrHiddenDoNoHarm) {
  Errors plain, shared, known;
  for_five_cases([&](TestRandom& random) {
    BandedCase one(random);
    // One is hidden in each picture, one is displaced, and one is a false detection.
    one.banded[0].bands.erase(one.banded[0].bands.begin() + random.integer(0, 6));
    one.banded[1].bands.erase(one.banded[1].bands.begin() + random.integer(0, 6));
    for (Observation& seen : one.banded) {
      seen.bands[static_cast<std::size_t>(random.integer(0, 5))] =
          band_at(one.truth, seen.view, random.uniform(0.05, 0.95), 0);
      seen.bands.push_back(band_at(one.truth, seen.view, random.uniform(0.05, 0.95), 0));
    }
    ShapePrior prior = unknown_arm(Eigen::Vector3d(0, 0, 0), 1.0, 12);
    const auto error = [&](const std::vector<Observation>& seen) {
      const ShapeEstimate found = ShapeEstimator(prior).estimate(seen);
      EXPECT_TRUE(found.is_found) << found.reason;
      return shape_error(found.shape, one.truth);
    };
    plain.add(error(one.plain));
    shared.add(error(one.banded));
    prior.markers = band_places;
    known.add(error(one.banded));
  });
  EXPECT_LT(shared.sum, 1.1 * plain.sum);
  EXPECT_LT(shared.worst, 1.3 * plain.worst);
  EXPECT_LT(known.sum, 1.1 * plain.sum);
  EXPECT_LT(known.worst, 1.3 * plain.worst);
}

TEST(ShapeBands, AtPlacesThatAreToldWronglyDoNoHarm) {
  Errors plain, reported;
  for_random_cases(10, [&](TestRandom& random) {
    const BandedCase one(random);
    ShapePrior prior{.arm = one.arm};
    plain.add(shape_error(ShapeEstimator(prior).estimate(one.plain).shape, one.truth));
    // Measured from the other end.
    for (const double s : band_places) prior.markers.push_back(1 - s);
    std::ranges::sort(prior.markers);
    const ShapeEstimate found = ShapeEstimator(prior).estimate(one.banded);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_FALSE(found.notes.empty());
    reported.add(shape_error(found.shape, one.truth));
  });
  EXPECT_LT(reported.worst, 1.5 * plain.worst);
}

// The band of each observation, by marker; -1: not visible.
std::vector<std::array<int, 2>> table(const std::vector<BandObservation>& band_observations,
                                      std::size_t markers) {
  std::vector<std::array<int, 2>> result(markers, {-1, -1});
  for (const BandObservation& band_observation : band_observations)
    result.at(band_observation.marker).at(band_observation.observation) =
        static_cast<int>(band_observation.band);
  return result;
}

TEST(MatchBands, LeavesOutWhatHasNoCounterpart) {
  TestRandom random(3);
  BandedCase one(random);
  const Shape shape{one.arm, random_bends(random, one.arm, 0)};
  TestRandom again(3);
  const Shape near{one.arm, random_bends(again, one.arm, 1.3)};
  ShapePrior prior{.arm = one.arm};
  prior.markers = band_places;
  one.banded[0].bands.erase(one.banded[0].bands.begin() + 2);
  one.banded[1].bands.insert(one.banded[1].bands.begin(), band_at(one.truth, one.banded[1].view, 0.73, 0));
  using Pair = std::array<int, 2>;
  const auto known = table(match_bands(prior, near, 1e-4, one.banded), 7);
  EXPECT_EQ(known, (std::vector<Pair>{{0, 1}, {1, 2}, {-1, 3}, {2, 4}, {3, 5}, {4, 6}, {5, 7}}));
  // Unknown markers are numbered as in the first picture.
  prior.markers.clear();
  const auto shared = table(match_bands(prior, near, 1e-4, one.banded), 6);
  EXPECT_EQ(shared, (std::vector<Pair>{{0, 1}, {1, 2}, {2, 4}, {3, 5}, {4, 6}, {5, 7}}));
  // An inaccurate shape gives no match if the pictures have different numbers of bands; otherwise they are
  // counted.
  EXPECT_TRUE(match_bands(prior, shape, 0.05, one.banded).empty());
  one.banded[1].bands.erase(one.banded[1].bands.begin());
  one.banded[1].bands.erase(one.banded[1].bands.begin() + 2);
  EXPECT_EQ(table(match_bands(prior, shape, 0.05, one.banded), 6),
            (std::vector<Pair>{{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}}));
}

TEST(MatchBands, GoesByColourWherePlacesAreAlike) {
  TestRandom random(5);
  BandedCase one(random);
  TestRandom again(5);
  const Shape near{one.arm, random_bends(again, one.arm, 1.3)};
  // A green band slightly beside a red one, seen by one camera only.
  SeenBand green = band_at(one.truth, one.banded[1].view, 0.5, 0);
  green.color = {30, 200, 30};
  one.banded[1].bands[3] = band_at(one.truth, one.banded[1].view, 0.51, 0);
  one.banded[1].bands.push_back(green);
  const auto band_observations = table(match_bands({.arm = one.arm}, near, 1e-4, one.banded), 7);
  EXPECT_EQ(band_observations[3], (std::array<int, 2>{3, 3}));
}

}  // namespace
}  // namespace flexura
