#include "flexura/render/sensor_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "flexura/render/psf.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <typename Value = std::uint16_t>
Image<Value> read(const SensorConfig& config, const Image<float>& light, const NoiseStream& stream = {},
                  SimdPath path = best_simd_path()) {
  SensorRows rows;
  Image<Value> image;
  Sensor(config, path).read(light, stream, rows, image);
  return image;
}

// Flat areas with a few steps, a ramp and single pixels: covers all branches of the sensor.
Image<float> some_light(TestRandom& random, const SensorConfig& config) {
  const int width = static_cast<int>(config.width), height = static_cast<int>(config.height);
  Image<float> light(width, height, config.channels(), 0.75f);
  for (int patch = random.integer(0, 4); patch > 0; --patch) {
    const int u = random.integer(0, width - 1), v = random.integer(0, height - 1);
    const int to_u = random.integer(u, width - 1), to_v = random.integer(v, height - 1);
    const bool is_ramp = random.integer(0, 1) == 1;
    const auto level = static_cast<float>(random.uniform(0, 1));
    for (int y = v; y <= to_v; ++y) {
      for (int x = u; x <= to_u; ++x) {
        for (int c = 0; c < config.channels(); ++c)
          light.at(x, y, c) = level + (is_ramp ? 0.01f * static_cast<float>(x + c) : 0.0f);
      }
    }
    light.at(u, v, random.integer(0, config.channels() - 1)) = 2;
  }
  return light;
}

SensorConfig some_sensor(TestRandom& random) {
  SensorConfig config{.width = random.integer(1, 150), .height = random.integer(1, 40)};
  if (random.integer(0, 1) == 1) config.pixels = PixelKind::color;
  if (random.integer(0, 1) == 1) config.psf = std::pow(10, random.uniform(-1, 1.2));
  if (random.integer(0, 1) == 1) config.vignetting = random.uniform(0, 1);
  if (random.integer(0, 3) == 0) config.gamma = random.uniform(0.4, 3);
  if (random.integer(0, 1) == 1) config.read_noise = random.uniform(0, 10);
  if (random.integer(0, 1) == 1) config.full_well = random.uniform(100, 1e5);
  config.gain = random.uniform(0.5, 3);
  config.bits = random.integer(1, 8);
  return config;
}

// The light after vignetting and PSF, by the definition in double precision.
std::vector<double> blurred_light(const SensorConfig& config, const Image<float>& light) {
  const int width = light.width(), height = light.height(), channels = light.channels();
  const std::vector<float> weights = psf_weights(config.psf);
  const double u0 = 0.5 * (width - 1), v0 = 0.5 * (height - 1), corner = std::max(u0 * u0 + v0 * v0, 1e-9);
  const auto falloff = [&](int u, int v) {
    return 1 - config.vignetting * ((u - u0) * (u - u0) + (v - v0) * (v - v0)) / corner;
  };
  std::vector<double> result;
  for (int v = 0; v < height; ++v) {
    for (int i = 0; i < width * channels; ++i) {
      const int u = i / channels, radius = static_cast<int>(weights.size()) - 1;
      double sum = 0;
      for (int dv = -radius; dv <= radius; ++dv) {
        for (int du = -radius; du <= radius; ++du) {
          const int x = std::clamp(u + du, 0, width - 1), y = std::clamp(v + dv, 0, height - 1);
          sum += static_cast<double>(weights[static_cast<std::size_t>(std::abs(du))]) *
                 weights[static_cast<std::size_t>(std::abs(dv))] * light.at(x, y, i % channels) *
                 falloff(x, y);
        }
      }
      result.push_back(sum);
    }
  }
  return result;
}

