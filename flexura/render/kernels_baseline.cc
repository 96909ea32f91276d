#include "flexura/render/all_kernels.h"

const flexura::Kernels* flexura::baseline_kernels() { return &all_kernels; }
