#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/math/monotone_cubic.h"

namespace flexura {

/// A measured position of a zoom, `[[camera.lens.zoom]]`. Omitted values follow from the lens at ratio 1.
struct ZoomRow {
  double ratio = 1;                      ///< Focal length over that at ratio 1; > 0.
  std::optional<double> count;           ///< Count of the zoom's motor.
  std::optional<double> fx, fy, cx, cy;  ///< px; default: the lens's, with fx and fy times the ratio.
  std::optional<std::array<double, 5>> distortion;  ///< k1, k2, p1, p2, k3; default: the lens's.
};

/// A zoom lens as described in a file: the lens at ratio 1 and its changes.
struct LensConfig {
  double fx = 800;                                     ///< Focal length at ratio 1, px.
  std::optional<double> fy;                            ///< Focal length, px; default: fx.
  std::optional<double> cx, cy;                        ///< Principal point, px; default: the image's middle.
  std::array<double, 5> distortion = {0, 0, 0, 0, 0};  ///< k1, k2, p1, p2, k3, at ratio 1.
  std::vector<ZoomRow> zoom;                           ///< Rows by rising ratio. Empty: linear zoom.
};

const Table<ZoomRow>& fields_of(const ZoomRow*);
const Table<LensConfig>& fields_of(const LensConfig*);

/// The lens over the positions of its zoom. A position is a motor count if the table's rows have counts,
/// otherwise the ratio itself.
///
/// Without rows the zoom is linear, as the paper assumes: f = f_1 ratio; principal point and distortion are
/// constant. With rows, the logarithm of a focal length is a monotone cubic of the motor count or, without
/// counts, of the logarithm of the ratio. (Rows of the linear law then reproduce it.) Principal point and
/// distortion are monotone cubics, too. All have continuous slopes and never leave the range of two
/// neighbouring rows.
class ZoomTable {
 public:
  /// For images of this size, px. Throws std::invalid_argument for what `fault` finds.
  ZoomTable(const LensConfig& config, std::int64_t width, std::int64_t height);

  /// An error in a lens, with its place in the table.
  struct Fault {
    std::string path, what;  ///< Path in the lens's table, such as "zoom[1].ratio"; what is expected there.
  };
  /// Returns why the rows do not form a zoom, if so. Ratios and focal lengths must rise, counts must be
  /// monotone and present in all rows or none, and a single row is not enough.
  [[nodiscard]] static std::optional<Fault> fault(const LensConfig& config);

  /// The range of positions with a lens: that of the rows, or all above 0.
  [[nodiscard]] double first() const { return first_; }
  [[nodiscard]] double last() const { return last_; }
  /// Returns whether there are no rows.
  [[nodiscard]] bool is_linear() const { return curves_.empty(); }

  /// Returns the lens at `zoom`. Positions beyond an end by rounding only (1e-9 of it) count as that end.
  /// Throws std::out_of_range further outside, where no lens is known; the head's limits prevent this.
  [[nodiscard]] Intrinsics at(double zoom) const;
  /// Returns d intrinsics / d zoom, in the order of `intrinsics_count`, per unit of position. Throws as at()
  /// does.
  [[nodiscard]] Eigen::Vector<double, intrinsics_count> slope(double zoom) const;
  /// Returns the derivative of each value of the lens at `zoom` by the corresponding value of row `row`. That
  /// value may be written or derived from the lens at ratio 1; ratios and counts are fixed. Throws as at()
  /// does, and std::out_of_range for a missing row.
  [[nodiscard]] Eigen::Vector<double, intrinsics_count> by_row(double zoom, std::size_t row) const;
  /// Returns the derivative by the corresponding value of the lens at ratio 1, directly or through rows that
  /// omit it. Throws as at() does.
  [[nodiscard]] Eigen::Vector<double, intrinsics_count> by_lens(double zoom) const;
  /// Returns the ratio at `zoom`, interpolated like the focal lengths. Throws as at() does.
  [[nodiscard]] double ratio(double zoom) const;
  /// Returns its derivative per unit of position. Throws as at() does.
  [[nodiscard]] double ratio_slope(double zoom) const;

 private:
  [[nodiscard]] double within(double zoom) const;
  [[nodiscard]] double abscissa(double zoom) const;

  Intrinsics one_;  // At ratio 1.
  double first_ = std::numeric_limits<double>::min(), last_ = std::numeric_limits<double>::max();
  bool by_count_ = false;
  bool is_reversed_ = false;  // Whether the curves' points are the file's rows in reverse order.
  // By row of the curves: each value, and its derivative by that of the lens at ratio 1.
  std::vector<Eigen::Vector<double, intrinsics_count>> rows_, rows_by_lens_;
  std::vector<MonotoneCubic> curves_;  // log fx, log fy, cx, ..., log ratio; empty: linear
};

}  // namespace flexura
