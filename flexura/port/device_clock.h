#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

namespace flexura {

/// How the times of a device with a clock of its own are to be understood.
struct DeviceClockConfig {
  double window = 60;        ///< What was learned longer ago is forgotten, s; > 0.
  double drift = 5e-4;       ///< How much faster or slower the device's clock may go than the rig's, a share.
  double resolution = 1e-6;  ///< To what the device's times are rounded, s; > 0.
  /// Where nothing bounds how old answers are: by how much one may be quicker than all before, s. A time that
  /// is earlier is odd.
  double jump = 1;
};

/// The time of a device's clock as the rig's, learned from what the device says and when it says it.
///
/// An answer cannot come before it was asked for, nor after it came: that is all that is believed. Each
/// answer bounds the line that makes the rig's times of the device's, offset and drift, to both sides; of
/// each second the tightest bounds are kept. The time is the middle between the earliest and the latest that
/// all lines within the bounds have (F. Cristian 1989 has the bounds, S. Moon, P. Skelly, D. Towsley 1999 the
/// lines). So long delays, however many, do no harm, and few short ones suffice.
///
/// Where nothing is known of how old an answer may be, as with pictures, there are no earliest times. Then
/// the quickest answers over the window are believed to have taken as long as they must, and no more.
class DeviceClock {
 public:
  /// std::invalid_argument: a window, a resolution or a drift that is not finite and above 0.
  explicit DeviceClock(const DeviceClockConfig& config = {});

  /// What the device calls `device` s was not before `earliest` s of the rig's time, minus infinity where
  /// that is not known, and not after `latest` s. False, and nothing is learned, where that cannot be:
  /// numbers that are none, or a time that contradicts what is known. From the third such in a row on the
  /// clock is taken to have been set anew, and what contradicts them is forgotten.
  bool add(double device, double earliest, double latest);

  /// Whether anything is known.
  [[nodiscard]] bool is_known() const { return !seconds_.empty(); }
  /// The rig's time when the device's clock shows `device` s; std::logic_error: nothing is known.
  [[nodiscard]] double rig_time(double device) const;
  /// By how much that may be wrong to either side, s. A bound, where it was learned how old answers may be;
  /// else no more than how evenly the quickest answers come. std::logic_error likewise.
  [[nodiscard]] double uncertainty(double device) const;
  /// By which share the rig's clock goes faster than the device's, as far as it is known. Likewise.
  [[nodiscard]] double drift() const;

 private:
  // x: the device's time since the first, y: how much more the rig's has passed since then, s.
  struct Bound {
    double x = 0, y = 0;
  };
  struct Second {
    std::int64_t number = 0;  // of the rig's
    std::optional<Bound> lower;
    Bound upper;
  };
  using Slopes = std::array<double, 2>;

  void require_known() const;
  void start(double device, double latest);
  void keep(double device, double earliest, double latest);
  // The slopes of the lines that all bounds leave, from the least to the greatest; none: they leave none.
  [[nodiscard]] std::optional<Slopes> possible_slopes() const;
  // Of the lines of a slope, where the highest and the lowest cross x = 0.
  [[nodiscard]] double highest(double slope) const;
  [[nodiscard]] double lowest(double slope) const;
  [[nodiscard]] bool has_lower() const;
  // The line of the quickest answers; its slope.
  [[nodiscard]] double quickest_slope() const;
  // The earliest and the latest y at x.
  [[nodiscard]] std::array<double, 2> range(double x) const;
  [[nodiscard]] bool is_early(double device, double latest) const;

  DeviceClockConfig config_;
  double device_origin_ = 0, rig_origin_ = 0;
  std::deque<Second> seconds_;
  Slopes slopes_ = {0, 0};
  int odd_ = 0;  // in a row
};

}  // namespace flexura
