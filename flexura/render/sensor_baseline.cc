#include "flexura/render/sensor_lanes.h"

const flexura::SensorKernelPair* flexura::baseline_sensor_kernels() { return &sensor_kernels; }
