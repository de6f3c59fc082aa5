#include "stock/kernel.h"

namespace aircut::stock {

const Kernels& kernels() {
  static const Kernels* const fast = avx2_kernels();
  return fast ? *fast : portable_kernels();
}

}  // namespace aircut::stock
