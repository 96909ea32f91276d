// Compiled for AVX2 where the compiler can (cmake/Simd.cmake); empty otherwise.
#ifdef __AVX2__
#include "flexura/render/all_kernels.h"

const flexura::Kernels* flexura::avx2_kernels() { return &all_kernels; }
#endif
