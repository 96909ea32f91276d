#include "flexura/vision/eight_bits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "flexura/camera/sensor.h"
#include "flexura/vision/arm_finder.h"
#include "tests/support/random_cases.h"
#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

TEST(EightBits, AreTheNearestSharesOfWhite) {
  for (const int bits : {1, 4, 7, 8, 10, 12, 16}) {
    const int white = SensorConfig{.bits = bits}.white();
    Image<std::uint16_t> words(white + 1, 1);
    for (int i = 0; i <= white; ++i) words.at(i, 0) = static_cast<std::uint16_t>(i);
    const Image<std::uint8_t> bytes = eight_bits(words, white);
    for (int i = 0; i <= white; ++i) {
      const int nearest = static_cast<int>(std::lround(255.0 * i / white));
      ASSERT_EQ(int{bytes.at(i, 0)}, nearest) << i << " of " << bits << " bits";
    }
    if (bits > 8) continue;
    Image<std::uint8_t> few(white + 1, 1);
    for (int i = 0; i <= white; ++i) few.at(i, 0) = static_cast<std::uint8_t>(i);
    const Image<std::uint8_t> same = eight_bits(Picture(few), white);
    for (int i = 0; i <= white; ++i) ASSERT_EQ(same.at(i, 0), bytes.at(i, 0));
  }
}

TEST(EightBits, WhatIsMoreThanWhiteIsWhite) {
  Image<std::uint16_t> words(2, 1);
  words.at(0, 0) = 1024, words.at(1, 0) = 65535;
  const Image<std::uint8_t> bytes = eight_bits(words, 1023);
  EXPECT_EQ(bytes.at(0, 0), 255);
  EXPECT_EQ(bytes.at(1, 0), 255);
}

TEST(EightBits, RefuseAWhiteThatIsNone) {
  const Image<std::uint8_t> bytes(2, 2);
  for (const int white : {0, -1}) {
    EXPECT_THROW((void)eight_bits(Picture(bytes), white), std::invalid_argument);
    EXPECT_THROW((void)eight_bits(Image<std::uint16_t>(2, 2), white), std::invalid_argument);
    EXPECT_THROW((void)ArmFinder().find(Picture(bytes), white), std::invalid_argument);
  }
}

// For any depth and channels, the arm is where the 8 bits of gray show it.
TEST(EightBits, ArmsAreSeenAtTheSamePlaceInPicturesOfAnyDepth) {
  for_random_cases(5, [](TestRandom& random) {
    const Image<std::uint8_t> gray = random_seen_arm(random, {}).picture;
    Image<std::uint8_t> color(gray.width(), gray.height(), 3), dark(gray.width(), gray.height());
    Image<std::uint16_t> words(gray.width(), gray.height());
    for (int v = 0; v < gray.height(); ++v)
      for (int u = 0; u < gray.width(); ++u) {
        for (int c = 0; c < 3; ++c) color.at(u, v, c) = gray.at(u, v);
        words.at(u, v) = static_cast<std::uint16_t>(4 * gray.at(u, v));
        dark.at(u, v) = static_cast<std::uint8_t>(gray.at(u, v) / 2);
      }
    ArmFinder finder;
    const ArmObservation by_gray = finder.find(gray);
    if (!by_gray.is_found()) return;  // One in a hundred points at the camera.
    const auto expect_same = [&](const Picture& picture, int white, double within) {
      const ArmObservation seen = finder.find(picture, white);
      ASSERT_EQ(seen.reason, "");
      for (const auto& [one, other] : {std::pair{seen.axis.front(), by_gray.axis.front()},
                                       std::pair{seen.axis.back(), by_gray.axis.back()}})
        ASSERT_LE((one.pixel - other.pixel).norm(), within);
    };
    expect_same(Picture(gray), 255, 0);
    expect_same(Picture(color), 255, 0.02);
    expect_same(Picture(words), 1020, 0.02);
    expect_same(Picture(dark), 127, 1);
  });
}

}  // namespace
}  // namespace flexura
