#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace flexura {

/// Counts lost frames by gaps between the frames' time stamps. The frame period is the median of recent
/// intervals. The reason is that cameras change their frame rate in the dark, and that streams often state a
/// wrong frame rate.
class StampGaps {
 public:
  /// `frame_rate`, Hz, > 0: the expected rate, used until enough frames have arrived.
  explicit StampGaps(double frame_rate) : first_period_(1 / frame_rate) {}

  /// Adds the time stamp of the next frame, s. Returns the number of frames lost since the previous frame.
  /// Returns 0 for the first frame, and for a time stamp that is not later than the previous time stamp.
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
  /// The numbers increase from `first` to `last`, and then restart at `first`.
  NumberGaps(std::uint64_t first, std::uint64_t last) : first_(first), end_(last) {}

  /// Adds the number of the next frame. Returns the number of frames lost since the previous frame; 0 for the
  /// first frame. If the number equals the previous number, or lies behind the previous number in the cyclic
  /// range, the camera has restarted its count, and the result is 0 too.
  std::int64_t lost_before(std::uint64_t number);
  /// Extends the range to 64 bits. Called when a frame number exceeds the range.
  void widen() { end_ = UINT64_MAX; }

 private:
  std::uint64_t first_, end_;
  std::optional<std::uint64_t> last_;
};

}  // namespace flexura
