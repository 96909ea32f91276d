// Compiled for AVX-512 where the compiler can (cmake/Simd.cmake); empty otherwise.
#ifdef __AVX512BW__
#include "flexura/render/all_kernels.h"

const flexura::Kernels* flexura::avx512_kernels() { return &all_kernels; }
#endif
