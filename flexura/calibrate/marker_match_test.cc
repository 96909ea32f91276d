#include "flexura/calibrate/marker_match.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace flexura {
namespace {

// Equal markers in a row, of which a picture shows some: shifted by one they look the same.
TEST(MarkerMatch, TakesTheLikelierOfTwoShifts) {
  MarkerScene expected, seen;
  for (int i = 0; i < 12; ++i) {
    expected.markers.emplace_back(MarkerScene::Place{{320.0, 40.0 * i + 20}});
    if (i >= 2 && i < 9) seen.markers.emplace_back(MarkerScene::Place{{324.0, 40.0 * i + 23}});
  }
  const MarkerMatch match =
      match_markers(expected, seen, {640, 480}, {.shift = 10, .turn = 0.05, .scale = 0.05});
  EXPECT_EQ(match.count, 7U);
  for (std::size_t i = 0; i < match.markers.size(); ++i) EXPECT_EQ(match.markers[i], i + 2);
}

}  // namespace
}  // namespace flexura
