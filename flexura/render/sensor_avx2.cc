// Compiled for AVX2 where the compiler can (cmake/Simd.cmake); elsewhere it holds nothing.
#ifdef __AVX2__

#include "flexura/render/sensor_lanes.h"

const flexura::SensorKernelPair* flexura::avx2_sensor_kernels() { return &sensor_kernels; }

#else

#include "flexura/render/sensor_kernels.h"

const flexura::SensorKernelPair* flexura::avx2_sensor_kernels() { return nullptr; }

#endif
