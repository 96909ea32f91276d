#include "flexura/board/intrinsics_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <vector>

#include "flexura/board/board_target.h"
#include "flexura/math/dense.h"
#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "tests/support/boards.h"
#include "tests/support/mahalanobis.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using testing::Contains;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const BoardTarget board;
const std::vector<Eigen::Vector2d> points = board.points();

Intrinsics random_intrinsics(TestRandom& random) {
  Intrinsics lens{.fx = random.uniform(450, 900),
                  .fy = 0,
                  .cx = random.uniform(300, 340),
                  .cy = random.uniform(225, 255)};
  lens.fy = lens.fx * random.uniform(0.98, 1.02);
  lens.distortion = {random.uniform(-0.3, 0.1), random.uniform(-0.05, 0.1), random.uniform(-2e-3, 2e-3),
                     random.uniform(-2e-3, 2e-3), random.uniform(-0.02, 0.02)};
  return lens;
}

// The board covers about a third of the image.
double distance_for(const Intrinsics& lens) { return 0.7e-3 * lens.fx; }

BoardBundle random_camera(TestRandom& random, int views) {
  BoardBundle truth{{random_intrinsics(random)}, {Pose{}}, {}};
  for (int i = 0; i < views; ++i)
    truth.boards.push_back(random_board(random, board, distance_for(truth.lenses[0])));
  return truth;
}

BoardBundle random_pair(TestRandom& random, int views) {
  BoardBundle truth = random_camera(random, views);
  Intrinsics other = truth.lenses[0];
  other.fx *= 1.03, other.fy *= 1.03, other.cx += 7, other.distortion[0] += 0.02;
  truth.lenses.push_back(other);
  truth.cameras.push_back({so3_exp(random.vector<3>(-0.1, 0.1)), random.vector<3>(-0.08, 0.08)});
  return truth;
}

constexpr int brown_count = 9;  // Parameters of the lens model brown.

Eigen::Vector<double, brown_count> numbers(const Intrinsics& lens) {
  Eigen::Vector<double, brown_count> result;
  result << lens.fx, lens.fy, lens.cx, lens.cy,
      Eigen::Map<const Eigen::Vector<double, 5>>(lens.distortion.data());
  return result;
}

Eigen::Vector<double, 6> motion(const Pose& from, const Pose& to) {
  Eigen::Vector<double, 6> result;
  result << to.position - from.position, so3_log(to.rotation * from.rotation.transpose());
  return result;
}

TEST(IntrinsicsFit, SolvesTheMinimalCaseExactly) {
  for_random_cases(20, [](TestRandom& random) {
    BoardBundle truth = random_camera(random, 2);
    truth.lenses[0].distortion = {};
    // Two boards tilted about different axes; parallel ones give no information.
    truth.boards[0].rotation = so3_exp({0.5, 0.1, 0}), truth.boards[1].rotation = so3_exp({-0.1, 0.5, 0.2});
    const auto views = seen_boards(truth, points, 0, random);
    const IntrinsicsFit fit = fit_intrinsics(points, views, one_size, {.distortion = 0});
    ASSERT_TRUE(fit.is_found) << fit.reason;
    EXPECT_LT((numbers(fit.cameras[0].lens) - numbers(truth.lenses[0])).norm(), 1e-6);
    EXPECT_LT(fit.rms, 1e-8);
  });
}

TEST(IntrinsicsFit, RecoversAPairWithoutNoise) {
  for_random_cases(12, [](TestRandom& random) {
    const BoardBundle truth = random_pair(random, 6);
    const IntrinsicsFit fit = fit_intrinsics(points, seen_boards(truth, points, 0, random), two_sizes);
    ASSERT_TRUE(fit.is_found) << fit.reason;
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_LT((numbers(fit.cameras[i].lens) - numbers(truth.lenses[i])).norm(), 1e-4);
    EXPECT_LT(motion(truth.cameras[1], fit.poses[1]).norm(), 1e-7);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_LT(motion(truth.boards[i], *fit.boards[i]).norm(), 1e-7);
  });
}

