#include "interp/interp.h"

namespace aircut::interp {
const std::vector<KindText>& error_kinds() {
  static const std::vector<KindText> kinds = {};
  return kinds;
}
}  // namespace aircut::interp