TEST(SensorImage, RoundsLightHalfUpAndCutsItAtFullScale) {
  for (int bits = 1; bits <= 16; ++bits) {
    const int top = (1 << bits) - 1;
    const SensorConfig config{.width = 500, .height = 3, .bits = bits};
    Image<float> light(500, 3);
    TestRandom random(static_cast<std::uint64_t>(bits));
    for (float& value : light.values()) value = static_cast<float>(random.uniform(-0.1, 1.1));
    light.at(0, 0) = 1, light.at(1, 0) = 0, light.at(2, 0) = 0.5f / static_cast<float>(top);
    const auto check = [&](const auto& image) {
      for (std::size_t i = 0; i < light.values().size(); ++i) {
        const float scaled = light.values()[i] * static_cast<float>(top) + 0.5f;
        EXPECT_EQ(image.values()[i], std::clamp(static_cast<int>(std::floor(scaled)), 0, top)) << bits;
      }
    };
    bits <= 8 ? check(read<std::uint8_t>(config, light)) : check(read(config, light));
  }
}

TEST(SensorImage, GainMultipliesAndGammaBrightens) {
  SensorConfig config{.width = 64, .height = 1, .bits = 16, .gain = 2, .gamma = 2.2};
  Image<float> light(64, 1);
  for (int u = 0; u < 64; ++u) light.at(u, 0) = static_cast<float>(u) / 100;
  const Image<std::uint16_t> image = read(config, light);
  for (int u = 0; u < 64; ++u)
    EXPECT_NEAR(image.at(u, 0), 65535 * std::pow(std::min(u / 50.0, 1.0), 1 / 2.2), 0.6);
}

TEST(SensorImage, VignettingAndPsfAreTheDefinitions) {
  for_random_cases(60, [](TestRandom& random) {
    SensorConfig config{.width = random.integer(1, 110), .height = random.integer(1, 12), .bits = 16};
    if (random.integer(0, 1) == 1) config.pixels = PixelKind::color;
    config.psf = random.integer(0, 3) == 0 ? 0 : std::pow(10, random.uniform(-1, 1.05));
    config.vignetting = random.integer(0, 1) == 1 ? random.uniform(0, 1) : 0;
    config.gain = 0.5;
    const Image<float> light = some_light(random, config);
    const std::vector<double> expected = blurred_light(config, light);
    const Image<std::uint16_t> image = read(config, light);
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_NEAR(image.values()[i], std::min(0.5 * expected[i], 1.0) * 65535, 0.6) << i;
  });
}

TEST(SensorImage, AFlatImageStaysFlatUnderThePsf) {
  for (const double psf : {0.3, 0.7, 2.0, 12.0}) {
    const SensorConfig config{.width = 77, .height = 9, .bits = 16, .psf = psf};
    const Image<float> light(77, 9, 1, 0.31415f);
    EXPECT_EQ(read(config, light), read({.width = 77, .height = 9, .bits = 16}, light)) << psf;
  }
}

TEST(SensorImage, IsTheSameBytesOnEveryPath) {
  for_random_cases(200, [](TestRandom& random) {
    const SensorConfig config = some_sensor(random);
    const Image<float> light = some_light(random, config);
    const NoiseStream stream{7, 1, static_cast<std::uint64_t>(random.integer(0, 1000))};
    const auto expected = read<std::uint8_t>(config, light, stream, SimdPath::baseline);
    for (const SimdPath path : available_simd_paths())
      EXPECT_EQ(read<std::uint8_t>(config, light, stream, path), expected) << name_of(path);
  });
}

TEST(SensorImage, IsTheSameBytesForAnyNumberOfThreads) {
  for_random_cases(40, [](TestRandom& random) {
    const SensorConfig config = some_sensor(random);
    const Image<float> light = some_light(random, config);
    const auto expected = read<std::uint8_t>(config, light, {1, 2, 3});
    const Sensor sensor(config);
    const int threads = random.integer(1, 5), height = static_cast<int>(config.height);
    Image<std::uint8_t> image(light.width(), height, light.channels());
    std::vector<std::thread> running(static_cast<std::size_t>(threads));
    for (int i = 0; i < threads; ++i) {
      running[static_cast<std::size_t>(i)] = std::thread([&, i] {
        SensorRows rows;
        sensor.read_rows(light, {1, 2, 3}, height * i / threads, height * (i + 1) / threads, rows, image);
      });
    }
    for (std::thread& one : running) one.join();
    EXPECT_EQ(image, expected);
  });
}

