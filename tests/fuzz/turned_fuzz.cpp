// Any bytes as a saved turned stock: with a right check sum, or else nothing but the sum would be
// tested.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "stock/stock.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  bytes += aircut::sha256(bytes);
  auto stock = aircut::stock::TurnedStock::load(bytes, "input", {.memory_limit = 1 << 20});
  if (!stock) {
    if (stock.error().kind != "stock_file" || stock.error().message.empty()) std::abort();
    return 0;
  }
  // What was read must hold together: it is written as the same bytes, and can be cut and drawn.
  if (stock->save() != bytes) std::abort();
  const aircut::stock::TurningSection nose{{{0, 0, stock->pitch() * 2}}};
  const aircut::stock::TurningMove move{&nose, stock->radius(), stock->length(), 0, 0};
  const double before = stock->volume(), taken = stock->cut(move);
  if (!(taken >= 0) || stock->volume() > before) std::abort();
  stock->mesh(stock->radius() / 20);
  return 0;
}
