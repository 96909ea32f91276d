#include "flexura/calibrate/zoom_correlation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// A dark ellipse with a tail, enlarged and shifted, its border a pixel wide.
Image<std::uint8_t> figure(double size, double x, double y, TestRandom* noise = nullptr) {
  Image<std::uint8_t> picture(160, 120);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const double a = (u - x) / size, b = (v - y) / size;
      const double body = std::hypot(a / 14, b / 22) - 1,
                   tail = std::max(std::abs(a - 12) / 16, std::abs(b + 8) / 5) - 1;
      const double inside = std::clamp(0.5 - 5 * size * std::min(body * 3, tail), 0.0, 1.0);
      const double value = 215 - 190 * inside + (noise != nullptr ? 2 * normal_number(*noise) : 0);
      picture.at(u, v) = static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
    }
  }
  return picture;
}

TEST(ZoomCorrelation, FindsTheRatioWhereverTheFigureIs) {
  for_random_cases(12, [](TestRandom& random) {
    const double ratio = std::exp(random.uniform(-0.5, 0.5));
    const auto real = figure(ratio, random.uniform(65, 90), random.uniform(52, 68), &random);
    const ZoomCorrelation found = correlate_zoom(real, figure(1, 80, 60));
    ASSERT_EQ(found.reason, "");
    EXPECT_NEAR(found.ratio / ratio, 1, 0.01);
    EXPECT_GT(found.peak, 0.97);
  });
}

TEST(ZoomCorrelation, RefusesPicturesOfNothingAndOfTwoSizes) {
  Image<std::uint8_t> blank(160, 120);
  std::ranges::fill(blank.values(), std::uint8_t{200});
  EXPECT_NE(correlate_zoom(blank, figure(1, 80, 60)).reason, "");
  EXPECT_THROW((void)correlate_zoom(Image<std::uint8_t>(10, 10), blank), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
