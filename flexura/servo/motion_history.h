#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace flexura {

/// Recent readings of a device, for interpolation at the time of a picture. `blend(a, b, share)` returns the
/// value at the fraction `share` of the way from a to b.
template <class Value, class Blend>
class MotionHistory {
 public:
  /// Keeps the readings of the last `span` s before the newest one, and one older reading.
  MotionHistory(double span, Blend blend) : span_(span), blend_(std::move(blend)) {}

  /// Adds a reading. Skips a reading that is not newer than the last one.
  void add(double time, Value value) {
    if (!readings_.empty() && !(time > readings_.back().first)) return;
    readings_.emplace_back(time, std::move(value));
    while (readings_.size() > 2 && readings_[1].first < time - span_) readings_.pop_front();
  }

  /// Returns the time of the first kept reading, s. Requires a reading.
  [[nodiscard]] double since() const { return readings_.front().first; }

  /// Returns the time of the newest reading, s. Requires a reading.
  [[nodiscard]] double newest() const { return readings_.back().first; }

  /// Returns the times of the readings after `from` and before `to`, s, in order.
  [[nodiscard]] std::vector<double> times_between(double from, double to) const {
    std::vector<double> times;
    for (const auto& reading : readings_)
      if (reading.first > from && reading.first < to) times.push_back(reading.first);
    return times;
  }

  [[nodiscard]] bool is_empty() const { return readings_.empty(); }

  /// Returns the value at `time`, s, by linear interpolation between two readings. Returns the first reading
  /// for earlier times, and the last reading for later times. Returns std::nullopt if there is no reading.
  [[nodiscard]] std::optional<Value> at(double time) const {
    if (readings_.empty()) return std::nullopt;
    const auto after = std::ranges::upper_bound(readings_, time, {}, &std::pair<double, Value>::first);
    if (after == readings_.begin()) return readings_.front().second;
    if (after == readings_.end()) return readings_.back().second;
    const auto before = std::prev(after);
    return blend_(before->second, after->second, (time - before->first) / (after->first - before->first));
  }

 private:
  double span_;
  Blend blend_;
  std::deque<std::pair<double, Value>> readings_;
};

}  // namespace flexura
