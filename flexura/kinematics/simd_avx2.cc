// Compiled for avx2 where the compiler can (CMakeLists.txt); elsewhere it holds nothing.
#ifdef __AVX2__

#include "flexura/kinematics/arc_lanes.h"

namespace flexura {
namespace {

using Lanes = Two<double __attribute__((vector_size(32)))>;

}  // namespace

const SimdKernels* avx2_kernels() { return &kernels_for<Lanes>; }

}  // namespace flexura

#else

#include "flexura/kinematics/simd_kernels.h"

const flexura::SimdKernels* flexura::avx2_kernels() { return nullptr; }

#endif
