// Compiled for AVX-512 where the compiler can (cmake/Simd.cmake); elsewhere it holds nothing.
#ifdef __AVX512BW__

#include "flexura/render/span_set.h"

const flexura::SpanKernels* flexura::avx512_span_kernels() { return &span_kernels; }

#else

#include "flexura/render/span_kernels.h"

const flexura::SpanKernels* flexura::avx512_span_kernels() { return nullptr; }

#endif
