#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace flexura {

/// Counts lost frames by gaps between the frames' time stamps. The camera's period is the median of recent
/// intervals, because cameras change their frame rate in the dark and streams often state a wrong one.
class StampGaps {
 public:
  /// `frame_rate`, Hz, > 0: the expected rate, used until enough frames have arrived.
  explicit StampGaps(double frame_rate) : first_period_(1 / frame_rate) {}

  /// Takes the time stamp of the next frame, s. Returns the number of frames lost since the previous one; 0
  /// for the first frame, and for a stamp that is not later than the previous one.
  std::int64_t lost_before(double stamp);

 private:
  [[nodiscard]] double period() const;

  double first_period_;
  std::optional<double> last_;
  std::deque<double> intervals_;  // s
};

/// Counts lost frames by the camera's frame numbers.
class NumberGaps {
 public:
  /// The numbers run from `first` to `last` and then start again at `first`.
  NumberGaps(std::uint64_t first, std::uint64_t last) : first_(first), end_(last) {}

  /// Takes the number of the next frame. Returns the number of frames lost since the previous one; 0 for the
  /// first frame. A number that is smaller by more than half the range, or equal, is a restart of the
  /// camera's count, and counts as no loss.
  std::int64_t lost_before(std::uint64_t number);
  /// Makes the range that of 64 bits, when a number turns out to be larger.
  void widen() { end_ = UINT64_MAX; }

 private:
  std::uint64_t first_, end_;
  std::optional<std::uint64_t> last_;
};

}  // namespace flexura