// The sum of n squares of normal numbers of variance 1 is n +- sqrt(2 n).
void expect_chi_square(double sum, int freedom) { EXPECT_NEAR(sum, freedom, 4 * std::sqrt(2.0 * freedom)); }

TEST(IntrinsicsFit, IsAsFarOffAsItsCovarianceSays) {
  constexpr int cases = 80 / one_case_of;
  constexpr double sigma = 0.15;
  double lens_sum = 0, pose_sum = 0;
  Eigen::Vector<double, brown_count> parts = Eigen::Vector<double, brown_count>::Zero();
  for (int i = 0; i < cases; ++i) {
    TestRandom random(case_seed(i));
    const BoardBundle truth = random_pair(random, 8);
    const IntrinsicsFit fit = fit_intrinsics(points, seen_boards(truth, points, sigma, random), two_sizes);
    ASSERT_TRUE(fit.is_found) << "seed " << case_seed(i) << ": " << fit.reason;
    EXPECT_NEAR(fit.noise, sigma, 0.1 * sigma);
    for (std::size_t camera = 0; camera < 2; ++camera) {
      const Eigen::Vector<double, brown_count> error =
          numbers(fit.cameras[camera].lens) - numbers(truth.lenses[camera]);
      if (camera == 0)
        lens_sum += mahalanobis_square(
            fit.cameras[camera].covariance.topLeftCorner<brown_count, brown_count>(), error);
      if (camera == 0)
        for (int j = 0; j < brown_count; ++j)
          parts[j] += std::pow(error[j] / fit.cameras[camera].sigma(j), 2);
    }
    const Eigen::Vector<double, 6> error = motion(fit.poses[1], truth.cameras[1]);
    pose_sum += mahalanobis_square(fit.pose_covariance[1], error);
  }
  expect_chi_square(lens_sum, cases * brown_count);
  expect_chi_square(pose_sum, cases * 6);
  for (int j = 0; j < brown_count; ++j) expect_chi_square(parts[j], cases);
}

