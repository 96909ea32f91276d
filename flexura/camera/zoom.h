#pragma once

#include <Eigen/Core>
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

/// A row of the zoom table: a measured zoom position, `[[camera.lens.zoom]]`. Omitted values are derived from
/// the lens at ratio 1.
struct ZoomRow {
  double ratio = 1;             ///< Zoom ratio: focal length divided by the focal length at ratio 1; > 0.
  std::optional<double> count;  ///< Position of the zoom motor.
  /// Focal lengths and principal point, px. Default: the values at ratio 1; for fx and fy, the values at
  /// ratio 1 times the ratio.
  std::optional<double> fx, fy, cx, cy;
  std::optional<Distortion> distortion;  ///< Distortion coefficients; default: the values at ratio 1.
};

/// A zoom lens in a file: parameters at zoom ratio 1 and their change with zoom.
struct LensConfig {
  double fx = 800;                     ///< Horizontal focal length at ratio 1, px.
  std::optional<double> fy;            ///< Vertical focal length at ratio 1, px; default: fx.
  std::optional<double> cx, cy;        ///< Principal point at ratio 1, px; default: the image's middle.
  LensModel model = LensModel::brown;  ///< Lens model at all zoom positions.
  /// Distortion coefficients at ratio 1. If all are 0, their number need not be that of the model.
  Distortion distortion;
  std::vector<ZoomRow> zoom;  ///< Zoom table, in order of increasing ratio. Empty: linear zoom.
};

const Table<ZoomRow>& fields_of(const ZoomRow*);
const Table<LensConfig>& fields_of(const LensConfig*);

/// The intrinsics of a zoom lens as a function of the zoom position. A position is a motor position if the
/// rows of the table have counts, otherwise a zoom ratio.
///
/// Without rows, the zoom is linear, as the paper assumes: f = f_1 ratio, with constant principal point and
/// distortion. With rows, each parameter is a monotone cubic spline through the rows. The splines are
/// functions of the motor position or, without counts, of the logarithm of the ratio. Focal lengths are
/// interpolated as logarithms, so that rows of a linear zoom reproduce the linear zoom exactly. All
/// parameters have continuous derivatives and stay within the range of the two neighbouring rows.
class ZoomTable {
 public:
  /// Makes the table of a lens for images of this size, px. Throws std::invalid_argument if fault() finds an
  /// error.
  ZoomTable(const LensConfig& config, std::int64_t width, std::int64_t height);

  /// An error in a lens, with its path in the lens's table.
  struct Fault {
    std::string path, what;  ///< Path of the error, such as "zoom[1].ratio", and the error text.
  };
  /// Returns the first error in the lens; std::nullopt for a valid lens. There must be no row or at least two
  /// rows. Ratios and focal lengths must increase from row to row. Either all rows or no rows have a count.
  /// Counts must either increase or decrease strictly. The numbers of distortion coefficients must be that of
  /// the model.
  [[nodiscard]] static std::optional<Fault> fault(const LensConfig& config);

  /// Returns the smallest and the largest zoom position: the range of the rows or, without rows, all positive
  /// numbers.
  [[nodiscard]] double first() const { return first_; }
  [[nodiscard]] double last() const { return last_; }
  /// Returns whether the zoom is linear, which means that the table has no rows.
  [[nodiscard]] bool is_linear() const { return curves_.empty(); }

  /// Returns the intrinsics at the position `zoom`. Positions that are beyond first() or last() because of
  /// rounding (1e-9 relative) are clamped. Throws std::out_of_range for positions further outside; the head's
  /// limits exclude them.
  [[nodiscard]] Intrinsics at(double zoom) const;
  /// Returns the derivative of the intrinsics with respect to the zoom position, in the order of
  /// `intrinsics_count`. Throws std::out_of_range like at().
  [[nodiscard]] Eigen::Vector<double, intrinsics_count> slope(double zoom) const;
  /// Returns the derivative of each intrinsic parameter at `zoom` with respect to this parameter in row
  /// `row`. The row's parameter may be written in the file or derived from the lens at ratio 1. Ratios and
  /// counts are constant. Throws std::out_of_range like at(), and for a row that does not exist.
  [[nodiscard]] Eigen::Vector<double, intrinsics_count> by_row(double zoom, std::size_t row) const;
  /// Returns the derivative of each intrinsic parameter at `zoom` with respect to this parameter at ratio 1.
  /// With a table, only rows that omit the parameter depend on its value at ratio 1. Throws std::out_of_range
  /// like at().
  [[nodiscard]] Eigen::Vector<double, intrinsics_count> by_lens(double zoom) const;
  /// Returns the zoom ratio at `zoom`, interpolated like the focal lengths. Throws std::out_of_range like
  /// at().
  [[nodiscard]] double ratio(double zoom) const;
  /// Returns the derivative of the zoom ratio with respect to the zoom position. Throws std::out_of_range
  /// like at().
  [[nodiscard]] double ratio_slope(double zoom) const;

 private:
  [[nodiscard]] double within(double zoom) const;
  [[nodiscard]] double abscissa(double zoom) const;

  Intrinsics one_;  // Intrinsics at ratio 1.
  double first_ = std::numeric_limits<double>::min(), last_ = std::numeric_limits<double>::max();
  bool by_count_ = false;
  bool is_reversed_ = false;  // Whether the curves' points are the file's rows in reverse order.
  // For each point of the curves: the intrinsics, and the derivative of each with respect to the same
  // parameter at ratio 1.
  std::vector<Eigen::Vector<double, intrinsics_count>> rows_, rows_by_lens_;
  std::vector<MonotoneCubic> curves_;  // log fx, log fy, cx, ..., log ratio; empty: linear
};

}  // namespace flexura
