#include "flexura/kinematics/simd.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "flexura/kinematics/simd_kernels.h"

namespace flexura {
namespace {

bool processor_has(SimdPath path) {
  if (path == SimdPath::baseline) return true;
#if defined(__x86_64__) || defined(__i386__)
  if (path == SimdPath::avx2) return __builtin_cpu_supports("avx2");
  if (path == SimdPath::avx512) return __builtin_cpu_supports("avx512f");
#endif
  return false;
}

// None where this build or this processor lacks the path.
const SimdKernels* find_kernels(SimdPath path) {
  if (!processor_has(path)) return nullptr;
  if (path == SimdPath::avx512) return avx512_kernels();
  return path == SimdPath::avx2 ? avx2_kernels() : baseline_kernels();
}

}  // namespace

std::string_view name_of(SimdPath path) {
  if (path == SimdPath::baseline) return "baseline";
  return path == SimdPath::avx2 ? "avx2" : "avx512";
}

std::vector<SimdPath> available_simd_paths() {
  std::vector<SimdPath> paths;
  for (const SimdPath path : {SimdPath::baseline, SimdPath::avx2, SimdPath::avx512}) {
    if (find_kernels(path) != nullptr) paths.push_back(path);
  }
  return paths;
}

SimdPath best_simd_path() { return available_simd_paths().back(); }

const SimdKernels& kernels_of(SimdPath path) {
  if (const SimdKernels* kernels = find_kernels(path)) return *kernels;
  throw std::invalid_argument("this machine has no " + std::string(name_of(path)) + " path");
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
