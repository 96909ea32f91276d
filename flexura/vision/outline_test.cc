// Compares the silhouette's border with OpenCV's contours.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/border.h"
#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

using Contour = std::vector<cv::Point>;

// The longest contour of the pixels darker than `level`.
Contour opencv_contour(const Image<std::uint8_t>& picture, double level) {
  const cv::Mat gray(picture.height(), picture.width(), CV_8U,
                     const_cast<std::uint8_t*>(picture.values().data()));
  cv::Mat mask;
  cv::threshold(gray, mask, level, 255, cv::THRESH_BINARY_INV);
  std::vector<Contour> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  return *std::ranges::max_element(contours, {}, &Contour::size);
}

double distance_to(const Contour& contour, const Eigen::Vector2d& pixel) {
  return std::abs(
      cv::pointPolygonTest(contour, {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())}, true));
}

// The contour runs through the middles of the outermost pixels: half a pixel from the border, plus the stair
// of a slanting border.
constexpr double stair = 1.3;

TEST(Outline, IsOpenCVsContourToAPixel) {
  for_random_cases(6, [](TestRandom& random) {
    SeenArmConfig options;
    options.noise = 1, options.most_bend = 0.8;
    const SeenArm seen = random_seen_arm(random, options);
    const FigureBorder figure = largest_figure(seen.picture);
    ASSERT_EQ(figure.reason, "");
    const Contour contour = opencv_contour(seen.picture, figure.threshold.level);
    double sum = 0;
    for (const BorderPoint& point : figure.points) {
      const double distance = distance_to(contour, point.pixel);
      EXPECT_LT(distance, 2);
      sum += distance;
    }
    EXPECT_NEAR(sum / static_cast<double>(figure.points.size()), 0.45, 0.2);
    // No part is missing: each of the contour's pixels has a border point near it.
    std::size_t alone = 0;
    for (const cv::Point& at : contour) {
      const bool is_near = std::ranges::any_of(figure.points, [&](const BorderPoint& point) {
        return (point.pixel - Eigen::Vector2d(at.x, at.y)).squaredNorm() < 4;
      });
      alone += is_near ? 0 : 1;
    }
    EXPECT_LT(static_cast<double>(alone), 0.05 * static_cast<double>(contour.size()));
    // The same holds for the arm's sides where both are visible.
    ArmFinder finder;
    const ArmObservation& arm = finder.find(seen.picture);
    ASSERT_TRUE(arm.is_found()) << arm.reason;
    std::size_t near = 0, count = 0;
    for (const AxisSample& sample : arm.axis) {
      if (!sample.is_seen) continue;
      for (const double side : {0.5, -0.5}) {
        const Eigen::Vector2d border = sample.pixel + side * sample.width * sample.normal;
        near += distance_to(contour, border) < stair ? 1 : 0, ++count;
      }
    }
    // The rest borders on the arm itself, where it lies in front of another part of it.
    EXPECT_GT(static_cast<double>(near), 0.97 * static_cast<double>(count));
  });
}

}  // namespace
}  // namespace flexura
