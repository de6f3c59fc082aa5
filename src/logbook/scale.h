// Private: scales and colours that all plots share.
#pragma once

#include <array>
#include <string>

#include "logbook/canvas.h"

namespace aircut::logbook {

// Okabe and Ito's colours, which most colour-blind people can tell apart.
inline constexpr std::array<Colour, 7> colours = {{{0.0, 0.45, 0.70},
                                                   {0.84, 0.37, 0.0},
                                                   {0.0, 0.62, 0.45},
                                                   {0.80, 0.47, 0.65},
                                                   {0.90, 0.62, 0.0},
                                                   {0.34, 0.71, 0.91},
                                                   {0.35, 0.35, 0.35}}};
inline constexpr Colour black{0.1, 0.1, 0.1}, grey{0.5, 0.5, 0.5}, pale{0.9, 0.9, 0.9};

/// A step of 1, 2 or 5 times a power of ten, about `wanted`.
double nice_step(double wanted);
/// With as many decimals as steps of that size need.
std::string number(double value, double step);

}  // namespace aircut::logbook
