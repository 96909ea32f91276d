#include "flexura/board/lens_misfit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/board/board_target.h"
#include "flexura/board/intrinsics_fit.h"
#include "tests/support/boards.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using testing::HasSubstr;

const BoardTarget misfit_board{.columns = 9, .rows = 6};

// Views by a lens whose pixel is f h(theta) from the middle, with noise of 0.1 px.
template <typename Height>
std::vector<BoardView> lens_views(TestRandom& random, double focal, double aside, const Height& height) {
  std::vector<BoardView> views;
  for (int i = 0; i < 12; ++i) {
    const Pose X_CB = random_board(random, misfit_board, 0.15, 0.6, aside);
    BoardView& view = views.emplace_back();
    auto& pixels = view.pixels.emplace_back();
    for (const auto& point : misfit_board.points()) {
      const Eigen::Vector3d p = X_CB * Eigen::Vector3d(point.x(), point.y(), 0);
      const double theta = std::atan2(p.head<2>().norm(), p.z());
      pixels.push_back(Eigen::Vector2d(319.5, 239.5) + focal * height(theta) * p.head<2>().normalized() +
                       0.1 * Eigen::Vector2d(normal_number(random), normal_number(random)));
    }
  }
  return views;
}

// Equidistant (f theta), equisolid (2 f sin(theta / 2)) and stereographic (2 f tan(theta / 2)) lenses.
TEST(LensMisfit, AFisheyeLensIsNamed) {
  const auto points = misfit_board.points();
  for_random_cases(2, [&](TestRandom& random) {
    for (const double focal : {150.0, 200.0}) {
      for (const auto& views :
           {lens_views(random, focal, 1.2, [](double angle) { return angle; }),
            lens_views(random, focal, 1.2, [](double angle) { return 2 * std::sin(0.5 * angle); })}) {
        const IntrinsicsFit none = fit_intrinsics(points, views, one_size, {.distortion = 0});
        EXPECT_FALSE(none.is_found) << none.rms;
        EXPECT_THAT(none.reason, HasSubstr("the lens model does not fit"))
            << none.rms << " " << none.cameras[0].misfit.likeness << " "
            << none.cameras[0].misfit.radial_share;
        // Two coefficients bend enough to hide most of it.
        const IntrinsicsFit two = fit_intrinsics(points, views, one_size, {.distortion = 2});
        ASSERT_FALSE(two.cameras.empty()) << two.reason;
        EXPECT_TRUE(two.cameras[0].misfit.is_systematic()) << two.rms;
      }
    }
  });
}

// A board bent by a hundredth of its width is named as the second cause.
TEST(LensMisfit, ABentBoardIsNotTakenForALensAlone) {
  const auto points = misfit_board.points();
  for_random_cases(2, [&](TestRandom& random) {
    const Lens lens({.fx = 3000, .fy = 3000});
    std::vector<BoardView> views;
    for (int i = 0; i < 12; ++i) {
      const Pose X_CB = random_board(random, misfit_board, 1.2, 0.6, 0.02);
      BoardView& view = views.emplace_back();
      auto& pixels = view.pixels.emplace_back();
      for (const auto& point : points)
        pixels.push_back(
            *lens.project(X_CB * Eigen::Vector3d(point.x(), point.y(), 4 * std::pow(point.x() - 0.1, 2))));
    }
    const IntrinsicsFit fit = fit_intrinsics(points, views, one_size, {.distortion = 0});
    EXPECT_FALSE(fit.is_found);
    EXPECT_THAT(fit.reason, HasSubstr("or the board is not flat")) << fit.rms;
  });
}

TEST(LensMisfit, NoiseAndAGoodLensAreNot) {
  const auto points = misfit_board.points();
  for_random_cases(4, [&](TestRandom& random) {
    auto views = lens_views(random, 500, 0.2, [](double angle) { return std::tan(angle); });
    // Large noise is no fault of the lens.
    for (BoardView& view : views)
      for (Eigen::Vector2d& pixel : view.pixels[0])
        pixel += 3 * Eigen::Vector2d(normal_number(random), normal_number(random));
    const IntrinsicsFit fit = fit_intrinsics(points, views, one_size, {.distortion = 2});
    EXPECT_EQ(fit.reason.find("the lens model"), std::string::npos) << fit.reason;
    ASSERT_FALSE(fit.cameras.empty());
    EXPECT_LT(fit.cameras[0].misfit.likeness, 0.2);
    EXPECT_LT(fit.cameras[0].misfit.radial_share, 0.05);
    EXPECT_NEAR(fit.cameras[0].misfit.rms, fit.rms, 1e-9);
  });
}

}  // namespace
}  // namespace flexura
