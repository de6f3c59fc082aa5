// Differences that docs/peer.md accepts, as rules: what is told and done on both sides must be just
// that, and the program without it must agree.
#pragma once

#include <optional>
#include <string>

#include "peer/reference.h"

namespace aircut::test {

struct Excuse {
  std::string rule;  ///< for the count of each
  /// The program without what differs, on which both must agree; empty: nothing else can differ.
  std::string rest;
};

/// The rule that accepts this difference, or nothing.
std::optional<Excuse> excuse_of(const std::string& program, const Trace& own,
                                const Trace& reference, const std::string& difference);

}  // namespace aircut::test
