#include "flexura/camera/zoom.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>

#include "flexura/math/derivative_check.h"
#include "tests/support/cameras.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

Eigen::VectorXd numbers_of(const Intrinsics& lens) {
  Eigen::VectorXd result(intrinsics_count);
  result << lens.fx, lens.fy, lens.cx, lens.cy,
      Eigen::Map<const Eigen::Vector<double, Distortion::most>>(lens.distortion.data());
  return result;
}

TEST(Zoom, WithoutATableIsLinear) {
  LensConfig config;
  config.fx = 700, config.fy = 710, config.distortion = {0.1, 0, 0, 0, 0};
  const ZoomTable zoom(config, 640, 480);
  EXPECT_TRUE(zoom.is_linear());
  for (const double ratio : {0.5, 1.0, 3.7, 10.0}) {
    const Intrinsics lens = zoom.at(ratio);
    EXPECT_EQ(lens.fx, 700 * ratio);
    EXPECT_EQ(lens.fy, 710 * ratio);
    EXPECT_EQ(lens.cx, 319.5);
    EXPECT_EQ(lens.cy, 239.5);
    EXPECT_EQ(lens.distortion, config.distortion);
    EXPECT_EQ(zoom.ratio(ratio), ratio);
  }
}

TEST(Zoom, GoesThroughItsRowsAndKeepsBetweenTheirFocalLengths) {
  for_random_cases(200, [](TestRandom& random) {
    const LensConfig config = random_lens(random);
    const ZoomTable zoom(config, 640, 480);
    double last = 0;
    for (std::size_t i = 0; i < config.zoom.size(); ++i) {
      const ZoomRow& row = config.zoom[i];
      const Intrinsics lens = zoom.at(row.count.value_or(row.ratio));
      EXPECT_NEAR(lens.fx, *row.fx, 1e-12 * lens.fx);
      EXPECT_NEAR(lens.fy, *row.fy, 1e-12 * lens.fy);
      EXPECT_NEAR(lens.cx, *row.cx, 1e-10);
      EXPECT_NEAR(lens.distortion[0], (*row.distortion)[0], 1e-14);
      EXPECT_NEAR(zoom.ratio(row.count.value_or(row.ratio)), row.ratio, 1e-12 * row.ratio);
      if (i == 0) continue;
      const double from = config.zoom[i - 1].count.value_or(config.zoom[i - 1].ratio);
      const double to = row.count.value_or(row.ratio);
      last = 0;
      for (int k = 0; k <= 40; ++k) {
        const double now = zoom.at(from + (to - from) * k / 40).fx;
        EXPECT_GT(now, last);
        last = now;
      }
    }
  });
}

TEST(Zoom, ATableOfTheLinearLawIsTheLinearLaw) {
  LensConfig config;
  for (const double ratio : {1.0, 1.5, 4.0, 10.0}) config.zoom.emplace_back().ratio = ratio;
  const ZoomTable zoom(config, 640, 480);
  for (double ratio = 1; ratio <= 10; ratio += 0.05)
    EXPECT_NEAR(zoom.at(ratio).fx, 800 * ratio, 1e-11 * ratio * 800);
}

TEST(Zoom, ItsSlopeIsItsDerivative) {
  for_random_cases(200, [](TestRandom& random) {
    const ZoomTable zoom(random_lens(random), 640, 480);
    const double first = zoom.is_linear() ? 1 : zoom.first(), last = zoom.is_linear() ? 10 : zoom.last();
    const double at = random.uniform(first, last);
    const auto function = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      Eigen::VectorXd y(intrinsics_count + 1);
      y << numbers_of(zoom.at(x[0])), zoom.ratio(x[0]);
      return y;
    };
    // The second derivative jumps at rows: steps that may cross one are accurate to first order only.
    const double step = 1e-4 * (last - first);
    const Eigen::VectorXd low = function(Eigen::VectorXd::Constant(1, std::max(first, at - step)));
    const Eigen::VectorXd high = function(Eigen::VectorXd::Constant(1, std::min(last, at + step)));
    const double width = std::min(last, at + step) - std::max(first, at - step);
    Eigen::VectorXd slope(intrinsics_count + 1);
    slope << zoom.slope(at), zoom.ratio_slope(at);
    for (int i = 0; i <= intrinsics_count; ++i) {
      const double change = std::abs(high[i] - low[i]) / width;
      EXPECT_NEAR(slope[i], (high[i] - low[i]) / width,
                  0.02 * change + 1e-4 * (std::abs(low[i]) + 1) / (last - first))
          << i;
    }
  });
}

// Change of the lens at a zoom when `change` adds a step to one of the file's values.
template <class Change>
Eigen::VectorXd difference(const LensConfig& config, double zoom, double step, Change&& change) {
  const auto at = [&](double offset) {
    LensConfig changed = config;
    change(changed, offset);
    return numbers_of(ZoomTable(changed, 640, 480).at(zoom));
  };
  return (at(step) - at(-step)) / (2 * step);
}

// Adds an offset to value i of a complete lens or row.
template <class Lens>
void add(Lens& lens, int i, double offset) {
  if (i == 0) lens.fx = *std::optional<double>(lens.fx) + offset;
  if (i == 1) lens.fy = *lens.fy + offset;
  if (i == 2) lens.cx = *lens.cx + offset;
  if (i == 3) lens.cy = *lens.cy + offset;
  if (i < 4) return;
  std::optional<Distortion> distortion = lens.distortion;
  (*distortion)[static_cast<std::size_t>(i - 4)] += offset;
  lens.distortion = *distortion;
}

