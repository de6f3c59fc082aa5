#pragma once

#include "base/random.h"

namespace aircut::machine {
using aircut::Random;
}  // namespace aircut::machine