// All pixels of a bundle after a step of the cameras' and boards' unknowns.
Eigen::VectorXd pixels_of(const BoardBundle& bundle, const Eigen::VectorXd& step) {
  BoardBundle moved = bundle;
  Eigen::Index at = 0;
  for (Intrinsics& lens : moved.lenses) {
    lens.fx += step[at++], lens.fy += step[at++], lens.cx += step[at++], lens.cy += step[at++];
    for (double& coefficient : lens.distortion) coefficient += step[at++];
  }
  const auto move = [&](Pose& pose) {
    pose.position += step.segment<3>(at), pose.rotation = so3_exp(step.segment<3>(at + 3)) * pose.rotation;
    at += 6;
  };
  move(moved.cameras[1]);
  for (Pose& pose : moved.boards) move(pose);
  TestRandom none(1);
  std::vector<double> all;
  for (const BoardView& view : seen_boards(moved, points, 0, none))
    for (const auto& pixels : view.pixels)
      for (const Eigen::Vector2d& pixel : pixels) all.insert(all.end(), {pixel.x(), pixel.y()});
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

TEST(BoardBundle, HasTheDerivativesThatDifferencesHave) {
  TestRandom random(case_seed(0));
  const BoardBundle truth = random_pair(random, 2);
  const auto views = seen_boards(truth, points, 0, random);
  const BundleFit fit = fit_bundle(points, views, truth, {.most_steps = 1});
  const Eigen::Index cameras = 2 * brown_count + 6, all = cameras + 12;
  const auto numeric = numerical_jacobian([&](const Eigen::VectorXd& step) { return pixels_of(truth, step); },
                                          Eigen::VectorXd::Zero(all), 0.01);
  const Eigen::MatrixXd normal = numeric.value.transpose() * numeric.value;
  const Eigen::MatrixXd eliminated =
      normal.topLeftCorner(cameras, cameras) -
      normal.topRightCorner(cameras, 12) *
          Cholesky(normal.bottomRightCorner(12, 12)).solve(normal.bottomLeftCorner(12, cameras));
  ASSERT_EQ(fit.information.rows(), cameras);
  for (Eigen::Index i = 0; i < cameras; ++i)
    for (Eigen::Index j = 0; j < cameras; ++j)
      EXPECT_NEAR(fit.information(i, j), eliminated(i, j), 1e-5 * std::sqrt(normal(i, i) * normal(j, j)))
          << i << " " << j;
}

TEST(BoardBundle, ACameraThatSeesNoBoardStaysAsItIs) {
  for_random_cases(4, [](TestRandom& random) {
    const BoardBundle truth = random_pair(random, 6);
    auto views = seen_boards(truth, points, 0, random);
    for (BoardView& view : views) view.pixels[1].clear();
    BoardBundle start = truth;
    start.lenses[0].fx *= 1.01, start.boards[2].position.z() += 0.01;
    const BundleFit fit = fit_bundle(points, views, start, {});
    EXPECT_TRUE(fit.is_converged);
    EXPECT_NEAR(fit.bundle.lenses[0].fx, truth.lenses[0].fx, 1e-3);
    EXPECT_EQ(numbers(fit.bundle.lenses[1]), numbers(truth.lenses[1]));
    EXPECT_EQ(fit.bundle.cameras[1].position, truth.cameras[1].position);
  });
}

TEST(IntrinsicsFit, IsOpenCVs) {
  for_random_cases(4, [](TestRandom& random) {
    const BoardBundle truth = random_camera(random, 8);
    const auto views = seen_boards(truth, points, 0.3, random);
    const IntrinsicsFit fit = fit_intrinsics(points, views, one_size);
    ASSERT_TRUE(fit.is_found) << fit.reason;
    std::vector<std::vector<cv::Point3f>> there(views.size());
    std::vector<std::vector<cv::Point2f>> seen(views.size());
    for (std::size_t view = 0; view < views.size(); ++view) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector2f point = points[i].cast<float>(), pixel = views[view].pixels[0][i].cast<float>();
        there[view].emplace_back(point.x(), point.y(), 0.0F);
        seen[view].emplace_back(pixel.x(), pixel.y());
      }
    }
    cv::Mat K, distortion, sigmas, unused;
    std::vector<cv::Mat> rotations, positions;
    const double rms = cv::calibrateCamera(
        there, seen, {640, 480}, K, distortion, rotations, positions, sigmas, unused, unused, 0,
        cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 1e-14));
    EXPECT_NEAR(fit.rms, rms, 1e-6);
    EXPECT_NEAR(fit.cameras[0].lens.fx, K.at<double>(0, 0), 0.02 * fit.cameras[0].sigma(0));
    EXPECT_NEAR(fit.cameras[0].lens.cy, K.at<double>(1, 2), 0.02 * fit.cameras[0].sigma(3));
    // OpenCV divides by the points minus the unknowns, not by their coordinates (two per point) minus the
    // unknowns.
    const double unknowns = brown_count + 6.0 * 8, count = 8.0 * static_cast<double>(points.size());
    const double ratio = std::sqrt((count - unknowns) / (2 * count - unknowns));
    for (int i = 0; i < brown_count; ++i)
      EXPECT_NEAR(fit.cameras[0].sigma(i) / sigmas.at<double>(i), ratio, 1e-4) << i;
  });
}

TEST(IntrinsicsFit, KnowsWhatParallelBoardsDoNotTell) {
  for_random_cases(4, [](TestRandom& random) {
    BoardBundle truth = random_camera(random, 5);
    for (Pose& pose : truth.boards) pose.rotation.setIdentity();
    const auto views = seen_boards(truth, points, 0.1, random);
    for (const int distortion : {0, 2}) {
      const IntrinsicsFit fit = fit_intrinsics(points, views, one_size, {.distortion = distortion});
      EXPECT_FALSE(fit.is_found);
      EXPECT_THAT(fit.reason, HasSubstr("tilted"));
    }
  });
}

