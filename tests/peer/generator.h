// Programs by chance: the same seed gives the same program on every machine.
#pragma once

#include <cstdint>
#include <string>

namespace aircut::test {

/// A program of some 10 to 40 lines. Most are right, some contain a line that must be refused.
std::string generate_program(std::uint32_t seed);

}  // namespace aircut::test
