#include "flexura/vision/spots.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace flexura {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double least_spot_area = 8;  // Smaller spots are ignored as specks, px^2.
constexpr double longest = 4;          // Length over width, or width over length.
constexpr double least_sigma = 0.03;   // The samples are a pixel apart, px.

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Standard deviation from moments.
double spread_of(double sum, double first, double second) {
  const double mean = first / sum;
  return std::sqrt(std::max(second / sum - mean * mean, 0.0));
}

// The unrolled skin, about a pixel apart also across the arm: sample i * lines_ + line.
class SpotFinder {
 public:
  SpotFinder(const Image<std::uint8_t>& picture, const ArmObservation& arm, const ArmSkin& skin)
      : picture_(picture), skin_(skin), noise_(arm.noise) {
    to_side_ = static_cast<std::size_t>(std::ceil(std::ranges::max(skin.half_widths)));
    lines_ = 2 * to_side_ + 1;
    differences_.resize(skin.size() * lines_);
    states_.resize(differences_.size(), State::outside);
    // At the borders the background shows through the picture's blur.
    const double depth = std::max(0.8, arm.blur);
    std::vector<Vector3d> colors(skin.size());
    for (std::size_t line = 0; line < lines_; ++line) {
      for (std::size_t i = 0; i < skin.size(); ++i) colors[i] = color_at(picture, place(i, line));
      const Vector3d own = median_color(colors);
      for (std::size_t i = 0; i < skin.size(); ++i) {
        differences_[i * lines_ + line] = (colors[i] - own).norm();
        const bool is_inside = (1 - std::abs(share(line))) * skin.half_widths[i] > depth;
        if (is_inside && skin.is_seen[i]) states_[i * lines_ + line] = State::skin;
      }
    }
  }

  std::vector<MarkerObservation> find(std::span<const Stretch> bands, double bound) {
    for (const Stretch& band : bands) {
      for (std::size_t i = band.first; i < band.last; ++i) {
        const std::size_t sample = i * lines_ + to_side_;
        if (states_[sample] == State::skin) fill(sample, bound, State::done);
      }
    }
    std::vector<MarkerObservation> spots;
    std::vector<std::size_t> whole;
    for (std::size_t start = 0; start < states_.size(); ++start) {
      if (states_[start] != State::skin || differences_[start] <= bound) continue;
      fill(start, bound, State::near);
      whole = region_;
      double most = 0;
      for (const std::size_t sample : whole) most = std::max(most, differences_[sample]);
      // Parts separated at half of the height are separate spots.
      const double half = std::max(0.5 * most, bound);
      for (const std::size_t sample : whole) {
        if (states_[sample] != State::near || differences_[sample] <= half) continue;
        fill(sample, half, State::done);
        if (const auto spot = spot_of(half)) spots.push_back(*spot);
      }
    }
    return spots;
  }

 private:
  enum class State : std::uint8_t { outside, skin, near, done };

  [[nodiscard]] double share(std::size_t line) const {
    return static_cast<double>(line) / static_cast<double>(to_side_) - 1;
  }
  [[nodiscard]] Vector2d place(std::size_t i, std::size_t line) const {
    return skin_.axis[i] + share(line) * skin_.half_widths[i] * skin_.normals[i];
  }

  // Collects in region_ the samples above `bound` connected to a start sample and sets their state.
  void fill(std::size_t start, double bound, State state) {
    const State from = states_[start];
    region_.assign(1, start);
    states_[start] = state;
    const auto visit = [&](bool is_there, std::size_t sample) {
      if (!is_there || states_[sample] != from || differences_[sample] <= bound) return;
      states_[sample] = state;
      region_.push_back(sample);
    };
    std::size_t next = 0;
    while (next < region_.size()) {
      const std::size_t at = region_[next++], line = at % lines_;
      visit(line > 0, at - 1);
      visit(line + 1 < lines_, at + 1);
      visit(at >= lines_, at - lines_);
      visit(at + lines_ < states_.size(), at + lines_);
    }
  }

  // Makes a spot of region_: its centre is weighted by the height above `bound` and the area in the picture.
  [[nodiscard]] std::optional<MarkerObservation> spot_of(double bound) const {
    double sum = 0, area = 0, first = 0, second = 0, across = 0, across_second = 0;
    Vector2d center = Vector2d::Zero();
    std::array<double, 2> edges = {0, 0};  // Length of its outline on the border of the visible skin, px.
    bool is_hidden = false;
    for (const std::size_t sample : region_) {
      const std::size_t i = sample / lines_, line = sample % lines_;
      if (i < 2 || i + 2 >= skin_.size()) return std::nullopt;  // The background behind an end.
      const double cell =
          std::abs(cross(0.5 * (place(i + 1, line) - place(i - 1, line)),
                         skin_.half_widths[i] / static_cast<double>(to_side_) * skin_.normals[i]));
      const double weight = cell * (differences_[sample] - bound), way = static_cast<double>(i);
      sum += weight, area += cell, first += weight * way, second += weight * way * way;
      const double aside = share(line) * skin_.half_widths[i];
      across += weight * aside, across_second += weight * aside * aside;
      center += weight * place(i, line);
      edges[0] += states_[sample - 1] == State::outside ? 1 : 0;
      edges[1] += states_[sample + 1] == State::outside ? 1 : 0;
      is_hidden = is_hidden || !skin_.is_seen[i - 1] || !skin_.is_seen[i + 1];
    }
    const double mean = first / sum, spread = spread_of(sum, first, second);
    const double ratio = spread_of(sum, across, across_second) / spread;
    const bool is_compact = ratio > 1 / longest && ratio < longest;
    if (area < least_spot_area || !is_compact) return std::nullopt;
    // The visible part of a partly hidden band is longer across the arm than along it; visible background
    // along a border is the opposite.
    const bool touches = edges[0] > 0 || edges[1] > 0, is_cut = std::max(edges[0], edges[1]) > 2 * spread;
    if (edges[0] > 0 && edges[1] > 0) return std::nullopt;
    if (((touches || is_hidden) && ratio > 1.2) || (is_cut && ratio < 0.4)) return std::nullopt;
    MarkerObservation spot;
    spot.is_band = false;
    spot.pixel = center / sum;
    spot.color = color_at(picture_, spot.pixel);
    spot.length = 4 * spread;  // As of a disc.
    const auto near = static_cast<std::size_t>(std::lround(mean));
    const Vector2d tangent = (skin_.axis[near + 1] - skin_.axis[near - 1]).normalized();
    spot.along = mean + (spot.pixel - skin_.at(mean)).dot(tangent);
    spot.aside = (spot.pixel - skin_.at(spot.along)).dot(skin_.normals[near]);
    spot.sigma = std::hypot(noise_ * std::sqrt(area) * spread / sum, least_sigma);
    // The size of the hidden part is unknown.
    if (is_cut || is_hidden) spot.sigma = std::max(spot.sigma, spread);
    return spot;
  }

  const Image<std::uint8_t>& picture_;
  const ArmSkin& skin_;
  double noise_;
  std::size_t to_side_ = 0, lines_ = 0;
  std::vector<double> differences_;  // From the skin elsewhere on the same line.
  std::vector<State> states_;
  std::vector<std::size_t> region_;
};

}  // namespace

std::vector<MarkerObservation> find_spots(const Image<std::uint8_t>& picture, const ArmObservation& arm,
                                          const ArmSkin& skin, std::span<const Stretch> bands, double bound) {
  return SpotFinder(picture, arm, skin).find(bands, bound);
}

}  // namespace flexura
