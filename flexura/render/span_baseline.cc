#include "flexura/render/span_set.h"

const flexura::SpanKernels* flexura::baseline_span_kernels() { return &span_kernels; }
