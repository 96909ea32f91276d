#pragma once

#include "flexura/render/sensor_kernels.h"
#include "flexura/render/span_kernels.h"

// What the sources compiled for one instruction set each (kernels_*.cc) offer to the others. They include
// nothing of the project but all_kernels.h and what that includes: an inline function of a header that others
// include too could be compiled for AVX there, and the linker could pick that copy for everybody.
namespace flexura {

enum class SimdPath;

struct Kernels {
  SpanKernels span;
  SensorKernels sensor;
};

const Kernels* baseline_kernels();
const Kernels* avx2_kernels();
const Kernels* avx512_kernels();

/// std::invalid_argument: the path is not available.
const Kernels& kernels_of(SimdPath path);

}  // namespace flexura
