// The row kernels for processors with AVX2 (compiled with -mavx2, see CMakeLists.txt).
#include <cstddef>

#include "stock/kernel.h"

#if defined(__AVX2__)
#include <immintrin.h>

namespace aircut::stock {
namespace {
#include "stock/lanes.h"
//
#include "stock/kernel_rows.h"
//
#include "stock/kernel_tilted.h"
}  // namespace

const Kernels* avx2_kernels() {
  static constexpr Kernels table = {upright, level, tilted, take};
  return __builtin_cpu_supports("avx2") ? &table : nullptr;
}

}  // namespace aircut::stock
#else
namespace aircut::stock {

const Kernels* avx2_kernels() { return nullptr; }

}  // namespace aircut::stock
#endif
