#include "flexura/vision/marker_texture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/math/median.h"

namespace flexura {
namespace {

// Returns the texture on one line along the arm.
std::optional<SkinTexture> texture_on(const std::vector<Eigen::Vector3d>& colors, double thickness,
                                      double bound) {
  constexpr std::size_t least_count = 6;
  // Markers are farther apart than this share of the arm's width.
  constexpr double short_period = 0.6;
  const Eigen::Vector3d own = median_color(colors);
  const std::vector<Stretch> found = stretches(colors, own, bound);
  if (found.size() < least_count) return std::nullopt;
  std::vector<double> periods, contrasts;
  for (std::size_t i = 0; i < found.size(); ++i) {
    double most = 0;
    for (std::size_t k = found[i].first; k < found[i].last; ++k)
      most = std::max(most, (colors[k] - own).norm());
    contrasts.push_back(most);
    if (i > 0)
      periods.push_back(0.5 * static_cast<double>(found[i].first + found[i].last) -
                        0.5 * static_cast<double>(found[i - 1].first + found[i - 1].last));
  }
  const double period = median(std::span(periods));
  if (period > short_period * thickness) return std::nullopt;
  const auto high = contrasts.begin() + static_cast<std::ptrdiff_t>(4 * contrasts.size() / 5);
  std::ranges::nth_element(contrasts, high);
  return SkinTexture{found.size(), period, *high};
}

}  // namespace

std::optional<SkinTexture> texture_of(const ArmSkin& skin, double thickness, double bound) {
  std::optional<SkinTexture> most;
  for (std::size_t line = 1; line + 1 < ArmSkin::lines.size(); ++line) {
    const auto texture = texture_on(skin.colors[line], thickness, bound);
    if (texture && (!most || texture->count > most->count)) most = texture;
  }
  return most;
}

}  // namespace flexura