// A lens without values that stay constant from row to row: there the slopes between them have a corner.
LensConfig changing_lens(TestRandom& random) {
  LensConfig config = random_lens(random);
  config.distortion[4] = random.uniform(0.001, 0.01);
  for (ZoomRow& row : config.zoom) (*row.distortion)[4] = random.uniform(0.001, 0.01);
  return config;
}

TEST(Zoom, KnowsHowItsLensChangesWithItsRows) {
  for_random_cases(100, [](TestRandom& random) {
    const LensConfig config = changing_lens(random);
    if (config.zoom.empty()) return;
    const ZoomTable zoom(config, 640, 480);
    const double at = random.uniform(zoom.first(), zoom.last());
    for (std::size_t row = 0; row < config.zoom.size(); ++row) {
      const auto by_row = zoom.by_row(at, row);
      for (int i = 0; i < 4 + static_cast<int>(config.distortion.size()); ++i) {
        const double step = i < 4 ? 1e-3 : 1e-7;
        Eigen::VectorXd expected = Eigen::VectorXd::Zero(intrinsics_count);
        expected[i] = by_row[i];
        const Eigen::VectorXd found = difference(
            config, at, step, [&](LensConfig& lens, double offset) { add(lens.zoom[row], i, offset); });
        EXPECT_LE((found - expected).norm(), 1e-5) << "row " << row << ", number " << i;
      }
    }
  });
}

TEST(Zoom, KnowsHowItsLensChangesWithThatAtRatioOne) {
  for_random_cases(100, [](TestRandom& random) {
    LensConfig config = changing_lens(random);
    config.cx = 320, config.cy = 240;
    for (ZoomRow& row : config.zoom) {
      // Omitted values follow from the lens; proportional focal lengths still rise.
      if (random.integer(0, 1) == 0) row.fx.reset();
      if (random.integer(0, 1) == 0) row.fy.reset();
      if (random.integer(0, 4) == 0) row.cx.reset();
      if (random.integer(0, 4) == 0) row.distortion.reset();
    }
    const ZoomTable zoom(config, 640, 480);
    const double at = zoom.is_linear() ? random.uniform(1, 10) : random.uniform(zoom.first(), zoom.last());
    const auto by_lens = zoom.by_lens(at);
    for (int i = 0; i < 4 + static_cast<int>(config.distortion.size()); ++i) {
      Eigen::VectorXd expected = Eigen::VectorXd::Zero(intrinsics_count);
      expected[i] = by_lens[i];
      const Eigen::VectorXd found = difference(
          config, at, i < 4 ? 1e-3 : 1e-7, [&](LensConfig& lens, double offset) { add(lens, i, offset); });
      EXPECT_LE((found - expected).norm(), 1e-5) << "number " << i;
    }
  });
}

// With this camera's counts, a zoom linear in them is wrong by 242 % at 2x.
TEST(Zoom, AMotorsCountsAreFarFromLinear) {
  LensConfig config;
  config.zoom = sony_zoom();
  const ZoomTable zoom(config, 640, 480);
  EXPECT_EQ(zoom.last(), 0x4000);
  const double count = 0x1606;
  EXPECT_NEAR(zoom.ratio(count), 2, 1e-12);
  EXPECT_NEAR(zoom.at(count).fx, 1600, 1e-9);
  const double linear = 1 + 17 * count / 0x4000;
  EXPECT_NEAR(linear / 2 - 1, 2.42, 0.005);
}

TEST(Zoom, HasNoLensOutsideItsTable) {
  LensConfig config;
  for (const double ratio : {1.0, 10.0}) config.zoom.emplace_back().ratio = ratio;
  const ZoomTable zoom(config, 640, 480);
  EXPECT_EQ(zoom.at(10 * (1 + 1e-12)).fx, zoom.at(10).fx);
  EXPECT_THROW((void)zoom.at(0.99), std::out_of_range);
  EXPECT_THROW((void)zoom.at(10.01), std::out_of_range);
  EXPECT_THROW((void)zoom.slope(std::nan("")), std::out_of_range);
  EXPECT_THROW((void)ZoomTable(LensConfig{}, 640, 480).at(0), std::out_of_range);
}

TEST(Zoom, RefusesATableThatIsNone) {
  const auto problem = [](auto&& spoil) {
    LensConfig config;
    config.zoom = sony_zoom();
    spoil(config.zoom);
    const auto fault = ZoomTable::fault(config).value();
    EXPECT_THROW(ZoomTable(config, 640, 480), std::invalid_argument);
    return fault.path + ": " + fault.what;
  };
  using Rows = std::vector<ZoomRow>;
  EXPECT_THAT(problem([](Rows& rows) { rows.resize(1); }),
              HasSubstr("zoom: has one row: expected at least two"));
  EXPECT_THAT(problem([](Rows& rows) { rows[3].count.reset(); }),
              HasSubstr("zoom[3].count: expected a count in all rows"));
  EXPECT_THAT(problem([](Rows& rows) { rows[3].ratio = 3; }),
              HasSubstr("zoom[3].ratio: expected a ratio that increases from row to row"));
  EXPECT_THAT(problem([](Rows& rows) { rows[3].count = 0; }),
              HasSubstr("zoom[3].count: expected counts that increase in all rows"));
  EXPECT_THAT(problem([](Rows& rows) { rows[3].fx = 100; }), HasSubstr("zoom[3].fx: expected focal"));
  EXPECT_THAT(problem([](Rows& rows) { rows[3].fy = 100; }), HasSubstr("zoom[3].fy: expected focal"));
}

}  // namespace
}  // namespace flexura
