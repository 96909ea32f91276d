// Pairs of cameras before boards that look the same upside down.
#include "flexura/board/board_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <numbers>
#include <set>
#include <vector>

#include "flexura/board/board_target.h"
#include "flexura/board/intrinsics_fit.h"
#include "flexura/math/so3.h"
#include "tests/support/boards.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using testing::HasSubstr;

BoardBundle order_pair(TestRandom& random, const BoardTarget& target, int views) {
  const Intrinsics lens{.fx = random.uniform(500, 700), .fy = 600, .distortion = {-0.2, 0.05, 0, 0, 0}};
  BoardBundle truth{{lens, lens}, {Pose{}, {so3_exp(random.vector<3>(-0.1, 0.1)), {-0.08, 0.01, 0.02}}}, {}};
  for (int i = 0; i < views; ++i) truth.boards.push_back(random_board(random, target, 0.5));
  return truth;
}

// Each camera counts the points of each view in a random one of the orders.
void shuffle(TestRandom& random, const std::vector<PointOrder>& orders, std::vector<BoardView>& views) {
  for (BoardView& view : views)
    for (auto& pixels : view.pixels) {
      const auto k = static_cast<std::size_t>(random.uniform(0, static_cast<double>(orders.size())));
      if (!pixels.empty()) put_in_order(orders[std::min(k, orders.size() - 1)], pixels);
    }
}

const std::vector<BoardTarget> ambiguous_boards = {
    {.columns = 6, .rows = 4},
    {.columns = 6, .rows = 6},
    {.columns = 5, .rows = 5},
    {.pattern = BoardPattern::circles, .columns = 7, .rows = 4},
    {.pattern = BoardPattern::circles, .columns = 5, .rows = 5},
    {.pattern = BoardPattern::asymmetric_circles, .columns = 4, .rows = 6, .square = 0.015}};

// The board's frame moves rigidly with the order, so the points in the new order have the same shape.
TEST(BoardOrder, EqualOrdersAreRotationsOfTheBoard) {
  for (const BoardTarget& target : ambiguous_boards) {
    const auto points = target.points();
    const auto orders = target.equal_orders();
    const bool is_square =
        target.columns == target.rows && target.pattern != BoardPattern::asymmetric_circles;
    ASSERT_EQ(orders.size(), is_square ? 4U : 2U);
    EXPECT_EQ(std::set<PointOrder>(orders.begin(), orders.end()).size(), orders.size());
    for (const PointOrder& order : orders) {
      const auto sense = [&](std::size_t a, std::size_t b, std::size_t c) {
        const Eigen::Vector2d first = points[b] - points[a], second = points[c] - points[a];
        return first.x() * second.y() - first.y() * second.x();
      };
      for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          EXPECT_NEAR((points[order[i]] - points[order[j]]).norm(), (points[i] - points[j]).norm(), 1e-12);
      const auto last = points.size() - 1;
      EXPECT_NEAR(sense(order[0], order[1], order[last]), sense(0, 1, last), 1e-12) << "mirrored";
    }
  }
  EXPECT_EQ((BoardTarget{.columns = 9, .rows = 6}.equal_orders().size()), 1U);
  EXPECT_EQ((BoardTarget{.pattern = BoardPattern::asymmetric_circles, .columns = 4, .rows = 11}
                 .equal_orders()
                 .size()),
            1U);
}

TEST(BoardOrder, ViewsDecideTheOrderOfAnAmbiguousBoard) {
  for_random_cases(2, [](TestRandom& random) {
    for (const BoardTarget& target : ambiguous_boards) {
      const auto points = target.points();
      const auto orders = target.equal_orders();
      const BoardBundle truth = order_pair(random, target, 6);
      const auto views = seen_boards(truth, points, 0.1, random);
      auto shuffled = views;
      shuffle(random, orders, shuffled);
      const IntrinsicsConfig config{.distortion = 2, .hold_out = 3, .orders = orders};
      const IntrinsicsFit expected = fit_intrinsics(points, views, two_sizes, config),
                          fit = fit_intrinsics(points, shuffled, two_sizes, config);
      ASSERT_TRUE(expected.is_found && fit.is_found) << fit.reason;
      EXPECT_NEAR(fit.rms, expected.rms, 1e-5);
      EXPECT_LT((fit.poses[1].position - expected.poses[1].position).norm(), 1e-6);
      // Held-out views are put in order, too.
      EXPECT_NEAR(*fit.held_out_rms, *expected.held_out_rms, 1e-4);
    }
  });
}

TEST(BoardOrder, WithoutItsOrdersAnAmbiguousBoardDoesNotFit) {
  TestRandom random(case_seed(0));
  const BoardTarget& target = ambiguous_boards[0];
  auto views = seen_boards(order_pair(random, target, 6), target.points(), 0.1, random);
  put_in_order(target.equal_orders()[1], views[2].pixels[1]);
  EXPECT_THAT(fit_intrinsics(target.points(), views, two_sizes, {.distortion = 2}).reason,
              HasSubstr("do not match"));
  EXPECT_TRUE(
      fit_intrinsics(target.points(), views, two_sizes, {.distortion = 2, .orders = target.equal_orders()})
          .is_found);
}

// One common view fits both orders.
TEST(BoardOrder, RefusesWhenTwoOrdersFit) {
  for_random_cases(2, [](TestRandom& random) {
    const BoardTarget& target = ambiguous_boards[0];
    const auto points = target.points();
    auto views = seen_boards(order_pair(random, target, 13), points, 0.1, random);
    for (std::size_t i = 1; i < views.size(); ++i) views[i].pixels[i % 2].clear();
    const IntrinsicsConfig config{.distortion = 0, .orders = target.equal_orders()};
    const IntrinsicsFit fit = fit_intrinsics(points, views, two_sizes, config);
    EXPECT_FALSE(fit.is_found);
    EXPECT_THAT(fit.reason, HasSubstr("camera 2: the board looks the same upside down: its points fit in "
                                      "two orders"));
  });
}

TEST(BoardOrder, OrdersViewsThatTheFirstCameraDoesNotHave) {
  TestRandom random(case_seed(0));
  const BoardTarget& target = ambiguous_boards[0];
  const auto points = target.points();
  BoardBundle truth = order_pair(random, target, 8);
  truth.lenses.push_back(truth.lenses[0]);
  truth.cameras.push_back({so3_exp({0.05, -0.02, 0.01}), {0.06, -0.02, 0.01}});
  auto views = seen_boards(truth, points, 0.1, random);
  views[3].pixels[0].clear();
  const std::vector<std::array<int, 2>> sizes(3, {640, 480});
  const IntrinsicsConfig config{.distortion = 2, .orders = target.equal_orders()};
  const double expected = fit_intrinsics(points, views, sizes, config).rms;
  shuffle(random, target.equal_orders(), views);
  const IntrinsicsFit fit = fit_intrinsics(points, views, sizes, config);
  ASSERT_TRUE(fit.is_found) << fit.reason;
  EXPECT_NEAR(fit.rms, expected, 1e-5);
}

}  // namespace
}  // namespace flexura
