#include "flexura/vision/linear_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/backbone_image.h"
#include "tests/support/plain_arms.h"
#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

// The picture as encoded by a camera with a gamma, of full scale `white`.
template <typename Value>
Image<Value> encoded(const Image<std::uint8_t>& light, double gamma, int white) {
  Image<Value> picture(light.width(), light.height(), light.channels());
  std::ranges::transform(light.values(), picture.values().begin(), [&](std::uint8_t value) {
    return static_cast<Value>(std::lround(white * std::pow(value / 255.0, 1 / gamma)));
  });
  return picture;
}

TEST(LinearLight, IsWhatTheGammaWasMadeOf) {
  Image<std::uint8_t> light(256, 1);
  for (int u = 0; u < 256; ++u) light.at(u, 0) = static_cast<std::uint8_t>(u);
  for (const double gamma : {0.5, 1.8, 2.2}) {
    Photograph eight, twelve;
    eight.bytes = encoded<std::uint8_t>(light, gamma, 255);
    twelve.bytes = eight.bytes, twelve.words = encoded<std::uint16_t>(light, gamma, 4095),
    twelve.white = 4095;
    eight = linear_light(eight, gamma), twelve = linear_light(twelve, gamma);
    EXPECT_EQ(eight.white, 65535);
    // Values in the file are rounded: the light is somewhere in the range of one value.
    const auto expect_light = [&](int shown, int value, int white, int undone) {
      const auto at = [&](double v) { return 65535 * std::pow(std::clamp(v / white, 0.0, 1.0), gamma); };
      for (const double one : {257.0 * shown, 1.0 * undone}) {
        EXPECT_GE(one, at(value - 0.5) - 1) << shown << " of gamma " << gamma;
        EXPECT_LE(one, at(value + 0.5) + 1) << shown << " of gamma " << gamma;
      }
    };
    for (int u = 0; u < 256; ++u) {
      expect_light(u, encoded<std::uint8_t>(light, gamma, 255).at(u, 0), 255, eight.words.at(u, 0));
      expect_light(u, encoded<std::uint16_t>(light, gamma, 4095).at(u, 0), 4095, twelve.words.at(u, 0));
      EXPECT_LE(std::abs(257 * twelve.bytes.at(u, 0) - twelve.words.at(u, 0)), 129);
    }
  }
}

TEST(LinearLight, LeavesMasksAndLinearPicturesAndHotPixelsAsTheyAre) {
  Photograph picture;
  picture.bytes = Image<std::uint8_t>(4, 3);
  std::ranges::fill(picture.bytes.values(), std::uint8_t{100});
  EXPECT_EQ(linear_light(picture, 1).bytes, picture.bytes);
  EXPECT_TRUE(linear_light(picture, 1).words.values().empty());
  picture.is_mask = true;
  EXPECT_EQ(linear_light(picture, 2.2).bytes, picture.bytes);
  Photograph hot;
  hot.bytes = Image<std::uint8_t>(1, 1), hot.words = Image<std::uint16_t>(1, 1), hot.white = 4095;
  hot.words.at(0, 0) = 60000;
  EXPECT_EQ(linear_light(hot, 2.2).words.at(0, 0), 65535);
  for (const double none :
       {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)linear_light(picture, none), std::invalid_argument);
}

// A camera's gamma shifts the borders of a dark arm, and the axis too if it is off the middle; linearising
// restores it.
TEST(LinearLight, ShowsTheAxisWhereItIs) {
  double of_light = 0, of_values = 0;
  int count = 0;
  for_random_cases(10, [&](TestRandom& random) {
    SeenArm seen = random_seen_arm(random, {.noise = 1});
    Photograph picture;
    picture.bytes = encoded<std::uint8_t>(seen.picture, 2.2, 255);
    const auto off = [&](const Photograph& shown) {
      ArmFinder finder;
      const ArmObservation& found = finder.find(shown);
      if (!found.is_found()) return -1.0;
      std::vector<AxisSample> axis = found.axis;
      EXPECT_TRUE(to_backbone_image(seen.view.lens, axis));
      return rms_error(seen, axis);
    };
    const double undone = off(linear_light(picture, 2.2)), as_it_is = off(picture);
    if (undone < 0 || as_it_is < 0) return;
    of_light += undone * undone, of_values += as_it_is * as_it_is, ++count;
  });
  if (one_case_of > 1) return;
  ASSERT_GT(count, 6);
  of_light = std::sqrt(of_light / count), of_values = std::sqrt(of_values / count);
  std::printf("axis of %d arms by a gamma of 2.2: %.4f px undone, %.4f px as it is\n", count, of_light,
              of_values);
  EXPECT_LT(of_light, 0.02);
  EXPECT_GT(of_values, 1.2 * of_light);
}

}  // namespace
}  // namespace flexura
