#include "flexura/math/simd_path.h"

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {
namespace {

bool is_available(SimdPath path) {
  if (path == SimdPath::baseline) return true;
#if defined(__x86_64__) || defined(__i386__)
  if (path == SimdPath::avx2) return FLEXURA_HAS_AVX2 && __builtin_cpu_supports("avx2");
  if (path == SimdPath::avx512) {
    return FLEXURA_HAS_AVX512 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw");
  }
#endif
  return false;
}

}  // namespace

std::string_view name_of(SimdPath path) {
  if (path == SimdPath::baseline) return "baseline";
  return path == SimdPath::avx2 ? "avx2" : "avx512";
}

std::vector<SimdPath> available_simd_paths() {
  std::vector<SimdPath> paths;
  for (const SimdPath path : {SimdPath::baseline, SimdPath::avx2, SimdPath::avx512}) {
    if (is_available(path)) paths.push_back(path);
  }
  return paths;
}

SimdPath best_simd_path() { return available_simd_paths().back(); }

void require_simd_path(SimdPath path) {
  if (!is_available(path)) {
    throw std::invalid_argument("this machine has no " + std::string(name_of(path)) + " path");
  }
}

}  // namespace flexura
