// Compiled for avx512 where the compiler can (CMakeLists.txt); elsewhere it holds nothing.
#ifdef __AVX512F__

#include "flexura/kinematics/arc_lanes.h"

namespace flexura {
namespace {

using Lanes = Two<double __attribute__((vector_size(64)))>;

}  // namespace

const SimdKernels* avx512_kernels() { return &kernels_for<Lanes>; }

}  // namespace flexura

#else

#include "flexura/kinematics/simd_kernels.h"

const flexura::SimdKernels* flexura::avx512_kernels() { return nullptr; }

#endif
