#include "flexura/vision/markers.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/math/median.h"

namespace flexura {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

// Lines along the arm, in half widths from its axis.
constexpr std::array<double, 7> skin_lines = {-0.72, -0.5, -0.25, 0, 0.25, 0.5, 0.72};
constexpr std::size_t middle_line = 3;

// Markers are at least so much brighter or of another colour than the arm, of 255.
constexpr double least_difference = 14;

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

// The arm's skin laid out flat: colours along the skin_lines, a pixel apart.
struct Skin {
  std::vector<Vector2d> axis, normals;
  std::vector<double> half_widths;
  std::array<std::vector<Vector3d>, skin_lines.size()> colors;

  Skin(const Image<std::uint8_t>& picture, const ArmSighting& arm) {
    double way = 0, next = 0;
    for (std::size_t i = 0; i + 1 < arm.axis.size(); ++i) {
      const AxisSample &a = arm.axis[i], &b = arm.axis[i + 1];
      const double length = (b.pixel - a.pixel).norm();
      for (; next < way + length; next += 1) {
        const double share = (next - way) / length;
        axis.emplace_back(a.pixel + share * (b.pixel - a.pixel));
        normals.emplace_back((a.normal + share * (b.normal - a.normal)).normalized());
        half_widths.push_back(0.5 * (a.width + share * (b.width - a.width)));
      }
      way += length;
    }
    for (std::size_t line = 0; line < skin_lines.size(); ++line)
      for (std::size_t i = 0; i < axis.size(); ++i)
        colors[line].push_back(color_at(picture, axis[i] + skin_lines[line] * half_widths[i] * normals[i]));
  }
  [[nodiscard]] std::size_t size() const { return axis.size(); }
  [[nodiscard]] Vector2d at(double along) const {
    const double place = std::clamp(along, 0.0, static_cast<double>(size() - 1));
    const auto i = std::min(static_cast<std::size_t>(place), size() - 2);
    return axis[i] + (place - static_cast<double>(i)) * (axis[i + 1] - axis[i]);
  }
};

Vector3d median_color(const std::vector<Vector3d>& colors) {
  Vector3d result;
  std::vector<double> values(colors.size());
  for (int c = 0; c < 3; ++c) {
    std::ranges::transform(colors, values.begin(), [&](const Vector3d& color) { return color[c]; });
    result[c] = median(std::span(values));
  }
  return result;
}

// Stretches [first, last) of a line whose colour is not the arm's.
struct Stretch {
  std::size_t first, last;
};
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

// At an end of the arm the ground is in the last pixels, by the picture's blur.
bool is_ground(const Stretch& stretch, std::size_t size) {
  constexpr std::size_t most = 3;
  return (stretch.first == 0 && stretch.last <= most) ||
         (stretch.last == size && stretch.first + most >= size);
}

// A line's part of a marker: its middle and length by the moments of how much it differs from the skin around
// it.
struct Part {
  double middle = 0, length = 0, sigma = 0;
};
std::optional<Part> part_of(const std::vector<Vector3d>& colors, const Stretch& near,
                            const Vector3d& direction, double bound, double noise) {
  const std::size_t margin = 4;
  if (near.first < margin || near.last + margin > colors.size()) return std::nullopt;
  const std::size_t from = near.first - margin, to = near.last + margin;
  const double before = (colors[from] + colors[from + 1]).dot(direction) / 2;
  const double after = (colors[to - 1] + colors[to - 2]).dot(direction) / 2;
  double sum = 0, first = 0, most = 0;
  for (std::size_t i = from; i < to; ++i) {
    const double share = static_cast<double>(i - from) / static_cast<double>(to - 1 - from);
    const double value = colors[i].dot(direction) - before - share * (after - before);
    sum += value, first += value * static_cast<double>(i), most = std::max(most, value);
  }
  if (most < bound || sum <= 0) return std::nullopt;
  const auto n = static_cast<double>(to - from);
  const Part part{first / sum, sum / most, noise * std::sqrt(n * n * n / 12) / sum};
  if (part.middle < static_cast<double>(from) || part.middle > static_cast<double>(to)) return std::nullopt;
  return part;
}

// middle(y) = x + bulge h sqrt(1 - y^2), over the skin_lines that show the marker.
MarkerSighting joined(const std::array<std::optional<Part>, skin_lines.size()>& parts, double half_width) {
  MarkerSighting marker;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Vector2d right = Vector2d::Zero();
  double count = 0, sigma = 0;
  for (std::size_t i = 0; i < skin_lines.size(); ++i) {
    if (!parts[i]) continue;
    const Vector2d row(1, half_width * std::sqrt(1 - skin_lines[i] * skin_lines[i]));
    normal += row * row.transpose(), right += parts[i]->middle * row;
    marker.length += parts[i]->length, sigma += parts[i]->sigma * parts[i]->sigma, ++count;
  }
  marker.length /= count, sigma = std::sqrt(sigma / count);
  marker.is_band = count >= 5;
  if (marker.is_band) {
    const Vector2d solution = normal.ldlt().solve(right);
    if (std::abs(solution[1]) < 1) {
      marker.along = solution[0], marker.bulge = solution[1];
      marker.sigma = sigma * std::sqrt(normal.inverse()(0, 0));
      return marker;
    }
  }
  marker.along = right[0] / count, marker.sigma = sigma / std::sqrt(count);
  return marker;
}

void look_for_gaps(MarkerSightings& found) {
  std::vector<MarkerSighting>& markers = found.markers;
  if (markers.size() < 4) return;
  std::vector<double> lengths, gaps;
  for (const MarkerSighting& marker : markers) lengths.push_back(marker.length);
  for (std::size_t i = 1; i < markers.size(); ++i) gaps.push_back(markers[i].along - markers[i - 1].along);
  std::vector<double> sorted = lengths;
  std::ranges::sort(sorted);
  for (MarkerSighting& marker : markers)
    marker.may_be_merged = marker.length > 1.8 * sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    // Spacing changes slowly where the arm turns away: compare with the gaps beside.
    const double before = i > 0 ? gaps[i - 1] : gaps[i + 1],
                 after = i + 1 < gaps.size() ? gaps[i + 1] : gaps[i - 1];
    if (gaps[i] > 1.7 * std::max(before, after))
      found.notes.push_back(fmt::format("a marker may be missing between markers {} and {}", i + 1, i + 2));
  }
}

}  // namespace

