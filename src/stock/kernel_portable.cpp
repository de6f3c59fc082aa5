#include <cstddef>

#include "stock/kernel.h"
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace aircut::stock {
namespace {
#include "stock/lanes.h"
//
#include "stock/kernel_rows.h"
//
#include "stock/kernel_tilted.h"
}  // namespace

const Kernels& portable_kernels() {
  static constexpr Kernels table = {upright, level, tilted, take};
  return table;
}

}  // namespace aircut::stock
