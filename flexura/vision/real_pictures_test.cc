// Pictures that nobody here made: of the Debian packages opencv-doc and visp-images-data.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/border.h"
#include "flexura/vision/conic.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/runs.h"

namespace flexura {
namespace {

const std::filesystem::path visp = "/usr/share/visp-images-data/ViSP-images";
const std::filesystem::path opencv = "/usr/share/doc/opencv-doc/examples/data";

Image<std::uint8_t> gray_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  return gray_picture(decode_picture(bytes, file.string()).bytes);
}

cv::Mat mat_of(const Image<std::uint8_t>& gray) {
  return {gray.height(), gray.width(), CV_8U, const_cast<std::uint8_t*>(gray.values().data())};
}

std::vector<Eigen::Vector2d> border_of(const Image<std::uint8_t>& gray) {
  std::vector<Eigen::Vector2d> points;
  for (const BorderPoint& point : largest_figure(gray).points) points.push_back(point.pixel);
  return points;
}

#define SKIP_WITHOUT(folder) \
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "skipped: " << (folder) << " is not there"

TEST(RealPictures, TheEllipseIsThereToATenthOfAPixel) {
  SKIP_WITHOUT(visp);
  for (const char* name :
       {"image.0001.pgm", "image.0006.pgm", "image.0011.pgm", "image.0016.pgm", "image.0021.pgm"}) {
    auto points = border_of(gray_file(visp / "ellipse-1" / name));
    const auto fit = fit_ellipse_to_most(points);
    ASSERT_TRUE(fit) << name;
    EXPECT_GT(points.size(), 400U) << name;
    EXPECT_LT(fit->rms, 0.09) << name;
  }
}

TEST(RealPictures, ANotchInADiscIsNoPartOfItsCircle) {
  SKIP_WITHOUT(visp);
  auto points = border_of(gray_file(visp / "circle" / "circle.pgm"));
  ASSERT_TRUE(fit_ellipse_to_most(points));
  const auto circle = fit_circle(points);
  ASSERT_TRUE(circle);
  EXPECT_TRUE(circle->is_verified);
  // The disc is 114 rows high.
  EXPECT_NEAR(circle->radius, 57, 0.3);
}

TEST(RealPictures, ThresholdComponentsAndEllipsesAreOpenCVs) {
  SKIP_WITHOUT(visp);
  SKIP_WITHOUT(opencv);
  for (const auto& file :
       {opencv / "left01.jpg", opencv / "right07.jpg", opencv / "notes.png", opencv / "pic1.png",
        visp / "ellipse-1" / "image.0001.pgm", visp / "mire-2" / "image.0001.pgm"}) {
    const Image<std::uint8_t> gray = gray_file(file);
    cv::Mat mask, labels;
    const double level = cv::threshold(mat_of(gray), mask, 0, 255, cv::THRESH_BINARY | cv::THRESH_OTSU);
    const Threshold own = threshold_of(histogram_of(gray));
    // Where several levels are as good, OpenCV takes the first.
    std::size_t between = 0;
    const auto low = static_cast<int>(std::min(level, own.level)),
               high = static_cast<int>(std::max(level, own.level));
    const Histogram histogram = histogram_of(gray);
    for (int i = low + 1; i <= high; ++i) between += histogram[static_cast<std::size_t>(i)];
    EXPECT_LE(between, gray.values().size() / 100) << file;
    Threshold same = own;
    same.level = level + 0.5, same.figure = Figure::bright;
    Components components;
    components.find(gray, same);
    EXPECT_EQ(static_cast<int>(components.list.size()), cv::connectedComponents(mask, labels, 8) - 1) << file;
  }
  auto points = border_of(gray_file(visp / "ellipse-1" / "image.0001.pgm"));
  const auto fit = fit_ellipse_to_most(points);
  ASSERT_TRUE(fit);
  std::vector<cv::Point2f> floats;
  floats.reserve(points.size());
  for (const Eigen::Vector2d& point : points)
    floats.emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()));
  const cv::RotatedRect other = cv::fitEllipseDirect(floats);
  EXPECT_NEAR(other.center.x, fit->center.x(), 0.5);
  EXPECT_NEAR(other.center.y, fit->center.y(), 0.5);
  EXPECT_NEAR(0.5 * std::max(other.size.width, other.size.height), fit->semi_axes.x(), 0.5);
}

TEST(RealPictures, WithoutAnArmHaveNone) {
  SKIP_WITHOUT(opencv);
  ArmFinder finder;
  for (const char* name : {"left01.jpg", "notes.png", "baboon.jpg", "detect_blob.png", "pic1.png"}) {
    const ArmSighting& found = finder.find(gray_file(opencv / name));
    EXPECT_FALSE(found.is_found()) << name;
    EXPECT_NE(found.reason, "") << name;
  }
}

}  // namespace
}  // namespace flexura
