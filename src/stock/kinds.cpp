#include "stock/stock.h"

namespace aircut::stock {

const std::vector<KindText>& stock_kinds() {
  static const std::vector<KindText> kinds = {
      {"cutter_shape", "a tool's outline can't be used to remove material",
       "The outline holds no volume, goes down, or one of its sizes is not more than 0. The "
       "message\n"
       "names the size. Remedy: mend the tool's piece in tools.toml (docs/tools.md)."},
      {"stock_shape", "the stock's size or pitch makes no sense",
       "A box needs high coordinates above its low ones, a bar a radius and a length of more than "
       "0;\n"
       "the pitch lies above 0 and is at most the smallest side of the stock."},
      {"stock_mesh", "the mesh of the stock is not a closed solid",
       "Material is removed from an inside, and only a closed mesh has one: each edge belongs to "
       "two\n"
       "triangles that run along it in opposite directions, and seen from outside the corners run\n"
       "counter-clockwise. Remedy: export the mesh again as one watertight solid, or repair it in "
       "a\n"
       "mesh program; aircut doesn't guess."},
      {"stock_file", "a saved stock can't be read",
       "The file is not one that this version writes, was changed, or is not complete; the "
       "message\n"
       "says what is wrong and at which byte. Remedy: save the stock again."},
      {"stock_memory", "the stock doesn't fit into its memory",
       "Memory grows as the square of 1/pitch with the surface of the stock. The message names "
       "the\n"
       "finest pitch that fits. Remedy: a coarser pitch, or more memory."},
      {"stock_unsupported", "this motion's removal of material is not modelled",
       "Nothing was removed for the move, so what the stock looks like afterwards is not known "
       "and\n"
       "the verdict can't be pass."},
  };
  return kinds;
}

}  // namespace aircut::stock
