#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

namespace flexura {

/// Assumptions about a device's own clock.
struct DeviceClockConfig {
  double window = 60;        ///< Age above which bounds are dropped, s; > 0.
  double drift = 5e-4;       ///< Largest relative rate error of the device's clock.
  double resolution = 1e-6;  ///< Resolution of the device's times, s; > 0.
  /// For answers of unknown age: an answer that seems to be quicker than all previous answers by more than
  /// this time counts as an outlier, s.
  double jump = 1;
};

/// Conversion of times of a device's clock to times of the rig's clock. The conversion is estimated from the
/// device's times in answers and from the answers' times of arrival.
///
/// The only assumption is that the device reads its clock between the request and the arrival of the answer.
/// Each answer then determines a lower and an upper bound on the line (offset and drift) that converts device
/// time to rig time. The tightest bounds of each second are kept. The result is the middle between the
/// earliest and the latest time of all lines within the bounds. Long delays result in loose bounds, which do
/// no harm. A few short delays are sufficient. The bounds are from Cristian 1989, the lines from Moon,
/// Skelly, Towsley 1999.
///
/// If the age of answers is unknown, as for pictures, there are no lower bounds. The quickest answers within
/// the window are then assumed to have the shortest possible delay.
class DeviceClock {
 public:
  /// Throws std::invalid_argument if window, resolution or drift is not finite and above 0.
  explicit DeviceClock(const DeviceClockConfig& config = {});

  /// Adds an answer: the device's time `device`, s, is between the rig's times `earliest` and `latest`, s.
  /// `earliest` is minus infinity if unknown. Returns false and ignores the answer if a number is not finite
  /// or the answer contradicts the known bounds. After the third consecutive contradiction, the device's
  /// clock counts as reset, and the bounds that the answer contradicts are discarded.
  bool add(double device, double earliest, double latest);

  /// Returns whether rig_time() has enough answers for a result.
  [[nodiscard]] bool is_known() const { return !seconds_.empty(); }
  /// Returns the time on the rig's clock, s, at the device's time `device`, s. Throws std::logic_error unless
  /// is_known().
  [[nodiscard]] double rig_time(double device) const;
  /// Returns the largest possible error of rig_time(device) in either direction, s. If the ages of answers
  /// are known, the result is a strict bound. Otherwise the result is only the spread of the quickest
  /// answers. Throws std::logic_error unless is_known().
  [[nodiscard]] double uncertainty(double device) const;
  /// Returns the estimated relative rate difference by which the rig's clock is faster than the device's
  /// clock. Throws std::logic_error unless is_known().
  [[nodiscard]] double drift() const;

 private:
  // x: device time since the device's first answer, s. y: rig time since then minus device time since then,
  // s.
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
  // Returns the smallest and the largest slope of all lines within the bounds; std::nullopt if there are no
  // such lines.
  [[nodiscard]] std::optional<Slopes> possible_slopes() const;
  // Return the largest and the smallest y at x = 0 of lines with this slope within the bounds.
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
