// Surfaces with a texture: a mesh, bellows, grain. Their stretches are no markers; markers on them are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/markers.h"
#include "tests/support/drawn_scenes.h"

namespace flexura {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

// Returns the markers on an upright arm 30 px wide, from row 40 to row 440, whose brightness at (u, v) is
// `skin`, with bands of brightness 110 at these rows.
template <typename Skin>
MarkerObservations markers_on(const Skin& skin, const std::vector<double>& rows) {
  DrawnScene scene(320, 480);
  scene.ground([](int, int, int) { return 230; })
      .shape([](int u, int v) { return std::max(std::abs(u - 160) - 15.0, std::abs(v - 240) - 200.0); },
             [&](int u, int v, int) { return skin(u, v); });
  for (const double row : rows) scene.bar(145.5, row - 5, 175.5, row + 5, 110);
  const Image<std::uint8_t> picture = scene.photograph(1, 7);
  ArmFinder finder;
  const ArmObservation& arm = finder.find(picture);
  EXPECT_TRUE(arm.is_found()) << arm.reason;
  return find_markers(picture, arm);
}

double wave(double place, double period) { return std::sin(2 * std::numbers::pi * place / period); }

TEST(MarkerTexture, IsNoMarker) {
  const auto mesh = [](int u, int v) { return 50 + (wave(u + v, 9) * wave(u - v, 9) > 0.2 ? 40 : 0); };
  const auto bellows = [](int, int v) { return 50 + 20 * (1 + wave(v, 12)); };
  const auto windings = [](int u, int v) { return 50 + (wave(v + 0.2 * u, 7) > 0.3 ? 45 : 0); };
  const DrawnTexture random(3, 12);
  const auto grain = [&](int u, int v) { return 30 + 90 * random(u, v); };
  const auto expect_none = [](const MarkerObservations& found) {
    EXPECT_EQ(found.markers.size(), 0U);
    EXPECT_THAT(found.notes, Contains(HasSubstr("has a texture")));
  };
  expect_none(markers_on(mesh, {}));
  expect_none(markers_on(bellows, {}));
  expect_none(markers_on(windings, {}));
  expect_none(markers_on(grain, {}));
}

TEST(MarkerTexture, HidesNoMarkersThatStandOut) {
  const std::vector<double> rows = {120, 210, 300, 390};
  const auto plain = [](int, int) { return 50; };
  const auto mesh = [](int u, int v) { return 50 + (wave(u + v, 9) * wave(u - v, 9) > 0.2 ? 20 : 0); };
  const auto bellows = [](int, int v) { return 50 + 12 * (1 + wave(v, 12)); };
  const auto expect_all = [&](const MarkerObservations& found, bool are_bands) {
    ASSERT_EQ(found.markers.size(), rows.size()) << testing::PrintToString(found.notes);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      // From base to tip: upwards.
      const MarkerObservation& marker = found.markers[rows.size() - 1 - i];
      EXPECT_TRUE(marker.is_band || !are_bands);
      EXPECT_NEAR(marker.pixel.y(), rows[i] - 0.5, 1.2);
    }
  };
  expect_all(markers_on(plain, rows), true);
  // The meshes at a band's edges fray it: it counts as a spot.
  expect_all(markers_on(mesh, rows), false);
  expect_all(markers_on(bellows, rows), true);
}

// Bands with the spacing of markers are markers, however many.
TEST(MarkerTexture, AreNotManyMarkers) {
  std::vector<double> rows;
  for (double row = 65; row < 420; row += 30) rows.push_back(row);
  const MarkerObservations found = markers_on([](int, int) { return 50; }, rows);
  EXPECT_EQ(found.markers.size(), rows.size());
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr("has a texture"))));
}

}  // namespace
}  // namespace flexura
