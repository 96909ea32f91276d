// Compiled for AVX2 where the compiler can (cmake/Simd.cmake); elsewhere it holds nothing.
#ifdef __AVX2__

#include "flexura/render/span_set.h"

const flexura::SpanKernels* flexura::avx2_span_kernels() { return &span_kernels; }

#else

#include "flexura/render/span_kernels.h"

const flexura::SpanKernels* flexura::avx2_span_kernels() { return nullptr; }

#endif
