#pragma once

#include "flexura/render/span_divide.h"
#include "flexura/render/span_draw.h"
#include "flexura/render/span_rim.h"
#include "flexura/render/span_rim_divide.h"

// All kernels of the instruction set that the including source is compiled for.
namespace flexura {
namespace {

constexpr SpanKernels span_kernels = {draw, screen, find_rim, disc, divide_rim, sample_rim, divide, sample};

}  // namespace
}  // namespace flexura
