#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "flexura/render/sensor_image.h"

namespace flexura {
namespace {

// Deviates of read noise in standard deviations, to 1/3000, from a 16-bit image.
constexpr int width = 500, height = 500;

Image<double> deviates(const NoiseStream& stream, PixelKind pixels = PixelKind::gray) {
  constexpr double deviation = 3000;  // In levels; full scale is 22 of them.
  const SensorConfig config{
      .width = width, .height = height, .pixels = pixels, .bits = 16, .read_noise = deviation / 65535 * 255};
  SensorRows rows;
  Image<std::uint16_t> image;
  Sensor(config).read(Image<float>(width, height, config.channels(), 0.5f), stream, rows, image);
  Image<double> result(width, height, config.channels());
  for (std::size_t i = 0; i < image.values().size(); ++i)
    result.values()[i] = (image.values()[i] - 0.5 * 65535) / deviation;
  return result;
}

std::vector<double> many_deviates() {
  std::vector<double> all;
  for (std::uint64_t frame = 0; frame < 8; ++frame) {
    const Image<double> one = deviates({1, 0, frame});
    all.insert(all.end(), one.values().begin(), one.values().end());
  }
  return all;
}

double mean_power(const std::vector<double>& values, int power) {
  double sum = 0;
  for (const double value : values) sum += std::pow(value, power);
  return sum / static_cast<double>(values.size());
}

double normal_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// Bounds are five standard deviations of the sample values, plus the documented errors.
TEST(SensorNoise, HasTheMomentsOfANormalDistribution) {
  const std::vector<double> all = many_deviates();
  const auto n = static_cast<double>(all.size());
  EXPECT_NEAR(mean_power(all, 1), 0, 5 / std::sqrt(n));
  EXPECT_NEAR(mean_power(all, 2), 1, 5 * std::sqrt(2 / n));
  EXPECT_NEAR(mean_power(all, 3), 0, 5 * std::sqrt(15 / n));
  EXPECT_NEAR(mean_power(all, 4), 3, 5 * std::sqrt(96 / n) + 0.003);
}

TEST(SensorNoise, HasTheDistributionAndTailsOfANormalOne) {
  std::vector<double> all = many_deviates();
  std::ranges::sort(all);
  const auto n = static_cast<double>(all.size());
  for (std::size_t i = 0; i < all.size(); i += 101)
    ASSERT_NEAR((static_cast<double>(i) + 0.5) / n, normal_below(all[i]), 0.0013 + 2 / std::sqrt(n))
        << all[i];
  constexpr double relative[] = {0.01, 0.01, 0.015, 0.08};  // At 1, 2, 3 and 4 standard deviations.
  for (int x = 1; x <= 4; ++x) {
    const double expected = n * normal_below(-x);
    const double bound = 5 * std::sqrt(expected) + relative[x - 1] * expected;
    const auto below = static_cast<double>(std::ranges::lower_bound(all, -x) - all.begin());
    const auto above = static_cast<double>(all.end() - std::ranges::upper_bound(all, x));
    EXPECT_NEAR(below, expected, bound) << x;
    EXPECT_NEAR(above, expected, bound) << x;
  }
}

// Correlations of a with b, shifted by (du, dv), and of their squares.
void expect_independent(const Image<double>& a, const Image<double>& b, int du, int dv) {
  double product = 0, squares = 0, count = 0;
  for (int v = std::max(0, -dv); v < std::min(height, height - dv); ++v) {
    for (int u = std::max(0, -du); u < std::min(width, width - du); ++u) {
      const double x = a.at(u, v), y = b.at(u + du, v + dv, b.channels() - 1);
      product += x * y, squares += (x * x - 1) * (y * y - 1), ++count;
    }
  }
  EXPECT_NEAR(product / count, 0, 5 / std::sqrt(count)) << du << " " << dv;
  EXPECT_NEAR(squares / count, 0, 5 * 2 / std::sqrt(count)) << du << " " << dv;
}

TEST(SensorNoise, IsIndependentBetweenPixels) {
  const Image<double> image = deviates({1, 0, 0});
  for (const int du : {1, 2, 3, 4, 8, 16, 31, 32, 33, 64, 128, 256}) expect_independent(image, image, du, 0);
  for (const int dv : {1, 2, 3, 16, 100})
    for (const int du : {-2, -1, 0, 1, 2}) expect_independent(image, image, du, dv);
}

TEST(SensorNoise, IsIndependentBetweenFramesCamerasSeedsAndChannels) {
  const Image<double> image = deviates({1, 0, 0});
  const std::vector<NoiseStream> others = {{1, 0, 1},          {1, 0, 2},         {1, 1, 0}, {1, 2, 0},
                                           {2, 0, 0},          {0, 0, 0},         {0, 1, 0}, {0, 0, 1},
                                           {1ull << 40, 0, 0}, {1, 0, 1ull << 40}};
  for (const NoiseStream& other : others)
    for (const int du : {-1, 0, 1}) expect_independent(image, deviates(other), du, 0);
  const Image<double> color = deviates({3, 0, 0}, PixelKind::color);
  for (const int du : {-1, 0, 1}) expect_independent(color, color, du, 0);
}

TEST(SensorNoise, GrowsWithTheLightAsItsElectronsDo) {
  // Variance of light / full_well, times gain squared, and of the read noise.
  constexpr double full_well = 5000, read_noise = 0.5;
  for (const double gain : {0.5, 1.0, 2.0}) {
    const SensorConfig config{.width = 1000,
                              .height = 300,
                              .bits = 16,
                              .gain = gain,
                              .full_well = full_well,
                              .read_noise = read_noise};
    for (const float light : {0.1f, 0.2f, 0.4f}) {
      SensorRows rows;
      Image<std::uint16_t> image;
      Sensor(config).read(Image<float>(1000, 300, 1, light), {9, 0, 0}, rows, image);
      std::vector<double> values;
      for (const std::uint16_t value : image.values()) values.push_back(value / 65535.0);
      const double mean = mean_power(values, 1), n = static_cast<double>(values.size());
      const double variance = mean_power(values, 2) - mean * mean;
      const double expected =
          gain * gain * static_cast<double>(light) / full_well + std::pow(read_noise / 255, 2);
      EXPECT_NEAR(mean, gain * static_cast<double>(light), 5 * std::sqrt(expected / n));
      EXPECT_NEAR(variance, expected, 5 * std::sqrt(2 / n) * expected) << gain << " " << light;
    }
  }
}

TEST(SensorNoise, IsThatOfThePixelWhereverTheImageEnds) {
  const SensorConfig large{.width = 300, .height = 20, .full_well = 300},
      small{.width = 45, .height = 11, .full_well = 300};
  SensorRows rows;
  Image<std::uint8_t> whole, part;
  Sensor(large).read(Image<float>(300, 20, 1, 0.5f), {4, 5, 6}, rows, whole);
  Sensor(small).read(Image<float>(45, 11, 1, 0.5f), {4, 5, 6}, rows, part);
  for (int v = 0; v < 11; ++v)
    for (int u = 0; u < 45; ++u) EXPECT_EQ(part.at(u, v), whole.at(u, v));
}

}  // namespace
}  // namespace flexura
