#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/simd.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

namespace flexura {

struct SimdKernels;

/// Many states of one arm of n sections, as structure of arrays: a row of `count` numbers for each quantity,
/// the number of arm j at row * count + j. The numbers belong to the caller.
struct BatchStates {
  std::size_t count = 0;                 ///< Arms.
  std::span<const double> bend_x;        ///< n rows, rad, base first.
  std::span<const double> bend_y;        ///< n rows, rad; for a planar arm, whose bend_y is 0, none.
  std::span<const double> stretch = {};  ///< n rows; none for arms that do not stretch.
};

/// Forward kinematics and tip Jacobians of many states of one arm at a time, several in each instruction, and
/// of single ones without allocation. A function gives one state the same bits wherever it stands in a batch
/// and on every path, and a spatial arm's state the same alone; from those of section_frames and tip_jacobian
/// they differ by no more than rounding (1e-14 of the arm's length). A state that is not finite gives results
/// that are not, for its arm alone. An object is never written to after its construction: threads may share
/// it.
///
/// Frames are 12 rows each: position x, y, z in W, m, then the rotation column by column. All sizes have to
/// fit, else std::invalid_argument.
class BatchKinematics {
 public:
  /// `path` has to be available, else std::invalid_argument.
  explicit BatchKinematics(const Arm& arm, SimdPath path = best_simd_path());

  /// X_WT of every arm, 12 rows.
  void tips(const BatchStates& states, std::span<double> frames) const;
  /// The base frame of each section and, last, the tip, 12 (n + 1) rows.
  void section_frames(const BatchStates& states, std::span<double> frames) const;
  /// The positions of these alone, 3 (n + 1) rows.
  void base_points(const BatchStates& states, std::span<double> points) const;
  /// X_WT (12 rows) and its Jacobian: 6 rows a column, [v; w] as in jacobian.h; columns bend_x, bend_y if
  /// the arm is spatial, stretch if the states have it, for section 0, then for section 1, ...
  void tip_jacobians(const BatchStates& states, std::span<double> frames, std::span<double> jacobians) const;
  /// The columns of those Jacobians.
  [[nodiscard]] std::size_t jacobian_columns(const BatchStates& states) const;

  /// X_WT of one state.
  [[nodiscard]] Pose tip(const ArmState& state) const;
  /// The same, and the tip's Jacobian into J, 6 x 3n as in jacobian.h.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): an Eigen::Ref is written through.
  Pose tip_jacobian(const ArmState& state, Eigen::Ref<Jacobian> J) const;

 private:
  void fill_frames(const BatchStates& states, std::span<double> frames, std::size_t rows, bool every) const;
  void require_states(const BatchStates& states) const;
  void require_state(const ArmState& state) const;

  bool is_planar_;
  std::vector<double> lengths_;
  std::array<double, 12> X_WB_;
  const SimdKernels* kernels_;
};

}  // namespace flexura
