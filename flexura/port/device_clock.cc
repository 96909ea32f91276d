#include "flexura/port/device_clock.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Returns the argument that maximizes a concave function (golden section search).
double greatest(double low, double high, const std::function<double(double)>& f) {
  constexpr double golden = 0.6180339887498949;
  constexpr int steps = 40;  // To 1e-11 of the interval.
  double a = high - golden * (high - low), b = low + golden * (high - low), at_a = f(a), at_b = f(b);
  for (int i = 0; i < steps; ++i) {
    if (at_a < at_b) {
      low = a, a = b, at_a = at_b;
      b = low + golden * (high - low), at_b = f(b);
    } else {
      high = b, b = a, at_b = at_a;
      a = high - golden * (high - low), at_a = f(a);
    }
  }
  return at_a < at_b ? b : a;
}

// Returns the point farthest from `inside`, towards `outside`, at which the concave f is still >= 0.
// f(inside) >= 0.
double last_inside(double inside, double outside, const std::function<double(double)>& f) {
  if (f(outside) >= 0) return outside;
  constexpr int steps = 40;  // To 1e-11 of the interval.
  for (int i = 0; i < steps; ++i) {
    const double middle = 0.5 * (inside + outside);
    (f(middle) >= 0 ? inside : outside) = middle;
  }
  return inside;
}

bool is_above_zero(double value) { return std::isfinite(value) && value > 0; }

}  // namespace

DeviceClock::DeviceClock(const DeviceClockConfig& config) : config_(config) {
  if (!is_above_zero(config.window) || !is_above_zero(config.drift) || !is_above_zero(config.resolution))
    throw std::invalid_argument("a device's clock needs a window, a drift and a resolution above 0");
}

double DeviceClock::highest(double slope) const {
  double least = infinity;
  for (const Second& second : seconds_) least = std::min(least, second.upper.y - slope * second.upper.x);
  return least;
}

double DeviceClock::lowest(double slope) const {
  double greatest_of_all = -infinity;
  for (const Second& second : seconds_)
    if (second.lower) greatest_of_all = std::max(greatest_of_all, second.lower->y - slope * second.lower->x);
  return greatest_of_all;
}

bool DeviceClock::has_lower() const {
  return std::ranges::any_of(seconds_, [](const Second& second) { return second.lower.has_value(); });
}

std::optional<DeviceClock::Slopes> DeviceClock::possible_slopes() const {
  if (!has_lower()) return Slopes{-config_.drift, config_.drift};
  const auto room = [this](double slope) { return highest(slope) - lowest(slope); };
  const double widest = greatest(-config_.drift, config_.drift, room);
  if (room(widest) < 0) return std::nullopt;
  return Slopes{last_inside(widest, -config_.drift, room), last_inside(widest, config_.drift, room)};
}

double DeviceClock::quickest_slope() const {
  double middle = 0;
  for (const Second& second : seconds_) middle += second.upper.x / static_cast<double>(seconds_.size());
  return greatest(slopes_[0], slopes_[1], [&](double slope) { return highest(slope) + slope * middle; });
}

std::array<double, 2> DeviceClock::range(double x) const {
  const double up =
      greatest(slopes_[0], slopes_[1], [&](double slope) { return highest(slope) + slope * x; });
  const double down =
      greatest(slopes_[0], slopes_[1], [&](double slope) { return -(lowest(slope) + slope * x); });
  return {lowest(down) + down * x, highest(up) + up * x};
}

void DeviceClock::require_known() const {
  if (!is_known())
    throw std::logic_error("the device's clock is unknown: the device has not reported a time");
}

double DeviceClock::rig_time(double device) const {
  require_known();
  const double x = device - device_origin_;
  if (!has_lower()) {
    const double slope = quickest_slope();
    // The bounds allow for the rounding of the device's times on both sides.
    return rig_origin_ + x + (highest(slope) + slope * x - config_.resolution);
  }
  const auto [low, high] = range(x);
  return rig_origin_ + x + 0.5 * (low + high);
}

double DeviceClock::uncertainty(double device) const {
  require_known();
  const double x = device - device_origin_;
  if (has_lower()) {
    const auto [low, high] = range(x);
    return std::max(0.5 * (high - low), config_.resolution);
  }
  const double slope = quickest_slope(), line = highest(slope);
  std::vector<double> later;
  later.reserve(seconds_.size());
  for (const Second& second : seconds_) later.push_back(second.upper.y - slope * second.upper.x - line);
  const auto middle = later.begin() + static_cast<std::ptrdiff_t>(later.size() / 2);
  std::ranges::nth_element(later, middle);
  return *middle + config_.resolution;
}

double DeviceClock::drift() const {
  require_known();
  return has_lower() ? 0.5 * (slopes_[0] + slopes_[1]) : quickest_slope();
}

void DeviceClock::start(double device, double latest) {
  seconds_.clear();
  device_origin_ = device, rig_origin_ = latest;
}

void DeviceClock::keep(double device, double earliest, double latest) {
  const double x = device - device_origin_;
  const Bound upper{x, (latest - rig_origin_) - x + config_.resolution};
  const Bound lower{x, (earliest - rig_origin_) - x - config_.resolution};
  const auto number = static_cast<std::int64_t>(std::floor(latest));
  if (seconds_.empty() || seconds_.back().number < number) seconds_.push_back({number, {}, upper});
  Second& second = seconds_.back();
  if (upper.y < second.upper.y) second.upper = upper;
  if (std::isfinite(earliest) && (!second.lower || lower.y > second.lower->y)) second.lower = lower;
  while (static_cast<double>(seconds_.back().number - seconds_.front().number) > config_.window)
    seconds_.pop_front();
}

// Returns whether a time is earlier than any answer can be. Without lower bounds such a time contradicts no
// bound.
bool DeviceClock::is_early(double device, double latest) const {
  return is_known() && !has_lower() && latest < rig_time(device) - config_.jump;
}

bool DeviceClock::add(double device, double earliest, double latest) {
  if (!std::isfinite(device) || !std::isfinite(latest) || !(earliest <= latest)) return false;
  if (!is_known()) start(device, latest);
  constexpr int patience = 3;
  const std::deque<Second> before = seconds_;
  const bool is_outlier = is_early(device, latest);
  keep(device, earliest, latest);
  auto slopes = possible_slopes();
  if (is_outlier || !slopes) {
    if (++outliers_ < patience) {
      seconds_ = before;
      return false;
    }
    // Only those earlier bounds remain that agree with these times.
    if (is_outlier) {
      start(device, latest);
      keep(device, earliest, latest);
    }
    while (!(slopes = possible_slopes()) && seconds_.size() > 1) seconds_.pop_front();
    if (!slopes) {
      start(device, latest);
      keep(device, earliest, latest);
      slopes = possible_slopes();
    }
  }
  outliers_ = 0;
  slopes_ = slopes.value_or(Slopes{-config_.drift, config_.drift});
  return true;
}

}  // namespace flexura