TEST(IntrinsicsFit, KnowsThatBoardsInTheMiddleDoNotTellDistortion) {
  TestRandom random(case_seed(0));
  const Intrinsics lens{.fx = 400, .fy = 400};
  BoardBundle truth{{lens}, {Pose{}}, {}};
  for (int i = 0; i < 10; ++i) truth.boards.push_back(random_board(random, board, 0.6, 0.8, 0.02));
  const IntrinsicsFit middle = fit_intrinsics(points, seen_boards(truth, points, 0.1, random), one_size);
  ASSERT_TRUE(middle.is_found) << middle.reason;
  EXPECT_GT(middle.cameras[0].corner_sigma, 8);
  EXPECT_THAT(middle.cameras[0].undetermined, Contains(8));
  // Boards all over the image determine it.
  for (Pose& pose : truth.boards) pose = random_board(random, board, 0.25, 0.6, 0.3);
  const IntrinsicsFit all_over = fit_intrinsics(points, seen_boards(truth, points, 0.1, random), one_size);
  ASSERT_TRUE(all_over.is_found) << all_over.reason;
  EXPECT_LT(all_over.cameras[0].corner_sigma, 2);
  EXPECT_THAT(all_over.cameras[0].undetermined, IsEmpty());
}

TEST(IntrinsicsFit, PredictsHeldOutViewsAsWellAsItExplainsTheOthers) {
  TestRandom random(case_seed(0));
  const BoardBundle truth = random_pair(random, 20);
  auto views = seen_boards(truth, points, 0.2, random);
  // A view without any camera does not count.
  views.insert(views.begin() + 1, BoardView{{{}, {}}});
  const IntrinsicsFit fit = fit_intrinsics(points, views, two_sizes, {.hold_out = 4});
  ASSERT_TRUE(fit.is_found) << fit.reason;
  EXPECT_EQ(std::count(fit.is_held_out.begin(), fit.is_held_out.end(), true), 5);
  EXPECT_FALSE(fit.is_held_out[1]);
  EXPECT_TRUE(fit.is_held_out[4]);
  EXPECT_EQ(fit.points, std::size_t{30} * points.size());
  EXPECT_NEAR(*fit.held_out_rms, 0.2 * std::sqrt(2.0), 0.02);
  EXPECT_TRUE(fit.cameras[1].view_rms[4].has_value());
  EXPECT_FALSE(fit.cameras[1].view_rms[1].has_value());
}

TEST(IntrinsicsFit, UsesViewsThatOneCameraHas) {
  TestRandom random(case_seed(0));
  const BoardBundle truth = random_pair(random, 8);
  auto views = seen_boards(truth, points, 0.1, random);
  for (const std::size_t view : {0U, 2U}) views[view].pixels[0].clear();
  for (const std::size_t view : {1U, 3U}) views[view].pixels[1].clear();
  const IntrinsicsFit fit = fit_intrinsics(points, views, two_sizes);
  ASSERT_TRUE(fit.is_found) << fit.reason;
  EXPECT_EQ(fit.points, 12 * points.size());
  EXPECT_LT(motion(truth.boards[0], *fit.boards[0]).norm(), 0.01);
  // Boards never seen by both cameras do not determine the second camera's pose.
  for (std::size_t view = 4; view < 8; ++view) views[view].pixels[view % 2].clear();
  EXPECT_THAT(fit_intrinsics(points, views, two_sizes).reason, HasSubstr("together"));
}

TEST(IntrinsicsFit, KnowsThatPicturesDoNotBelongTogether) {
  for_random_cases(4, [](TestRandom& random) {
    const BoardBundle truth = random_pair(random, 8);
    const auto views = seen_boards(truth, points, 0.1, random);
    // All of the second camera's views shifted by one; and a single one that shows the board in its previous
    // position.
    auto shifted = views, one = views;
    for (std::size_t i = 0; i < views.size(); ++i)
      shifted[i].pixels[1] = views[(i + 1) % views.size()].pixels[1];
    one[5].pixels[1] = views[4].pixels[1];
    for (const auto& wrong : {shifted, one}) {
      const IntrinsicsFit fit = fit_intrinsics(points, wrong, two_sizes);
      EXPECT_FALSE(fit.is_found);
      EXPECT_THAT(fit.reason, HasSubstr("camera 2: its pictures do not match those of camera 1"));
      EXPECT_THAT(fit.reason,
                  ContainsRegex("0\\.1[0-9]* px for each camera alone and [0-9.]+ px for both together"));
    }
    EXPECT_THAT(fit_intrinsics(points, one, two_sizes).reason,
                HasSubstr("view 6 gives a pose that differs by"));
    EXPECT_TRUE(fit_intrinsics(points, views, two_sizes).is_found);
  });
}

