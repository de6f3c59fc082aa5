// Private: where a window's nodes lie.
#pragma once

#include <vector>

#include "plan/jerk_window.h"

namespace aircut::plan {

/// Nodes about `step` s apart by an estimate of the ride.
std::vector<double> first_mesh(const JerkWindow& window, double step);
/// Nodes at even steps of a time law that is nearly the wanted one. `wanted`: duration of each
/// cell.
std::vector<double> mesh_on(const JerkWindow& window, const WindowLaw& law, double step,
                            std::vector<double>& wanted);
/// True if no cell came out much longer than it was meant to be.
bool is_fine(const std::vector<double>& time, const std::vector<double>& wanted);

}  // namespace aircut::plan
