#include "plan/jerk_rows.h"

namespace aircut::plan {
namespace {
#include "plan/jerk_row_loops.h"
}  // namespace

const RowKernels& portable_row_kernels() { return row_kernels; }

}  // namespace aircut::plan
