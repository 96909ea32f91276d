#pragma once

#include <cstddef>

// What the sources compiled for one instruction set each (simd_*.cc) offer to the rest of the library. They
// include nothing but this and simd_lanes.h, arc_lanes.h: an inline function of a header that others include
// too could be compiled for AVX there, and the linker could pick that copy for everybody.
namespace flexura {

enum class SimdPath;

/// States of arms, and where the results go. Quantity `row` of arm `arm` stands at row * stride + arm.
struct BatchJob {
  std::size_t sections = 0;
  const double* lengths = nullptr;  ///< Not stretched, one a section, m.
  const double* X_WB = nullptr;     ///< 12 numbers: position, then rotation column by column.
  const double* bend_x = nullptr;   ///< A row a section.
  const double* bend_y = nullptr;   ///< The same; none for planar arms.
  std::size_t bend_stride = 0;
  const double* stretch = nullptr;  ///< A row a section, or none: all 1.
  std::size_t stretch_stride = 0;
  double* frames = nullptr;     ///< `frame_rows` rows a frame.
  std::size_t frame_rows = 12;  ///< 12: a pose as in X_WB; 3: the position alone.
  bool is_every_frame = false;  ///< Each section's base and the tip, or the tip alone.
  double* jacobian = nullptr;   ///< 6 rows a column.
  std::size_t stride = 0;       ///< Of frames and jacobian.
  double* scratch = nullptr;    ///< scratch_rows a section and lane; for Jacobians.
};

/// Of BatchJob::scratch.
constexpr std::size_t scratch_rows = 18;

/// The functions for `lanes` arms (or angles) at a time: end - begin (or count) is a multiple of it.
struct LaneFunctions {
  std::size_t lanes;
  void (*frames)(const BatchJob& job, std::size_t begin, std::size_t end);
  void (*jacobians)(const BatchJob& job, std::size_t begin, std::size_t end);
  void (*sines_and_cosines)(const double* angles, double* sines, double* cosines, std::size_t count);
};

/// One instruction set's functions, for as many arms at a time as it can and for one.
struct SimdKernels {
  LaneFunctions many, one;
};

// None where the compiler did not build for the set.
const SimdKernels* baseline_kernels();
const SimdKernels* avx2_kernels();
const SimdKernels* avx512_kernels();

/// The kernels of a path; std::invalid_argument when it is not available.
const SimdKernels& kernels_of(SimdPath path);

/// std::sin and std::cos of the angles beyond 1e6 and of those that are not finite; leaves the others alone.
void replace_far_sines_and_cosines(const double* angles, double* sines, double* cosines, std::size_t count);

}  // namespace flexura
