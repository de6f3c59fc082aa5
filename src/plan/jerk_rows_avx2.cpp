// The loops over rows for processors with AVX2 (compiled with -mavx2, see CMakeLists.txt).
#include "plan/jerk_rows.h"

namespace aircut::plan {

#if defined(__AVX2__)
namespace {
#include "plan/jerk_row_loops.h"
}  // namespace

const RowKernels* avx2_row_kernels() {
  return __builtin_cpu_supports("avx2") ? &row_kernels : nullptr;
}
#else
const RowKernels* avx2_row_kernels() { return nullptr; }
#endif

}  // namespace aircut::plan
