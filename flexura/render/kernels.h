#pragma once

#include "flexura/render/sensor_kernels.h"
#include "flexura/render/span_kernels.h"

// Interface of the sources kernels_*.cc, each of which is compiled for one instruction set. Of this project,
// these sources include only all_kernels.h and its includes. Otherwise an inline function of a shared header
// could be compiled for AVX, and the linker could use this copy everywhere.
namespace flexura {

enum class SimdPath;

struct Kernels {
  SpanKernels span;
  SensorKernels sensor;
};

const Kernels* baseline_kernels();
const Kernels* avx2_kernels();
const Kernels* avx512_kernels();

/// Returns the kernels of an instruction set. Throws std::invalid_argument if this processor does not support
/// the instruction set.
const Kernels& kernels_of(SimdPath path);

}  // namespace flexura
