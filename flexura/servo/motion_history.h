#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

namespace flexura {

/// What a device said of itself over the last while, to be asked what was true when a picture was taken.
/// `blend(a, b, share)` is the value that share of the way from a to b.
template <class Value, class Blend>
class MotionHistory {
 public:
  /// Readings older than `span` s before the newest are forgotten, but for one.
  MotionHistory(double span, Blend blend) : span_(span), blend_(std::move(blend)) {}

  /// A reading that is not newer than the one before is passed over.
  void add(double time, Value value) {
    if (!readings_.empty() && !(time > readings_.back().first)) return;
    readings_.emplace_back(time, std::move(value));
    while (readings_.size() > 2 && readings_[1].first < time - span_) readings_.pop_front();
  }

  /// Since when there are readings, s; there is one.
  [[nodiscard]] double since() const { return readings_.front().first; }

  [[nodiscard]] bool is_empty() const { return readings_.empty(); }

  /// In straight lines between two readings; the first one before all of them, the last one after. None where
  /// there is no reading.
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
