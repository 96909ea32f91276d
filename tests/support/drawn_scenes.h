#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "flexura/base/image.h"
#include "tests/support/drawn_arms.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// A gray or RGB picture made of plain shapes, whose true borders are known.
class DrawnScene {
 public:
  DrawnScene(int width, int height, int channels = 1) : picture_(width, height, channels) {}

  /// Paints every pixel by a function of (u, v, channel).
  template <typename Value>
  DrawnScene& ground(const Value& value) {
    for (int v = 0; v < picture_.height(); ++v)
      for (int u = 0; u < picture_.width(); ++u)
        for (int c = 0; c < picture_.channels(); ++c) picture_.at(u, v, c) = value(u, v, c);
    return *this;
  }
  /// Paints a shape with the signed distance `distance(u, v)`, px, positive outside, by a function of (u, v,
  /// channel).
  template <typename Distance, typename Value>
  DrawnScene& shape(const Distance& distance, const Value& value) {
    for (int v = 0; v < picture_.height(); ++v) {
      for (int u = 0; u < picture_.width(); ++u) {
        const double covered = share(distance(u, v));
        if (covered == 0) continue;
        for (int c = 0; c < picture_.channels(); ++c)
          picture_.at(u, v, c) += covered * (value(u, v, c) - picture_.at(u, v, c));
      }
    }
    return *this;
  }
  /// Paints a rectangle of columns [left, right) and rows [top, bottom).
  DrawnScene& bar(double left, double top, double right, double bottom, double brightness) {
    return shape(
        [=](int u, int v) {
          return std::max({left - 0.5 - u, u - right + 0.5, top - 0.5 - v, v - bottom + 0.5});
        },
        [=](int, int, int) { return brightness; });
  }
  /// Paints the part of a ring around (u0, v0) to the left of column u0: an arc from bottom to top.
  template <typename Value>
    requires(!std::is_arithmetic_v<Value>)
  DrawnScene& arc(double u0, double v0, double radius, double width, const Value& value) {
    return shape(
        [=](int u, int v) {
          return std::max(std::abs(std::hypot(u - u0, v - v0) - radius) - 0.5 * width, u - u0);
        },
        value);
  }
  DrawnScene& arc(double u0, double v0, double radius, double width, double brightness) {
    return arc(u0, v0, radius, width, [=](int, int, int) { return brightness; });
  }

  /// Returns the picture with 8 bits and noise.
  [[nodiscard]] Image<std::uint8_t> photograph(double noise, std::uint64_t seed) const {
    TestRandom random(seed);
    Image<std::uint8_t> result(picture_.width(), picture_.height(), picture_.channels());
    for (std::size_t i = 0; i < result.values().size(); ++i) {
      const double value = picture_.values()[i] + (noise > 0 ? noise * normal_number(random) : 0);
      result.values()[i] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
    return result;
  }

 private:
  Image<double> picture_;
};

/// Smooth random texture, from 0 to 1: interpolated random numbers on grids of several spacings.
class DrawnTexture {
 public:
  explicit DrawnTexture(std::uint64_t seed, double spacing = 24) : spacing_(spacing) {
    TestRandom random(seed);
    for (double& value : values_) value = random.uniform(0, 1);
  }
  double operator()(double u, double v) const {
    return 0.5 * octave(u / spacing_, v / spacing_) +
           0.3 * octave(2.7 * u / spacing_ + 9, 2.7 * v / spacing_) +
           0.2 * octave(6.1 * u / spacing_, 6.1 * v / spacing_ + 5);
  }

 private:
  [[nodiscard]] double at(int a, int b) const {
    return values_[static_cast<std::size_t>((a & 63) + 64 * (b & 63))];
  }
  [[nodiscard]] double octave(double x, double y) const {
    const int a = static_cast<int>(std::floor(x)), b = static_cast<int>(std::floor(y));
    const double s = x - a, t = y - b;
    const double top = at(a, b) + s * (at(a + 1, b) - at(a, b));
    const double bottom = at(a, b + 1) + s * (at(a + 1, b + 1) - at(a, b + 1));
    return top + t * (bottom - top);
  }

  double spacing_;
  std::vector<double> values_ = std::vector<double>(64 * 64);
};

}  // namespace flexura