MarkerSightings find_markers(const Image<std::uint8_t>& picture, const ArmSighting& arm) {
  MarkerSightings found;
  if (arm.axis.size() < 8) return found;
  const Skin skin(picture, arm);
  if (skin.size() < 12) return found;
  // The ground is in every pixel of a thinner arm.
  constexpr double thinnest = 4;  // px
  std::vector<double> half_widths = skin.half_widths;
  const double thickness = 2 * median(std::span(half_widths));
  if (thickness < thinnest) {
    found.notes.push_back(fmt::format("the arm is {:.1f} px thick: no markers are looked for below {} px",
                                      thickness, thinnest));
    return found;
  }
  const Vector3d own = median_color(skin.colors[middle_line]);
  const double bound = std::max(least_difference, 5 * arm.noise);
  std::size_t dropped = 0;
  for (const Stretch& stretch : stretches(skin.colors[middle_line], own, bound)) {
    if (is_ground(stretch, skin.size())) continue;
    const std::size_t middle = (stretch.first + stretch.last) / 2;
    const Vector3d color = skin.colors[middle_line][middle], direction = (color - own).normalized();
    std::array<std::optional<Part>, skin_lines.size()> parts;
    // Along the other skin_lines the band is shifted by no more than the arm's half width.
    for (std::size_t line = 0; line < skin_lines.size(); ++line) {
      Stretch near = stretch;
      if (line != middle_line) {
        const auto reach = static_cast<std::size_t>(0.6 * skin.half_widths[middle]) + 1;
        const Stretch wide{stretch.first - std::min(stretch.first, reach),
                           std::min(stretch.last + reach, skin.size())};
        // The stretch of this line that is nearest.
        double best = 1e9;
        for (const Stretch& other :
             stretches(skin.colors[line], median_color(skin.colors[line]), 0.5 * bound)) {
          if (other.last <= wide.first || other.first >= wide.last) continue;
          const double distance =
              std::abs(0.5 * static_cast<double>(other.first + other.last) - static_cast<double>(middle));
          if (distance < best) best = distance, near = other;
        }
        if (best > 1e8) continue;
      }
      parts[line] = part_of(skin.colors[line], near, direction, 0.5 * bound, arm.noise);
    }
    if (!parts[middle_line] ||
        std::ranges::count_if(parts, [](const auto& part) { return part.has_value(); }) < 2) {
      ++dropped;
      continue;
    }
    MarkerSighting marker = joined(parts, skin.half_widths[middle]);
    marker.pixel = skin.at(marker.along);
    marker.color = color;
    found.markers.push_back(marker);
  }
  if (dropped > 0)
    found.notes.push_back(
        fmt::format("{} spot{} of another colour left out: at an end of the arm, or too small to be "
                    "a marker",
                    dropped, dropped > 1 ? "s" : ""));
  std::ranges::stable_sort(found.markers, {}, &MarkerSighting::along);
  look_for_gaps(found);
  return found;
}

}  // namespace flexura
