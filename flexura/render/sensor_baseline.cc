#include "flexura/render/sensor_lanes.h"

const flexura::SensorKernels* flexura::baseline_sensor_kernels() { return &sensor_kernels; }
