#include "flexura/kinematics/simd.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "flexura/kinematics/simd_kernels.h"

namespace flexura {

const SimdKernels& kernels_of(SimdPath path) {
  require_simd_path(path);
  if (path == SimdPath::avx512) return *avx512_kernels();
  return path == SimdPath::avx2 ? *avx2_kernels() : *baseline_kernels();
}

void replace_far_sines_and_cosines(const double* angles, double* sines, double* cosines, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(angles[i]) <= 1e6) continue;
    sines[i] = std::sin(angles[i]);
    cosines[i] = std::cos(angles[i]);
  }
}

void sines_and_cosines(std::span<const double> angles, std::span<double> sines, std::span<double> cosines,
                       SimdPath path) {
  if (sines.size() != angles.size() || cosines.size() != angles.size()) {
    throw std::invalid_argument(std::to_string(angles.size()) + " angles do not go with " +
                                std::to_string(sines.size()) + " sines and " +
                                std::to_string(cosines.size()) + " cosines");
  }
  const SimdKernels& kernels = kernels_of(path);
  const std::size_t whole = angles.size() - angles.size() % kernels.many.lanes;
  kernels.many.sines_and_cosines(angles.data(), sines.data(), cosines.data(), whole);
  kernels.one.sines_and_cosines(angles.data() + whole, sines.data() + whole, cosines.data() + whole,
                                angles.size() - whole);
}

}  // namespace flexura
