#include "flexura/kinematics/arc_lanes.h"

namespace flexura {
namespace {

using Lanes = Two<double __attribute__((vector_size(16)))>;

}  // namespace

const SimdKernels* baseline_kernels() { return &kernels_for<Lanes>; }

}  // namespace flexura
