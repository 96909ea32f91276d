#include "flexura/camera/zoom.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "flexura/math/derivative_check.h"
#include "tests/support/cameras.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

Eigen::VectorXd numbers(const Intrinsics& lens) {
  Eigen::VectorXd result(intrinsics_count);
  result << lens.fx, lens.fy, lens.cx, lens.cy,
      Eigen::Map<const Eigen::Vector<double, 5>>(lens.distortion.data());
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
      y << numbers(zoom.at(x[0])), zoom.ratio(x[0]);
      return y;
    };
    // Rows are corners of the second derivative: steps that may cross one find the slope to first order.
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

// With this camera's counts a zoom that is linear in them is wrong by 242 % at 2x.
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
    std::string what = ZoomTable::problem(config);
    EXPECT_THROW(ZoomTable(config, 640, 480), std::invalid_argument);
    return what;
  };
  using Rows = std::vector<ZoomRow>;
  EXPECT_THAT(problem([](Rows& rows) { rows.resize(1); }), HasSubstr("at least two"));
  EXPECT_THAT(problem([](Rows& rows) { rows[3].count.reset(); }),
              HasSubstr("[3]: expected a count in all rows"));
  EXPECT_THAT(problem([](Rows& rows) { rows[3].ratio = 3; }), HasSubstr("[3]: expected a rising ratio"));
  EXPECT_THAT(problem([](Rows& rows) { rows[3].count = 0; }),
              HasSubstr("[3]: expected counts that all rise"));
  EXPECT_THAT(problem([](Rows& rows) { rows[3].fx = 100; }), HasSubstr("[3]: expected rising focal lengths"));
}

}  // namespace
}  // namespace flexura
