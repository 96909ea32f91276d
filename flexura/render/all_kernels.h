#pragma once

#include "flexura/render/kernels.h"
#include "flexura/render/sensor_lanes.h"
#include "flexura/render/span_divide.h"
#include "flexura/render/span_draw.h"
#include "flexura/render/span_rim.h"
#include "flexura/render/span_rim_divide.h"

// All kernels, compiled for the instruction set of the source that includes this header.
namespace flexura {
namespace {

constexpr Kernels all_kernels = {
    {draw, screen, find_rim, disc, divide_rim, sample_rim, divide, sample},
    {condition, blur_down, deliver<float>, deliver<std::uint8_t>},
};

}  // namespace
}  // namespace flexura
