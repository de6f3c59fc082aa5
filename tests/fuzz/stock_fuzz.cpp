// Any bytes as a saved stock: with a right check sum, or else nothing but the sum would be tested.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "stock/stock.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  bytes += aircut::sha256(bytes);
  auto stock = aircut::stock::Stock::load(bytes, "input", {.memory_limit = 4 << 20});
  if (!stock) {
    if (stock.error().kind != "stock_file" || stock.error().message.empty()) std::abort();
    return 0;
  }
  // What was read must hold together: it is written as the same stock, and can be cut.
  const auto again = aircut::stock::Stock::load(stock->save(), "again");
  if (!again || again->hash() != stock->hash()) std::abort();
  const auto cutter = *aircut::stock::CutterProfile::ball(stock->pitch() * 8, stock->pitch() * 40);
  const aircut::stock::Piece piece{
      .cutter = &cutter, .start = stock->box().min(), .end = stock->box().center()};
  const auto before = stock->z_quanta();
  const auto removed = stock->cut({&piece, 1});
  if (removed && before - stock->z_quanta() != removed->front().quanta) std::abort();
  return 0;
}
