#include "stock/kernel.h"

namespace aircut::stock {

const Kernels& kernels() { return portable_kernels(); }

}  // namespace aircut::stock
