#include "flexura/vision/curve_flow.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/video/tracking.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

namespace flexura {
namespace {

using Eigen::Vector2d;
// OpenCV only reads the picture.
cv::Mat mat_of(const Image<std::uint8_t>& image) {
  return {image.height(), image.width(), CV_8U, const_cast<std::uint8_t*>(image.values().data())};
}

void check_pictures(const Image<std::uint8_t>& before, const Image<std::uint8_t>& after) {
  if (before.channels() != 1 || after.channels() != 1)
    throw std::invalid_argument("optical flow needs gray pictures");
  if (before.width() != after.width() || before.height() != after.height()) {
    throw std::invalid_argument(fmt::format("optical flow between pictures of {} x {} and {} x {} px",
                                            before.width(), before.height(), after.width(), after.height()));
  }
}

}  // namespace

std::vector<std::optional<Vector2d>> flow_at(const Image<std::uint8_t>& before,
                                             const Image<std::uint8_t>& after,
                                             std::span<const Vector2d> places) {
  check_pictures(before, after);
  std::vector<std::optional<Vector2d>> flows(places.size());
  if (places.empty() || before.values().empty()) return flows;
  // Makes results equal on every machine, for any number of processors.
  cv::setNumThreads(1);
  std::vector<cv::Point2f> from, to;
  for (const Vector2d& place : places)
    from.emplace_back(static_cast<float>(place.x()), static_cast<float>(place.y()));
  std::vector<unsigned char> is_found;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(mat_of(before), mat_of(after), from, to, is_found, error);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (is_found[i] != 0) flows[i] = Vector2d(to[i].x - from[i].x, to[i].y - from[i].y);
  return flows;
}

void AngleIntegrator::add(std::span<const double> turns) {
  if (turns.size() != angles_.size())
    throw std::invalid_argument(fmt::format("{} turns for {} angles", turns.size(), angles_.size()));
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (std::isfinite(turns[i])) {
      angles_[i] += turns[i];
      continue;
    }
    // The nearest known values on both sides.
    double sum = 0, count = 0;
    for (std::size_t j = i; j-- > 0;)
      if (std::isfinite(turns[j])) {
        sum += turns[j], ++count;
        break;
      }
    for (std::size_t j = i + 1; j < turns.size(); ++j)
      if (std::isfinite(turns[j])) {
        sum += turns[j], ++count;
        break;
      }
    if (count > 0) angles_[i] += sum / count;
  }
}

double AngleIntegrator::anchor(std::span<const double> measured, double share) {
  if (measured.size() != angles_.size())
    throw std::invalid_argument(
        fmt::format("{} measured angles for {} angles", measured.size(), angles_.size()));
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!std::isfinite(measured[i])) continue;
    const double miss = std::remainder(measured[i] - angles_[i], 2 * std::numbers::pi);
    angles_[i] += share * miss;
    squares += miss * miss, ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

}  // namespace flexura
