// The lens models in comparison with OpenCV, and calibrations with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <vector>

#include "flexura/board/board_target.h"
#include "flexura/board/intrinsics_fit.h"
#include "flexura/board/lens_comparison.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/math/so3.h"
#include "tests/support/boards.h"
#include "tests/support/mahalanobis.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using testing::HasSubstr;

const BoardTarget wide_board{.columns = 9, .rows = 6};
const std::vector<Eigen::Vector2d> wide_points = wide_board.points();
constexpr std::array<LensModel, 3> all_models = {LensModel::brown, LensModel::rational, LensModel::fisheye};

// A wide lens of each model.
Intrinsics lens_of_model(TestRandom& random, LensModel model) {
  const double focal = model == LensModel::fisheye ? random.uniform(180, 260) : random.uniform(260, 340);
  Intrinsics lens{.fx = focal,
                  .fy = focal * random.uniform(0.98, 1.02),
                  .cx = random.uniform(310, 330),
                  .cy = random.uniform(230, 250)};
  const auto small = [&] { return random.uniform(-1e-3, 1e-3); };
  switch (model) {
    case LensModel::brown:
      lens.distortion = {random.uniform(-0.15, 0.05), random.uniform(-0.01, 0.02), small(), small(), 0.001};
      break;
    case LensModel::rational:
      // A compact form of f theta, as the model is used for wide lenses.
      lens.distortion = {random.uniform(0.24, 0.3), 0.01, small(), small(), 0.001, random.uniform(0.58, 0.64),
                         random.uniform(0.05, 0.1), 0.005};
      break;
    case LensModel::fisheye:
      lens.distortion = {random.uniform(-0.05, 0.05), random.uniform(-0.02, 0.02), small(), small()};
      break;
  }
  return lens;
}

// Boards close to the camera, in all parts of the picture.
BoardBundle wide_camera(TestRandom& random, LensModel model, int views) {
  BoardBundle truth{{lens_of_model(random, model)}, {Pose{}}, {}};
  const Lens lens(truth.lenses[0]);
  while (truth.boards.size() < static_cast<std::size_t>(views)) {
    const Pose X_CB = random_board(random, wide_board, 0.15, 0.6, 1);
    const bool is_shown = std::ranges::all_of(wide_points, [&](const Eigen::Vector2d& point) {
      const auto pixel = lens.project(X_CB * Eigen::Vector3d(point.x(), point.y(), 0));
      return pixel && pixel->minCoeff() > 0 && pixel->x() < 639 && pixel->y() < 479;
    });
    if (is_shown) truth.boards.push_back(X_CB);
  }
  return truth;
}

std::vector<cv::Point3f> flat(const std::vector<Eigen::Vector2d>& points) {
  std::vector<cv::Point3f> all;
  for (const auto& point : points)
    all.emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()), 0.0F);
  return all;
}

