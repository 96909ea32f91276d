#include "flexura/vision/curve_flow.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
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
constexpr double none = std::numeric_limits<double>::quiet_NaN();

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// OpenCV reads only.
cv::Mat mat_of(const Image<std::uint8_t>& image) {
  return {image.height(), image.width(), CV_8U, const_cast<std::uint8_t*>(image.values().data())};
}

void check_pictures(const Image<std::uint8_t>& before, const Image<std::uint8_t>& after) {
  if (before.channels() != 1 || after.channels() != 1)
    throw std::invalid_argument("flow between pictures that are not gray");
  if (before.width() != after.width() || before.height() != after.height()) {
    throw std::invalid_argument(fmt::format("flow between pictures of {} x {} and {} x {} px", before.width(),
                                            before.height(), after.width(), after.height()));
  }
}

std::vector<std::optional<Vector2d>> sparse_flow(const cv::Mat& before, const cv::Mat& after,
                                                 std::span<const Vector2d> places) {
  std::vector<cv::Point2f> from, to;
  for (const Vector2d& place : places)
    from.emplace_back(static_cast<float>(place.x()), static_cast<float>(place.y()));
  std::vector<unsigned char> is_found;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(before, after, from, to, is_found, error);
  std::vector<std::optional<Vector2d>> flows(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    if (is_found[i] != 0) flows[i] = Vector2d(to[i].x - from[i].x, to[i].y - from[i].y);
  return flows;
}

std::vector<std::optional<Vector2d>> dense_flow(const cv::Mat& before, const cv::Mat& after,
                                                std::span<const Vector2d> places) {
  cv::Mat flow;
  cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_FAST)->calc(before, after, flow);
  std::vector<std::optional<Vector2d>> flows(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double u = std::round(places[i].x()), v = std::round(places[i].y());
    const bool is_inside = u >= 0 && v >= 0 && u < flow.cols && v < flow.rows;
    if (!is_inside) continue;
    const auto& value = flow.at<cv::Vec2f>(static_cast<int>(v), static_cast<int>(u));
    flows[i] = Vector2d(value[0], value[1]);
  }
  return flows;
}

}  // namespace

CurveFlow curve_flow(const std::vector<AxisSample>& before, const std::vector<AxisSample>& after) {
  CurveFlow flow;
  flow.normal.assign(before.size(), none), flow.turn.assign(before.size(), none);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const AxisSample& sample = before[i];
    if (!sample.is_seen) continue;
    double best = sample.width;
    for (std::size_t j = 0; j + 1 < after.size(); ++j) {
      if (!after[j].is_seen || !after[j + 1].is_seen) continue;
      // Where the later axis crosses the normal's line.
      const Vector2d from = after[j].pixel - sample.pixel, way = after[j + 1].pixel - after[j].pixel;
      const double across = cross(sample.normal, way);
      if (across == 0) continue;
      const double share = -cross(sample.normal, from) / across;
      if (share < 0 || share > 1) continue;
      const double distance = (from + share * way).dot(sample.normal);
      if (std::abs(distance) >= best) continue;
      best = std::abs(distance);
      const Vector2d normal = (1 - share) * after[j].normal + share * after[j + 1].normal;
      flow.normal[i] = distance;
      flow.turn[i] = std::atan2(cross(sample.normal, normal), sample.normal.dot(normal));
    }
  }
  return flow;
}

std::vector<std::optional<Vector2d>> flow_at(const Image<std::uint8_t>& before,
                                             const Image<std::uint8_t>& after,
                                             std::span<const Vector2d> places, FlowMethod method) {
  check_pictures(before, after);
  if (places.empty() || before.values().empty()) return std::vector<std::optional<Vector2d>>(places.size());
  // The same bytes on every machine, whatever it has of processors.
  cv::setNumThreads(1);
  return method == FlowMethod::lucas_kanade ? sparse_flow(mat_of(before), mat_of(after), places)
                                            : dense_flow(mat_of(before), mat_of(after), places);
}

void AngleIntegrator::add(std::span<const double> turns) {
  if (turns.size() != angles_.size())
    throw std::invalid_argument(fmt::format("{} turns for {} angles", turns.size(), angles_.size()));
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (std::isfinite(turns[i])) {
      angles_[i] += turns[i];
      continue;
    }
    // The nearest ones that are known, to both sides.
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
    throw std::invalid_argument(fmt::format("{} measured angles for {}", measured.size(), angles_.size()));
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
