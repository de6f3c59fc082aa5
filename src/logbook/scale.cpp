#include "logbook/scale.h"

#include <algorithm>
#include <cmath>

namespace aircut::logbook {

double nice_step(double wanted) {
  if (!(wanted > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  for (const double f : {1.0, 2.0, 5.0})
    if (f * power >= wanted * 0.999) return f * power;
  return 10 * power;
}

std::string number(double value, double step) {
  const int decimals =
      step >= 1 ? 0 : std::min(9, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  std::string out = fixed(value, decimals);
  return out.find_first_not_of("-0.") == std::string::npos ? "0" : out;
}

}  // namespace aircut::logbook
