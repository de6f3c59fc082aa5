#include "interp/dialect.h"

namespace aircut::interp {
namespace {

constexpr DialectTraits linuxcnc{"LinuxCNC", false, true, false, true, false, 252, 4, 9};
constexpr DialectTraits fanuc{"Fanuc", true, false, true, true, true, 0, 3, 10};
constexpr DialectTraits haas{"Haas", true, false, true, true, true, 0, 1, 9};

}  // namespace

const DialectTraits& traits_of(Dialect dialect) {
  switch (dialect) {
    case Dialect::linuxcnc:
      return linuxcnc;
    case Dialect::fanuc:
      return fanuc;
    case Dialect::haas:
      break;
  }
  return haas;
}

std::vector<std::span<const CodeRule>> layers_of(Dialect dialect, bool lathe) {
  if (dialect == Dialect::linuxcnc) return {linuxcnc_rows()};
  std::vector<std::span<const CodeRule>> layers = {fanuc_rows(),
                                                   lathe ? fanuc_lathe_rows() : fanuc_mill_rows()};
  if (dialect == Dialect::haas) {
    layers.push_back(haas_rows());
    layers.push_back(lathe ? haas_lathe_rows() : haas_mill_rows());
  }
  return layers;
}

}  // namespace aircut::interp