TEST(SensorImage, UsedRowsLeaveNoTrace) {
  for_random_cases(40, [](TestRandom& random) {
    SensorRows rows;
    for (int i = 0; i < 4; ++i) {
      const SensorConfig config = some_sensor(random);
      const Image<float> light = some_light(random, config);
      Image<std::uint8_t> image;
      Sensor(config).read(light, {}, rows, image);
      EXPECT_EQ(image, read<std::uint8_t>(config, light));
    }
  });
}

TEST(SensorImage, LightThatIsNoNumberOrNegativeIsDark) {
  for_random_cases(40, [](TestRandom& random) {
    const SensorConfig config = some_sensor(random);
    Image<float> bad = some_light(random, config), dark = bad;
    for (std::size_t i = 0; i < bad.values().size(); i += 7) {
      constexpr float values[] = {std::numeric_limits<float>::quiet_NaN(), -1, -1e30f, -0.0f,
                                  -std::numeric_limits<float>::infinity()};
      bad.values()[i] = values[i % 5], dark.values()[i] = 0;
    }
    EXPECT_EQ(read<std::uint8_t>(config, bad), read<std::uint8_t>(config, dark));
  });
}

TEST(SensorImage, LightWithoutBoundIsFullScaleWhereItFalls) {
  for (const double gain : {1e-3, 1.0, 1e3}) {
    const SensorConfig config{.width = 40,
                              .height = 5,
                              .bits = 16,
                              .gain = gain,
                              .full_well = 1,
                              .read_noise = 255,
                              .vignetting = 0.5};
    for (const float huge : {1e20f, std::numeric_limits<float>::infinity()}) {
      const Image<std::uint16_t> image = read(config, Image<float>(40, 5, 1, huge));
      EXPECT_EQ(*std::ranges::min_element(image.values()), 65535) << gain << " " << huge;
    }
  }
  const SensorConfig config{.width = 40, .height = 9, .psf = 1};
  Image<float> light(40, 9);
  light.at(20, 4) = std::numeric_limits<float>::infinity();
  const auto image = read<std::uint8_t>(config, light);
  EXPECT_EQ(image.at(20, 4), 255);
  EXPECT_EQ(image.at(22, 5), 255);
  EXPECT_EQ(image.at(30, 4), 0);
}

TEST(SensorImage, RefusesSensorsThatCannotBe) {
  const std::vector<SensorConfig> bad = {
      {.width = 0},      {.height = 0},      {.bits = 0},        {.bits = 17},       {.gain = 0},
      {.gain = -1},      {.gain = infinity}, {.full_well = -1},  {.read_noise = -1}, {.psf = -1},
      {.psf = infinity}, {.psf = 31},        {.vignetting = -1}, {.gamma = 0},       {.gamma = std::nan("")}};
  for (const SensorConfig& config : bad) EXPECT_THROW(Sensor{config}, std::invalid_argument);
}

TEST(SensorImage, RefusesLightAndImagesThatDoNotFit) {
  const Sensor sensor({.width = 8, .height = 4});
  SensorRows rows;
  Image<std::uint8_t> bytes(8, 4);
  Image<std::uint16_t> words;
  EXPECT_THROW(sensor.read(Image<float>(8, 4), {}, rows, words), std::invalid_argument);
  EXPECT_THROW(sensor.read(Image<float>(8, 4, 3), {}, rows, bytes), std::invalid_argument);
  EXPECT_THROW(sensor.read(Image<float>(7, 4), {}, rows, bytes), std::invalid_argument);
  EXPECT_THROW(sensor.read_rows(Image<float>(8, 4), {}, 0, 5, rows, bytes), std::invalid_argument);
  EXPECT_THROW(sensor.read_rows(Image<float>(8, 4), {}, -1, 4, rows, bytes), std::invalid_argument);
  bytes = Image<std::uint8_t>(4, 8);
  EXPECT_THROW(sensor.read_rows(Image<float>(8, 4), {}, 0, 4, rows, bytes), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
