#include "flexura/render/kernels.h"

#include "flexura/math/simd_path.h"

namespace flexura {

const Kernels& kernels_of(SimdPath path) {
  require_simd_path(path);
#if FLEXURA_HAS_AVX512
  if (path == SimdPath::avx512) return *avx512_kernels();
#endif
#if FLEXURA_HAS_AVX2
  if (path == SimdPath::avx2) return *avx2_kernels();
#endif
  return *baseline_kernels();
}

}  // namespace flexura
