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

/// A measured position of a zoom, `[[camera.lens.zoom]]`. What is left out follows from the lens at ratio 1.
struct ZoomRow {
  double ratio = 1;                                 ///< Focal length over that at ratio 1; > 0.
  std::optional<double> count;                      ///< Of the zoom's motor.
  std::optional<double> fx, fy, cx, cy;             ///< px; else the lens's, fx and fy times the ratio.
  std::optional<std::array<double, 5>> distortion;  ///< k1, k2, p1, p2, k3; the lens's when left out.
};

/// A zoom lens as the file describes it: the lens at ratio 1, and how it changes.
struct LensConfig {
  double fx = 800;                                     ///< px, at ratio 1
  std::optional<double> fy;                            ///< px; fx when left out.
  std::optional<double> cx, cy;                        ///< px; the image's middle when left out.
  std::array<double, 5> distortion = {0, 0, 0, 0, 0};  ///< k1, k2, p1, p2, k3, at ratio 1.
  std::vector<ZoomRow> zoom;                           ///< By rising ratio. Empty: the linear zoom.
};

const Table<ZoomRow>& fields_of(const ZoomRow*);
const Table<LensConfig>& fields_of(const LensConfig*);

/// The lens over the positions of its zoom. A position is a motor count where the table's rows have counts,
/// and otherwise the ratio itself.
///
/// Without rows the zoom is linear, as the paper assumes: f = f_1 ratio; principal point and distortion do
/// not change. With rows, the logarithm of a focal length is a monotone cubic of the motor count, or of the
/// logarithm of the ratio (which makes rows of the linear law give that law), and so are principal point
/// and distortion: continuous with their slopes, and never outside two neighbouring rows.
class ZoomTable {
 public:
  /// For images of this size, px. std::invalid_argument: what `fault` finds.
  ZoomTable(const LensConfig& config, std::int64_t width, std::int64_t height);

  /// What is wrong with a lens, and where in its table.
  struct Fault {
    std::string path, what;  ///< In the lens's table, "zoom[1].ratio"; what is expected there.
  };
  /// What keeps the rows from being a zoom, if anything does: ratios and focal lengths that do not rise,
  /// counts that neither all rise nor all fall, or that some rows lack, a single row.
  [[nodiscard]] static std::optional<Fault> fault(const LensConfig& config);

  /// The positions for which there is a lens: those of the rows, or all above 0.
  [[nodiscard]] double first() const { return first_; }
  [[nodiscard]] double last() const { return last_; }
  /// Whether there are no rows.
  [[nodiscard]] bool is_linear() const { return curves_.empty(); }

  /// The lens at `zoom`. Past an end by no more than rounding (1e-9 of it) is at that end; further outside
  /// is an std::out_of_range, since no lens is known there: the head's limits keep it from happening.
  [[nodiscard]] Intrinsics at(double zoom) const;
  /// d intrinsics / d zoom, in the order of `intrinsics_count`, by one position of the zoom. The same errors.
  [[nodiscard]] Eigen::Vector<double, intrinsics_count> slope(double zoom) const;
  /// How each number of the lens at `zoom` changes with the same number of row `row` of the file, as it
  /// stands there or follows from the lens at ratio 1; ratios and counts stay. The same errors; and
  /// std::out_of_range for a row that is not there.
  [[nodiscard]] Eigen::Vector<double, intrinsics_count> by_row(double zoom, std::size_t row) const;
  /// And with the same number of the lens at ratio 1, directly or through rows that leave it out.
  /// The same errors.
  [[nodiscard]] Eigen::Vector<double, intrinsics_count> by_lens(double zoom) const;
  /// The ratio at `zoom`, interpolated as the focal lengths are. The same errors.
  [[nodiscard]] double ratio(double zoom) const;
  /// Its derivative by one position of the zoom. The same errors.
  [[nodiscard]] double ratio_slope(double zoom) const;

 private:
  [[nodiscard]] double within(double zoom) const;
  [[nodiscard]] double abscissa(double zoom) const;

  Intrinsics one_;  // at ratio 1
  double first_ = std::numeric_limits<double>::min(), last_ = std::numeric_limits<double>::max();
  bool by_count_ = false;
  bool is_reversed_ = false;  // the curves' points: the file's rows, the last one first
  // By row of the curves: each number, and how it changes with that of the lens at ratio 1.
  std::vector<Eigen::Vector<double, intrinsics_count>> rows_, rows_by_lens_;
  std::vector<MonotoneCubic> curves_;  // log fx, log fy, cx, ..., log ratio; none: linear
};

}  // namespace flexura
