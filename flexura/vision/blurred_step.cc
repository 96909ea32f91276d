#include "flexura/vision/blurred_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

namespace flexura {
namespace {

using Exact = std::array<double, BlurredStep::taps>;

double dot(const Exact& a, const Exact& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Removes from a column its component along a unit column; returns that component.
double take_out(Exact& column, const Exact& unit) {
  const double share = dot(column, unit);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] -= share * unit[i];
  return share;
}

// Normalises a column; returns its length.
double normalize(Exact& column) {
  const double length = std::sqrt(dot(column, column));
  for (double& value : column) value /= length;
  return length;
}

std::array<float, BlurredStep::taps> narrow(const Exact& column) {
  std::array<float, BlurredStep::taps> result{};
  std::ranges::transform(column, result.begin(), [](double x) { return static_cast<float>(x); });
  return result;
}

// Four partial sums, so that the compiler can keep them in one register.
float dot(const std::array<float, BlurredStep::taps>& a, const std::array<float, BlurredStep::taps>& b) {
  static_assert(BlurredStep::taps % 4 == 0);
  std::array<float, 4> sums{};
  for (std::size_t i = 0; i < a.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k) sums[k] += a[i + k] * b[i + k];
  return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

}  // namespace

BlurredStep::BlurredStep(double blur, double phase, int first) {
  Exact constant{}, slope{}, step{}, bell{};
  const bool has_slope = first >= 4;
  for (int i = -first; i <= after; ++i) {
    const int place = i + before;
    const auto tap = static_cast<std::size_t>(place);
    const double x = i - phase, z = x / blur;
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
    const double share = 0.5 * (1 + std::erf(z / std::numbers::sqrt2));
    used_[tap] = 1;
    constant[tap] = 1;
    slope[tap] = has_slope ? x * (1 - share) - blur * density : 0;
    step[tap] = share;
    bell[tap] = density / blur;
  }
  normalize(constant);
  take_out(slope, constant);
  if (has_slope) normalize(slope);
  for (const Exact& unit : {constant, slope}) take_out(step, unit), take_out(bell, unit);
  step_scale_ = static_cast<float>(normalize(step));
  step_of_bell_ = static_cast<float>(take_out(bell, step));
  bell_scale_ = static_cast<float>(normalize(bell));
  constant_ = narrow(constant), slope_ = narrow(slope), step_ = narrow(step), bell_ = narrow(bell);
  used_count_ = static_cast<float>(first + 1 + after);
  free_ = std::max(1, first + 1 + after - (has_slope ? 4 : 3));
}

StepFit BlurredStep::fit(const std::array<float, taps>& values) const {
  // The mean is subtracted so that single precision suffices for the remaining squares.
  Column v{};
  const float mean = dot(values, used_) / used_count_;
  for (std::size_t i = 0; i < taps; ++i) v[i] = used_[i] * (values[i] - mean);
  const float slope = dot(v, slope_), step = dot(v, step_), bell = dot(v, bell_);
  const float shift = bell / bell_scale_, contrast = (step - step_of_bell_ * shift) / step_scale_;
  const float squares = dot(v, v) - slope * slope - step * step - bell * bell;
  return {contrast != 0 ? -shift / contrast : 0, contrast,
          std::sqrt(std::max(0.0, static_cast<double>(squares)) / free_)};
}

std::vector<std::uint8_t> BlurredSteps::blur_places() {
  std::vector<std::uint8_t> result(places);
  for (int i = 0; i < places; ++i) {
    const double blur = std::max(least_blur, widest * (i + 0.5) / places);
    const long place = std::lround(std::log(blur / least_blur) / std::log(ratio));
    result[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::min<long>(place, blurs - 1));
  }
  return result;
}

const BlurredStep& BlurredSteps::of(double blur, double phase, int first, double& at) {
  const int place = std::clamp(static_cast<int>(blur * (places / widest)), 0, places - 1);
  const std::size_t i = blur_of_place_[static_cast<std::size_t>(place)];
  const int j = static_cast<int>(std::lround(std::clamp(phase + 0.5, 0.0, 1.0) * phases));
  const int k = std::clamp(first, 1, BlurredStep::before) - 1;
  at = static_cast<double>(j) / phases - 0.5;
  auto& step = steps_[(i * (phases + 1) + static_cast<std::size_t>(j)) * BlurredStep::before +
                      static_cast<std::size_t>(k)];
  if (!step) step = std::make_unique<BlurredStep>(least_blur * std::pow(ratio, i), at, k + 1);
  return *step;
}

double BlurSeries::least(std::span<const double> left) const {
  const auto best = static_cast<std::size_t>(std::ranges::min_element(left) - left.begin());
  if (best == 0 || best + 1 == left.size()) return at(best);
  const double a = left[best - 1], b = left[best], c = left[best + 1], bend = a - 2 * b + c;
  const double shift = bend > 0 && std::isfinite(bend) ? 0.5 * (a - c) / bend : 0;
  return at(best) * std::pow(ratio, shift);
}

}  // namespace flexura