TEST(IntrinsicsFit, SaysWhatIsMissing) {
  TestRandom random(case_seed(0));
  const auto views = seen_boards(random_camera(random, 1), points, 0.1, random);
  EXPECT_THAT(fit_intrinsics(points, views, one_size).reason, HasSubstr("one view"));
  const std::vector<BoardView> nothing = {{{{}}}, {{{}}}};
  EXPECT_THAT(fit_intrinsics(points, nothing, one_size).reason, HasSubstr("no view"));
  const std::vector<BoardView> line(3, BoardView{{std::vector<Eigen::Vector2d>(points.size(), {3, 4})}});
  EXPECT_FALSE(fit_intrinsics(points, line, one_size).is_found);
  EXPECT_THROW((void)fit_intrinsics(points, views, two_sizes), std::invalid_argument);
  EXPECT_THROW((void)fit_intrinsics(points, views, one_size, {.distortion = 6}), std::invalid_argument);
}

TEST(IntrinsicsFit, KeepsCoefficientsThatAreNotEstimatedAtZero) {
  TestRandom random(case_seed(0));
  const IntrinsicsFit fit = fit_intrinsics(points, seen_boards(random_camera(random, 6), points, 0.1, random),
                                           one_size, {.distortion = 2});
  ASSERT_EQ(fit.cameras.size(), 1U);
  EXPECT_THAT(
      std::vector<double>(fit.cameras[0].lens.distortion.begin() + 2, fit.cameras[0].lens.distortion.end()),
      ElementsAre(0, 0, 0));
  EXPECT_EQ(fit.cameras[0].sigma(8), 0);
  EXPECT_GT(fit.cameras[0].sigma(5), 0);
}

// Points that are not seen (NaN) are left out, whichever they are.
TEST(IntrinsicsFit, UsesTheSeenPointsOfViews) {
  TestRandom random(31);
  const BoardTarget board{.columns = 9, .rows = 6, .square = 0.03};
  const auto points = board.points();
  BoardBundle truth{
      {{.fx = 610, .fy = 612, .cx = 322, .cy = 238, .distortion = {-0.2, 0.05, 0, 0, 0}}}, {Pose{}}, {}};
  for (int i = 0; i < 12; ++i) truth.boards.push_back(random_board(random, board, 0.6));
  auto views = seen_boards(truth, points, 0, random);
  std::size_t seen = 0;
  for (BoardView& view : views) {
    // A half-plane of the board is outside the picture.
    const double angle = random.uniform(0, 6.28);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d from_middle = points[i] - Eigen::Vector2d(0.12, 0.075);
      if (from_middle.dot(Eigen::Vector2d(std::cos(angle), std::sin(angle))) > 0.01)
        view.pixels[0][i].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    seen += seen_points(view.pixels[0]);
  }
  const IntrinsicsFit fit = fit_intrinsics(points, views, one_size, {.distortion = 2});
  ASSERT_TRUE(fit.is_found) << fit.reason;
  EXPECT_EQ(fit.points, seen);
  EXPECT_LT(seen, 12 * points.size());
  EXPECT_NEAR(fit.cameras[0].lens.fx, 610, 1e-4);
  EXPECT_NEAR(fit.cameras[0].lens.cy, 238, 1e-4);
  EXPECT_NEAR(fit.cameras[0].lens.distortion[0], -0.2, 1e-6);
  EXPECT_LT(fit.rms, 1e-6);
}

}  // namespace
}  // namespace flexura
