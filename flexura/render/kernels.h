#pragma once

#include "flexura/render/sensor_kernels.h"
#include "flexura/render/span_kernels.h"

// Interface of the sources that are compiled for one instruction set each (kernels_*.cc). Of the project they
// include only all_kernels.h and its includes. Otherwise an inline function of a shared header could be
// compiled for AVX there, and the linker could pick that copy for all.
namespace flexura {

enum class SimdPath;

struct Kernels {
  SpanKernels span;
  SensorKernels sensor;
};

const Kernels* baseline_kernels();
const Kernels* avx2_kernels();
const Kernels* avx512_kernels();

/// Throws std::invalid_argument if the path is not available.
const Kernels& kernels_of(SimdPath path);

}  // namespace flexura
