// Compiled for AVX-512 where the compiler can (cmake/Simd.cmake); elsewhere it holds nothing.
#ifdef __AVX512BW__

#include "flexura/render/sensor_lanes.h"

const flexura::SensorKernelPair* flexura::avx512_sensor_kernels() { return &sensor_kernels; }

#else

#include "flexura/render/sensor_kernels.h"

const flexura::SensorKernelPair* flexura::avx512_sensor_kernels() { return nullptr; }

#endif
