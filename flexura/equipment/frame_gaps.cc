#include "flexura/equipment/frame_gaps.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace flexura {
namespace {

constexpr std::size_t fewest_intervals = 7, most_intervals = 31;
constexpr double most_lost = 1e9;

}  // namespace

double StampGaps::period() const {
  if (intervals_.size() < fewest_intervals) return first_period_;
  std::vector<double> sorted(intervals_.begin(), intervals_.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  return *middle;
}

std::int64_t StampGaps::lost_before(double stamp) {
  if (!std::isfinite(stamp)) return 0;
  if (!last_ || !(stamp > *last_)) return last_ = stamp, 0;
  const double interval = stamp - *last_;
  last_ = stamp;
  const double frames = std::min(std::round(interval / period()), most_lost);
  intervals_.push_back(interval);
  if (intervals_.size() > most_intervals) intervals_.pop_front();
  return std::max<std::int64_t>(std::int64_t(frames) - 1, 0);
}

std::int64_t NumberGaps::lost_before(std::uint64_t number) {
  if (!last_) return last_ = number, 0;
  const std::uint64_t last = *last_, half = (end_ - first_) / 2;
  last_ = number;
  if (number > last)
    return std::int64_t(std::min<std::uint64_t>(number - last - 1, std::uint64_t(most_lost)));
  if (number == last || last - number <= half) return 0;
  return std::int64_t((end_ - last) + (number - std::min(number, first_)));
}

}  // namespace flexura
