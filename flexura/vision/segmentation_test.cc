#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

Image<std::uint8_t> two_tone(TestRandom& random, int width, int height, int dark, int bright) {
  Image<std::uint8_t> gray(width, height);
  const int u0 = random.integer(1, width / 2), v0 = random.integer(1, height / 2);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const bool is_dark = u >= u0 && u < u0 + width / 3 && v >= v0 && v < v0 + height / 3;
      gray.at(u, v) = static_cast<std::uint8_t>((is_dark ? dark : bright) + random.integer(-3, 3));
    }
  }
  return gray;
}

TEST(Threshold, LiesBetweenTheTwoClassesByEveryMethod) {
  for_random_cases(20, [](TestRandom& random) {
    const int dark = random.integer(10, 90), bright = random.integer(130, 240);
    const auto gray = two_tone(random, random.integer(20, 200), random.integer(20, 200), dark, bright);
    for (const ThresholdMethod method :
         {ThresholdMethod::otsu, ThresholdMethod::two_mode, ThresholdMethod::by_block}) {
      ThresholdConfig config;
      config.method = method;
      const Threshold found = threshold_of(gray, config);
      EXPECT_EQ(found.reason, "");
      EXPECT_GT(found.level, dark + 3);
      EXPECT_LT(found.level, bright - 3);
      EXPECT_NEAR(found.dark, dark, 0.5);
      EXPECT_NEAR(found.bright, bright, 0.5);
      EXPECT_EQ(found.figure, Figure::dark);
    }
  });
}

TEST(Threshold, SaysWhyABlankABlackAndASaturatedPictureHaveNone) {
  TestRandom random(1);
  EXPECT_NE(threshold_of(Image<std::uint8_t>(40, 30, 1, 255), {}).reason.find("saturated"),
            std::string::npos);
  EXPECT_NE(threshold_of(Image<std::uint8_t>(40, 30, 1, 0), {}).reason.find("black"), std::string::npos);
  EXPECT_NE(threshold_of(two_tone(random, 60, 60, 100, 100), {}).reason.find("blank"), std::string::npos);
  EXPECT_NE(threshold_of(Image<std::uint8_t>(0, 0), {}).reason.find("no pixels"), std::string::npos);
}

TEST(Threshold, TakesWhatTheBorderShowsForTheGround) {
  TestRandom random(2);
  auto gray = two_tone(random, 80, 60, 40, 200);
  for (std::uint8_t& value : gray.values()) value = static_cast<std::uint8_t>(255 - value);
  EXPECT_EQ(threshold_of(gray, {}).figure, Figure::bright);
}

TEST(Threshold, ByBlockFollowsAnUnevenScreen) {
  // The screen's dark side is darker than the figure's bright one.
  Image<std::uint8_t> gray(320, 80);
  const auto is_figure = [](int u, int v) { return v > 30 && v < 45 && u > 10 && u < 310; };
  for (int v = 0; v < 80; ++v)
    for (int u = 0; u < 320; ++u)
      gray.at(u, v) = static_cast<std::uint8_t>((is_figure(u, v) ? 0.45 : 1.0) * (60 + 0.55 * u));
  ThresholdConfig config;
  config.method = ThresholdMethod::by_block;
  BlockThresholds blocks;
  Components components;
  const Threshold found = segment(gray, config, components, blocks);
  EXPECT_EQ(found.reason, "");
  EXPECT_EQ(found.figure, Figure::dark);
  ASSERT_EQ(components.list.size(), 1U);
  EXPECT_EQ(components.list[0].area, 14 * 299);
}

TEST(Components, AreThoseOfAFloodFill) {
  for_random_cases(60, [](TestRandom& random) {
    const int width = random.integer(1, 150), height = random.integer(1, 30);
    Image<std::uint8_t> gray(width, height);
    for (std::uint8_t& value : gray.values()) value = random.integer(0, 99) < 40 ? 10 : 200;
    Threshold threshold;
    threshold.level = 99.5;
    threshold.figure = random.integer(0, 1) == 0 ? Figure::dark : Figure::bright;
    Components components;
    components.find(gray, threshold);
    const auto is_figure = [&](int u, int v) {
      return u >= 0 && v >= 0 && u < width && v < height &&
             (gray.at(u, v) < threshold.level) == (threshold.figure == Figure::dark);
    };
    Image<int> label(width, height, 1, -1);
    std::vector<std::int64_t> areas;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        ASSERT_EQ(components.run_at(u, v) != nullptr, is_figure(u, v));
        if (!is_figure(u, v) || label.at(u, v) >= 0) continue;
        std::vector<std::pair<int, int>> open = {{u, v}};
        label.at(u, v) = static_cast<int>(areas.size());
        areas.push_back(0);
        while (!open.empty()) {
          const auto [a, b] = open.back();
          open.pop_back();
          ++areas.back();
          ASSERT_EQ(components.run_at(a, b)->component, areas.size() - 1);
          for (int j = -1; j <= 1; ++j) {
            for (int i = -1; i <= 1; ++i) {
              if (!is_figure(a + i, b + j) || label.at(a + i, b + j) >= 0) continue;
              label.at(a + i, b + j) = static_cast<int>(areas.size()) - 1;
              open.emplace_back(a + i, b + j);
            }
          }
        }
      }
    }
    ASSERT_EQ(components.list.size(), areas.size());
    for (std::size_t i = 0; i < areas.size(); ++i) EXPECT_EQ(components.list[i].area, areas[i]);
  });
}

// For figures as wide as their distances: points on each, and near each of its pixels.
TEST(Components, HavePlacesStrewnEvenlyOverThem) {
  for_random_cases(20, [](TestRandom& random) {
    Image<std::uint8_t> gray(120, 90, 1, 200);
    const int spacing = random.integer(1, 6);
    for (int k = 0; k < 3; ++k) {
      const int u0 = random.integer(0, 80), v0 = random.integer(0, 60), width = random.integer(spacing, 40),
                height = random.integer(spacing, 30);
      for (int v = v0; v < v0 + height; ++v)
        for (int u = u0; u < u0 + width; ++u) gray.at(u, v) = 20;
    }
    Components components;
    BlockThresholds blocks;
    ASSERT_EQ(segment(gray, {}, components, blocks).reason, "");
    std::vector<Eigen::Vector2d> places;
    for (std::uint32_t i = 0; i < components.list.size(); ++i) {
      strew(components, i, spacing, places);
      for (const Eigen::Vector2d& place : places) {
        const auto* run = components.run_at(static_cast<int>(place.x()), static_cast<int>(place.y()));
        ASSERT_NE(run, nullptr);
        EXPECT_EQ(run->component, i);
      }
      for (const auto& run : components.runs) {
        if (run.component != i) continue;
        for (int u = run.first; u < run.last; ++u) {
          const auto distance = [&](const Eigen::Vector2d& place) {
            return (place - Eigen::Vector2d(u, run.v)).norm();
          };
          ASSERT_FALSE(places.empty());
          EXPECT_LE(distance(*std::ranges::min_element(places, {}, distance)), 1.5 * spacing);
        }
      }
    }
  });
}

}  // namespace
}  // namespace flexura
