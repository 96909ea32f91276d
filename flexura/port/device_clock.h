#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

namespace flexura {

/// Properties of a device's own clock.
struct DeviceClockConfig {
  double window = 60;        ///< Bounds older than this are dropped, s; > 0.
  double drift = 5e-4;       ///< Largest relative rate error of the device's clock.
  double resolution = 1e-6;  ///< Rounding step of the device's times, s; > 0.
  /// Without bounds on the age of answers: by how much one may be quicker than all previous ones, s. An
  /// earlier time is an outlier.
  double jump = 1;
};

/// Conversion of a device's clock to the rig's, learned from the device's times and their times of arrival.
///
/// The only assumption: an answer is true between its request and its arrival. Each answer bounds the line
/// that converts the device's time to the rig's (offset and drift) from both sides. The tightest bounds of
/// each second are kept. The result is the middle between the earliest and the latest time of all lines
/// within the bounds. The bounds are from F. Cristian 1989, the lines from S. Moon, P. Skelly, D. Towsley
/// 1999. So any number of long delays does no harm, and a few short ones suffice.
///
/// If the age of answers is unknown, as for pictures, there are no lower bounds. Then the quickest answers
/// over the window count as having taken the shortest possible time.
class DeviceClock {
 public:
  /// Throws std::invalid_argument if window, resolution or drift is not finite and above 0.
  explicit DeviceClock(const DeviceClockConfig& config = {});

  /// Adds an answer: the device's time `device` is between `earliest` and `latest` s of the rig's time.
  /// `earliest` is minus infinity if unknown. Returns false, and learns nothing, if a number is not finite or
  /// the answer contradicts the known bounds. From the third contradiction in a row on, the device's clock
  /// counts as reset, and contradicting bounds are dropped.
  bool add(double device, double earliest, double latest);

  /// Returns true if rig_time() can answer.
  [[nodiscard]] bool is_known() const { return !seconds_.empty(); }
  /// Returns the rig's time, s, at the device's time `device`, s. Throws std::logic_error if nothing is
  /// known.
  [[nodiscard]] double rig_time(double device) const;
  /// Returns the largest error of rig_time() to either side, s. With known ages of answers it is a strict
  /// bound, otherwise only the spread of the quickest answers. Throws std::logic_error if nothing is known.
  [[nodiscard]] double uncertainty(double device) const;
  /// Returns the relative rate difference by which the rig's clock is faster than the device's, as far as it
  /// is known. Throws std::logic_error if nothing is known.
  [[nodiscard]] double drift() const;

 private:
  // x: the device's time since its first answer, s; y: how much more time has passed on the rig's clock, s.
  struct Bound {
    double x = 0, y = 0;
  };
  struct Second {
    std::int64_t number = 0;  // Second of the rig's clock.
    std::optional<Bound> lower;
    Bound upper;
  };
  using Slopes = std::array<double, 2>;

  void require_known() const;
  void start(double device, double latest);
  void keep(double device, double earliest, double latest);
  // Returns the least and the greatest slope of the lines within all bounds; std::nullopt if there are no
  // such lines.
  [[nodiscard]] std::optional<Slopes> possible_slopes() const;
  // Return the highest and the lowest crossing of x = 0 of the lines with this slope.
  [[nodiscard]] double highest(double slope) const;
  [[nodiscard]] double lowest(double slope) const;
  [[nodiscard]] bool has_lower() const;
  // Returns the slope of the line through the quickest answers.
  [[nodiscard]] double quickest_slope() const;
  // Returns the earliest and the latest y at x.
  [[nodiscard]] std::array<double, 2> range(double x) const;
  [[nodiscard]] bool is_early(double device, double latest) const;

  DeviceClockConfig config_;
  double device_origin_ = 0, rig_origin_ = 0;
  std::deque<Second> seconds_;
  Slopes slopes_ = {0, 0};
  int outliers_ = 0;  // Outliers in a row.
};

}  // namespace flexura