TEST(LensModels, ProjectAsOpenCvDoes) {
  for_random_cases(300, [](TestRandom& random) {
    const Intrinsics lens = lens_of_model(random, all_models[static_cast<std::size_t>(random.integer(0, 2))]);
    const Lens own(lens);
    const double rim = std::min(0.95 * own.largest_radius(), 2.0);
    std::vector<cv::Point3d> points;
    std::vector<Eigen::Vector2d> pixels;
    for (int i = 0; i < 20; ++i) {
      const double radius = random.uniform(0, rim), angle = random.uniform(-3.2, 3.2),
                   depth = random.uniform(0.5, 3);
      const Eigen::Vector3d p(depth * radius * std::cos(angle), depth * radius * std::sin(angle), depth);
      points.emplace_back(p.x(), p.y(), p.z());
      pixels.push_back(*own.project(p));
    }
    const cv::Matx33d K(lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
    const std::vector<double> coefficients(lens.distortion.begin(), lens.distortion.end());
    const cv::Vec3d none(0, 0, 0);
    std::vector<cv::Point2d> theirs;
    if (lens.distortion.model() == LensModel::fisheye) {
      cv::fisheye::projectPoints(points, theirs, none, none, K, coefficients);
    } else {
      cv::projectPoints(points, none, none, K, coefficients, theirs);
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      EXPECT_NEAR(pixels[i].x(), theirs[i].x, 1e-9);
      EXPECT_NEAR(pixels[i].y(), theirs[i].y, 1e-9);
    }
  });
}

// Without noise the pixels of the whole picture are right, even where coefficients make up for each other.
TEST(LensModels, AreRecoveredWithoutNoise) {
  for (const LensModel model : all_models) {
    for_random_cases(4, [&](TestRandom& random) {
      const BoardBundle truth = wide_camera(random, model, 12);
      const IntrinsicsFit fit =
          fit_intrinsics(wide_points, seen_boards(truth, wide_points, 0, random), one_size, {.model = model});
      ASSERT_TRUE(fit.is_found) << name_of(model) << ": " << fit.reason;
      EXPECT_LT(fit.rms, 1e-4);
      EXPECT_EQ(fit.cameras[0].lens.distortion.model(), model);
      const Lens found(fit.cameras[0].lens), right(truth.lenses[0]);
      const Eigen::Vector2d middle(truth.lenses[0].cx, truth.lenses[0].cy);
      double seen = 0;
      for (const Pose& X_CB : truth.boards)
        for (const auto& point : wide_points)
          seen = std::max(seen,
                          (*right.project(X_CB * Eigen::Vector3d(point.x(), point.y(), 0)) - middle).norm());
      for (double u = 40; u < 640; u += 80) {
        for (double v = 40; v < 480; v += 80) {
          const auto ray = right.unproject({u, v});
          if (!ray || (Eigen::Vector2d(u, v) - middle).norm() > 0.9 * seen) continue;
          const auto pixel = found.project(ray->homogeneous());
          ASSERT_TRUE(pixel);
          EXPECT_LT((*pixel - Eigen::Vector2d(u, v)).norm(), 0.02) << name_of(model) << " " << u << " " << v;
        }
      }
    });
  }
}

// OpenCV minimises the same sum of squares. Its points have single precision.
TEST(LensModels, FitAsWellAsOpenCv) {
  for (const LensModel model : {LensModel::rational, LensModel::fisheye}) {
    for_random_cases(3, [&](TestRandom& random) {
      const BoardBundle truth = wide_camera(random, model, 12);
      const auto views = seen_boards(truth, wide_points, 0.2, random);
      const IntrinsicsFit fit = fit_intrinsics(wide_points, views, one_size, {.model = model});
      ASSERT_TRUE(fit.is_found) << fit.reason;
      EXPECT_LT(fit.steps, 300);
      std::vector<std::vector<cv::Point2f>> seen;
      for (const BoardView& view : views) {
        auto& pixels = seen.emplace_back();
        for (const auto& pixel : view.pixels[0])
          pixels.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
      }
      const std::vector<std::vector<cv::Point3f>> there(views.size(), flat(wide_points));
      const Intrinsics& start = truth.lenses[0];
      cv::Mat K = (cv::Mat_<double>(3, 3) << start.fx, 0, start.cx, 0, start.fy, start.cy, 0, 0, 1),
              distortion = cv::Mat::zeros(4, 1, CV_64F);
      std::vector<cv::Mat> rotations, positions;
      const cv::TermCriteria end(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 300, 1e-12);
      double rms = 0;
      if (model == LensModel::fisheye) {
        rms = cv::fisheye::calibrate(there, seen, {640, 480}, K, distortion, rotations, positions,
                                     cv::fisheye::CALIB_USE_INTRINSIC_GUESS | cv::fisheye::CALIB_FIX_SKEW |
                                         cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC,
                                     end);
      } else {
        distortion.release();
        rms = cv::calibrateCamera(there, seen, {640, 480}, K, distortion, rotations, positions,
                                  cv::CALIB_RATIONAL_MODEL | cv::CALIB_USE_INTRINSIC_GUESS, end);
      }
      // The minimum of the rational model is so flat that either may end a thousandth above it.
      EXPECT_LT(fit.rms, rms * (1 + 1e-3)) << name_of(model);
      if (model == LensModel::fisheye) {
        EXPECT_NEAR(fit.rms, rms, 1e-4 * rms);
        EXPECT_NEAR(fit.cameras[0].lens.fx, K.at<double>(0, 0), 0.05);
        EXPECT_NEAR(fit.cameras[0].lens.distortion[0], distortion.at<double>(0), 1e-3);
      }
    });
  }
}

TEST(LensModels, AFisheyeLensIsAsFarOffAsItsCovarianceSays) {
  constexpr int cases = 60 / one_case_of, size = 8;
  constexpr double sigma = 0.15;
  double sum = 0;
  for (int i = 0; i < cases; ++i) {
    TestRandom random(case_seed(i));
    const BoardBundle truth = wide_camera(random, LensModel::fisheye, 10);
    const IntrinsicsFit fit = fit_intrinsics(wide_points, seen_boards(truth, wide_points, sigma, random),
                                             one_size, {.model = LensModel::fisheye});
    ASSERT_TRUE(fit.is_found) << "seed " << case_seed(i) << ": " << fit.reason;
    const Intrinsics &found = fit.cameras[0].lens, &right = truth.lenses[0];
    Eigen::Vector<double, size> error;
    error << found.fx - right.fx, found.fy - right.fy, found.cx - right.cx, found.cy - right.cy,
        Eigen::Map<const Eigen::Vector4d>(found.distortion.data()) -
            Eigen::Map<const Eigen::Vector4d>(right.distortion.data());
    const Eigen::Matrix<double, size, size> covariance =
        fit.cameras[0].covariance.topLeftCorner<size, size>();
    sum += mahalanobis_square(covariance, error);
  }
  // The sum of n squares of normal numbers of variance 1 is n +- sqrt(2 n).
  EXPECT_NEAR(sum, cases * size, 4 * std::sqrt(2.0 * cases * size));
}

// Pictures of each lens are explained by its own model. A rational lens contains a lens of the model brown,
// but needs three more coefficients.
TEST(LensModels, AreToldApart) {
  for (const LensModel model : {LensModel::brown, LensModel::fisheye}) {
    for_random_cases(3, [&](TestRandom& random) {
      const BoardBundle truth = wide_camera(random, model, 15);
      const LensComparison comparison =
          compare_lenses(wide_points, seen_boards(truth, wide_points, 0.1, random), one_size);
      ASSERT_EQ(comparison.trials.size(), 3U);
      EXPECT_EQ(comparison.trials[comparison.best].model, model);
      EXPECT_TRUE(comparison.trials[comparison.best].fit.is_found);
    });
  }
  // Over small angles, each model describes the others.
  for_random_cases(6, [&](TestRandom& random) {
    Intrinsics narrow{.fx = random.uniform(600, 1500)};
    narrow.fy = narrow.fx;
    narrow.distortion = {random.uniform(-0.3, 0.1), random.uniform(0, 0.1), 0, 0, 0};
    if (random.integer(0, 2) == 0) narrow.distortion = {};
    BoardBundle truth{{narrow}, {Pose{}}, {}};
    for (int i = 0; i < 15; ++i)
      truth.boards.push_back(random_board(random, wide_board, 0.7e-3 * narrow.fx, 0.6, 0.1));
    const double sigma = random.integer(0, 3) == 0 ? 0 : 0.1;
    const LensComparison comparison =
        compare_lenses(wide_points, seen_boards(truth, wide_points, sigma, random), one_size);
    EXPECT_EQ(comparison.trials[comparison.best].model, LensModel::brown) << narrow.fx << ", noise " << sigma;
  });
  // A wide rational lens is not well described by brown.
  for_random_cases(3, [&](TestRandom& random) {
    const BoardBundle truth = wide_camera(random, LensModel::rational, 15);
    const LensComparison comparison =
        compare_lenses(wide_points, seen_boards(truth, wide_points, 0.02, random), one_size);
    EXPECT_NE(comparison.trials[comparison.best].model, LensModel::brown);
    EXPECT_NEAR(comparison.trials[comparison.best].fit.rms, 0.02 * std::sqrt(2), 0.01);
  });
}

TEST(LensModels, NumbersOfCoefficientsAreThoseOfTheModel) {
  TestRandom random(case_seed(0));
  const BoardBundle truth = wide_camera(random, LensModel::fisheye, 10);
  const auto views = seen_boards(truth, wide_points, 0.1, random);
  const IntrinsicsFit two =
      fit_intrinsics(wide_points, views, one_size, {.model = LensModel::fisheye, .distortion = 2});
  ASSERT_TRUE(two.is_found) << two.reason;
  EXPECT_EQ(two.cameras[0].lens.distortion[2], 0);
  EXPECT_EQ(two.cameras[0].covariance(6, 6), 0);
  // Coefficients that are not estimated are 0, also of a rational lens.
  const BoardBundle rational = wide_camera(random, LensModel::rational, 10);
  const auto other_views = seen_boards(rational, wide_points, 0.1, random);
  for (const int count : {0, 2, 5, 6, 7}) {
    const IntrinsicsFit fit = fit_intrinsics(wide_points, other_views, one_size,
                                             {.model = LensModel::rational, .distortion = count});
    ASSERT_FALSE(fit.cameras.empty()) << fit.reason;
    const Distortion& found = fit.cameras[0].lens.distortion;
    for (auto i = static_cast<std::size_t>(count); i < found.size(); ++i) EXPECT_EQ(found[i], 0) << count;
  }
  EXPECT_THROW(
      (void)fit_intrinsics(wide_points, views, one_size, {.model = LensModel::fisheye, .distortion = 5}),
      std::invalid_argument);
  EXPECT_THROW(
      (void)fit_intrinsics(wide_points, views, one_size, {.model = LensModel::brown, .distortion = 6}),
      std::invalid_argument);
}

}  // namespace
}  // namespace flexura
