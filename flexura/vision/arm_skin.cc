#include "flexura/vision/arm_skin.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/math/median.h"

namespace flexura {

using Eigen::Vector2d, Eigen::Vector3d;

Vector3d color_at(const Image<std::uint8_t>& picture, const Vector2d& pixel) {
  const double u = std::clamp(pixel.x(), 0.0, picture.width() - 1.001),
               v = std::clamp(pixel.y(), 0.0, picture.height() - 1.001);
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const double right = u - i, down = v - j;
  Vector3d color;
  for (int c = 0; c < 3; ++c) {
    const int channel = picture.channels() == 3 ? c : 0;
    const int i1 = std::min(i + 1, picture.width() - 1), j1 = std::min(j + 1, picture.height() - 1);
    color[c] = (1 - down) * ((1 - right) * picture.at(i, j, channel) + right * picture.at(i1, j, channel)) +
               down * ((1 - right) * picture.at(i, j1, channel) + right * picture.at(i1, j1, channel));
  }
  return color;
}

Vector3d median_color(const std::vector<Vector3d>& colors) {
  Vector3d result;
  std::vector<double> values(colors.size());
  for (int c = 0; c < 3; ++c) {
    std::ranges::transform(colors, values.begin(), [&](const Vector3d& color) { return color[c]; });
    result[c] = median(std::span(values));
  }
  return result;
}

std::vector<Stretch> stretches(const std::vector<Vector3d>& colors, const Vector3d& own, double bound) {
  std::vector<Stretch> result;
  bool is_in = false;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const bool differs = (colors[i] - own).norm() > bound;
    if (differs && !is_in) result.push_back({i, colors.size()});
    if (!differs && is_in) result.back().last = i;
    is_in = differs;
  }
  return result;
}

ArmSkin::ArmSkin(const Image<std::uint8_t>& picture, const ArmObservation& arm) {
  double way = 0, next = 0;
  for (std::size_t i = 0; i + 1 < arm.axis.size(); ++i) {
    const AxisSample &a = arm.axis[i], &b = arm.axis[i + 1];
    const double length = (b.pixel - a.pixel).norm();
    for (; next < way + length; next += 1) {
      const double share = (next - way) / length;
      axis.emplace_back(a.pixel + share * (b.pixel - a.pixel));
      normals.emplace_back((a.normal + share * (b.normal - a.normal)).normalized());
      half_widths.push_back(0.5 * (a.width + share * (b.width - a.width)));
      is_seen.push_back(a.is_seen && b.is_seen);
    }
    way += length;
  }
  for (std::size_t line = 0; line < lines.size(); ++line) {
    colors[line].reserve(size());
    for (std::size_t i = 0; i < size(); ++i)
      colors[line].push_back(color_at(picture, axis[i] + lines[line] * half_widths[i] * normals[i]));
  }
}

Vector2d ArmSkin::at(double along) const {
  const double place = std::clamp(along, 0.0, static_cast<double>(size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), size() - 2);
  return axis[i] + (place - static_cast<double>(i)) * (axis[i + 1] - axis[i]);
}

}  // namespace flexura
