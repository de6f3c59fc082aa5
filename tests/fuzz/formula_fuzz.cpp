// Structural formulas from outside: any bytes. What parses is written back to the same formula, and
// makes a package or is refused with a reason.
#include <cstddef>
#include <cstdint>
#include <string>

#include "machine/formula/new_package.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aircut::machine;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto formula = parse_formula(text);
  if (!formula) {
    if (formula.error().message.empty() || formula.error().column < 1 ||
        formula.error().column > text.size() + 1)
      __builtin_trap();
    return 0;
  }
  const auto again = parse_formula(text_of(*formula));
  if (!again || !(*again == *formula)) __builtin_trap();
  const auto files = package_of(*formula, "fuzz");
  if (!files && files.error().empty()) __builtin_trap();
  return 0;
}
