// The borders of a drawn tube in front of textures, searched along their normals.
#include "flexura/vision/rim_search.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/drawn_scenes.h"

namespace flexura {
namespace {

constexpr double ring_u = 380, ring_v = 240, ring_radius = 150, ring_width = 18;

// The left half of a ring before a texture, in light that falls to the right.
DrawnScene ring_scene(std::uint64_t seed, int channels = 1) {
  DrawnScene scene(640, 480, channels);
  const DrawnTexture texture(seed, 30);
  const auto light = [](int u) { return 1.1 - 0.0006 * u; };
  scene.ground([&](int u, int v, int c) { return light(u) * (90 + 130 * texture(u + 40 * c, v)); });
  return scene.arc(ring_u, ring_v, ring_radius, ring_width,
                   [&](int u, int, int c) { return light(u) * (c == 1 ? 70 : 40); });
}

// Cross-sections of the ring where a model expects them: on a ring whose radius is too large by `off`, px. If
// it `grows`, this error and the reach grow along the arm from nearly nothing.
std::vector<ExpectedSection> ring_sections(double off, double reach, bool grows = false) {
  std::vector<ExpectedSection> sections;
  for (int k = 0; k < 90; ++k) {
    const double angle = M_PI * (0.52 + 0.96 * k / 89);
    const Eigen::Vector2d out(std::cos(angle), std::sin(angle)), center(ring_u, ring_v);
    const double share = grows ? k / 89.0 : 1, middle = ring_radius + share * off;
    sections.push_back({{{{center + (middle - 0.5 * ring_width) * out, -out, true},
                          {center + (middle + 0.5 * ring_width) * out, out, true}}},
                        ring_width,
                        std::max(share * reach, 0.8)});
  }
  return sections;
}

double share_seen(const std::vector<SeenSection>& seen) {
  double count = 0;
  for (const SeenSection& one : seen) count += one.rims > 0 ? 1 : 0;
  return count / static_cast<double>(seen.size());
}

// The light of the tube is learned where its place is known, near the base.
TEST(RimSearch, FindsATubeThatIsPixelsFromItsExpectedPlace) {
  for (const int channels : {1, 3}) {
    RimSearch search;
    search.begin(ring_scene(5, channels).photograph(2, 1), nullptr);
    std::vector<SeenSection> seen;
    for (const double off : {-12.0, -5.0, 0.0, 4.0, 11.0}) {
      search.look(ring_sections(off, 6, true), seen);
      EXPECT_GT(share_seen(seen), 0.6) << off;
      double misses = 0, count = 0;
      for (std::size_t k = 0; k < seen.size(); ++k) {
        if (seen[k].rims == 0) continue;
        const double expected = -off * static_cast<double>(k) / 89;
        ++count, misses += std::abs(seen[k].shift - expected) > 2.5 ? 1 : 0;
      }
      EXPECT_LT(misses / count, 0.15) << off << " with " << channels << " channels";
    }
  }
}

TEST(RimSearch, MeasuresEdgesToAFewHundredthsOfAPixel) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    RimSearch search;
    search.begin(ring_scene(seed).photograph(1, seed), nullptr);
    std::vector<SeenSection> seen;
    constexpr double off = 0.7;
    search.refine(ring_sections(off, 0.8), seen);
    EXPECT_GT(share_seen(seen), 0.8);
    double square = 0, by_sigma = 0, count = 0;
    for (const SeenSection& one : seen) {
      if (one.rims < 2) continue;
      const double error = one.shift + off;
      square += error * error, by_sigma += error * error / (one.sigma * one.sigma), ++count;
    }
    ASSERT_GT(count, 30);
    EXPECT_LT(std::sqrt(square / count), 0.08);
    EXPECT_LT(std::sqrt(by_sigma / count), 2.5);
    EXPECT_NEAR(search.width_ratio(), 1, 0.02);
  }
}

TEST(RimSearch, SeesNothingWhereThePartIsHidden) {
  DrawnScene scene = ring_scene(7);
  const DrawnTexture other(70, 25);
  // Something before the ring's middle.
  scene.shape([](int u, int v) { return std::hypot(u - 230, v - 240) - 60; },
              [&](int u, int v, int) { return 60 + 160 * other(u, v); });
  RimSearch search;
  search.begin(scene.photograph(2, 1), nullptr);
  std::vector<SeenSection> seen;
  const std::vector<ExpectedSection> sections = ring_sections(0, 3);
  search.look(sections, seen);
  double hidden_seen = 0, hidden = 0, open_seen = 0, open = 0;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Eigen::Vector2d middle = 0.5 * (sections[i].rims[0].pixel + sections[i].rims[1].pixel);
    const double away = (middle - Eigen::Vector2d(230, 240)).norm();
    if (away < 45) ++hidden, hidden_seen += seen[i].rims > 0 ? 1 : 0;
    if (away > 80) ++open, open_seen += seen[i].rims > 0 ? 1 : 0;
  }
  ASSERT_GT(hidden, 10);
  EXPECT_LT(hidden_seen, 0.6 * hidden);
  EXPECT_GT(open_seen, 0.8 * open);
}

TEST(RimSearch, HeedsTheRegion) {
  RimSearch search;
  const ArmScene lower{.region = {{200, 240}, {400, 240}, {400, 470}, {200, 470}}};
  search.begin(ring_scene(3).photograph(1, 1), &lower);
  EXPECT_EQ(search.complaint(), "");
  std::vector<SeenSection> seen;
  const std::vector<ExpectedSection> sections = ring_sections(0, 0.8);
  search.refine(sections, seen);
  for (std::size_t i = 0; i < sections.size(); ++i)
    if (seen[i].rims > 0) {
      EXPECT_GT(sections[i].rims[0].pixel.y(), 238);
    }
  EXPECT_GT(share_seen(seen), 0.3);
  EXPECT_LT(share_seen(seen), 0.6);
  const ArmScene outside{.region = {{700, 0}, {800, 0}, {800, 100}}};
  search.begin(ring_scene(3).photograph(1, 1), &outside);
  EXPECT_NE(search.complaint(), "");
}

TEST(RimSearch, NotesAWiderTube) {
  RimSearch search;
  search.begin(ring_scene(4).photograph(1, 1), nullptr);
  std::vector<ExpectedSection> sections = ring_sections(0, 0.8);
  for (ExpectedSection& section : sections) {
    section.width -= 2;
    for (ExpectedRim& rim : section.rims) rim.pixel -= rim.outward;
  }
  std::vector<SeenSection> seen;
  search.refine(sections, seen);
  EXPECT_NEAR(search.width_ratio(), ring_width / (ring_width - 2), 0.01);
  for (const SeenSection& one : seen)
    if (one.rims == 2) {
      EXPECT_LT(std::abs(one.shift), 0.5);
    }
}

}  // namespace
}  // namespace flexura
