#include "flexura/vision/border.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "flexura/vision/edge_finder.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// Gradient of the picture at a pixel, over 5 x 5 pixels.
Vector2d gradient(const Image<std::uint8_t>& gray, int u, int v) {
  // By the squared distance, px^2.
  static const std::array<double, 9> weights = [] {
    std::array<double, 9> result{};
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = std::exp(-0.4 * static_cast<double>(i));
    return result;
  }();
  Vector2d sum = Vector2d::Zero();
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      const double value =
          gray.at(std::clamp(u + i, 0, gray.width() - 1), std::clamp(v + j, 0, gray.height() - 1));
      const int squared = i * i + j * j;
      sum += value * Vector2d(i, j) * weights[static_cast<std::size_t>(squared)];
    }
  }
  return sum;
}

// Traces the outer border of a component once (Moore's neighbour tracing, with Jacob's stopping criterion).
std::vector<std::pair<int, int>> trace(const Components& components, std::uint32_t component) {
  constexpr std::array<std::pair<int, int>, 8> ring = {
      {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  const auto is_own = [&](int u, int v) {
    const Run* run = components.run_at(u, v);
    return run != nullptr && run->component == component;
  };
  const Run& first = components.runs[components.list[component].first_run];
  std::vector<std::pair<int, int>> pixels;
  int u = first.first, v = first.v, from = 4;  // Arrived from the left, where the background is.
  const std::size_t most = 8 * static_cast<std::size_t>(components.list[component].area) + 8;
  int first_way = -1;
  while (pixels.size() < most) {
    int way = -1;
    for (int k = 1; k <= 8; ++k) {
      const int next = (from + k) % 8;
      const auto [du, dv] = ring[static_cast<std::size_t>(next)];
      if (is_own(u + du, v + dv)) {
        way = next;
        break;
      }
    }
    if (way < 0) return {{u, v}};
    if (u == first.first && v == first.v) {
      if (way == first_way) break;
      if (first_way < 0) first_way = way;
    }
    pixels.emplace_back(u, v);
    u += ring[static_cast<std::size_t>(way)].first, v += ring[static_cast<std::size_t>(way)].second;
    from = (way + 4) % 8;
  }
  return pixels;
}

// Returns the blur of a series that explains a border's points best, among those that find nine tenths of the
// maximum number.
template <typename FindBorder>
double best_blur(const BlurSeries& series, std::size_t count, const FindBorder& border_with,
                 const std::vector<BorderPoint>& points) {
  constexpr double enough = 0.9;
  std::vector<std::size_t> found(count);
  std::vector<double> left(count);
  for (std::size_t i = 0; i < count; ++i) {
    border_with(series.at(i));
    found[i] = points.size();
    for (const BorderPoint& point : points)
      left[i] += point.residual * point.residual / static_cast<double>(points.size());
  }
  const double least = enough * static_cast<double>(std::ranges::max(found));
  for (std::size_t i = 0; i < count; ++i)
    if (static_cast<double>(found[i]) < least) left[i] = std::numeric_limits<double>::infinity();
  return series.least(left);
}

}  // namespace

void find_border(const Image<std::uint8_t>& gray, const Threshold& threshold, const Components& components,
                 std::uint32_t component, double blur, std::vector<BorderPoint>& border,
                 const std::function<bool(const Vector2d&)>& is_known) {
  border.clear();
  BlurredSteps steps;
  const int sign = threshold.figure == Figure::dark ? 1 : -1;
  const EdgeFinder<std::uint8_t> edges(gray, sign, steps, lone_border_blur);
  const double contrast = threshold.bright - threshold.dark;
  // A pixel is passed twice where the component is a pixel wide.
  const Component& box = components.list[component];
  const int columns = box.right - box.left + 1;
  std::vector<bool> passed(static_cast<std::size_t>(columns) *
                           static_cast<std::size_t>(box.bottom - box.top + 1));
  for (const auto& [u, v] : trace(components, component)) {
    const auto at = static_cast<std::size_t>(v - box.top) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(u - box.left);
    if (passed[at] || (is_known && is_known(Vector2d(u, v)))) continue;
    passed[at] = true;
    const Vector2d slope = sign * gradient(gray, u, v);
    if (!(slope.norm() > 0)) continue;
    const Vector2d normal = slope.normalized();
    double offset = 0;
    for (int round = 0; round < 6; ++round) {
      const auto fit = edges.look(Vector2d(u, v) + offset * normal, normal, blur, 6 * std::max(1.0, blur));
      if (!fit || fit->contrast < 0.35 * contrast || std::abs(offset) > 2 + blur) break;
      offset += std::clamp(fit->offset, -1.0, 1.0);
      if (std::abs(fit->offset) > 0.1) continue;
      if (fit->residual < 0.12 * fit->contrast + 2)
        border.push_back({Vector2d(u, v) + offset * normal, normal, fit->contrast, fit->residual});
      break;
    }
  }
}

FigureBorder largest_figure(const Image<std::uint8_t>& gray, const ThresholdConfig& config) {
  FigureBorder result;
  Components components;
  BlockThresholds blocks;
  result.threshold = segment(gray, config, components, blocks);
  result.reason = result.threshold.reason;
  if (!result.reason.empty()) return result;
  // The largest component that does not touch the picture's border; if all touch it, the largest.
  std::size_t best = components.list.size();
  const auto key = [&](std::size_t i) {
    return std::pair(components.list[i].on_border == 0, components.list[i].area);
  };
  for (std::size_t i = 0; i < components.list.size(); ++i)
    if (components.list[i].area >= 24 && (best == components.list.size() || key(i) > key(best))) best = i;
  if (best == components.list.size()) {
    result.reason = "there is no figure of at least 24 px";
    return result;
  }
  result.area = components.list[best].area;
  result.touches_border = components.list[best].on_border > 0;
  const auto border_with = [&](double blur) {
    find_border(gray, result.threshold, components, static_cast<std::uint32_t>(best), blur, result.points);
  };
  const double roughly = best_blur({}, 11, border_with, result.points);
  result.blur = best_blur({roughly / (1.08 * 1.08), 1.08}, 5, border_with, result.points);
  border_with(result.blur);
  if (result.points.empty()) result.reason = "the largest figure has no sharp border";
  return result;
}

}  // namespace flexura
