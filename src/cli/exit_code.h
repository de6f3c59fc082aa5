#pragma once

#include "sim/sim.h"

namespace aircut::cli {

/// What the shell sees; docs/cli.md.
enum class ExitCode : int {
  pass = 0,
  fail = 1,
  unknown = 2,  ///< could not be verified: usage, input, limit, output, something unchecked
  internal = 3,
  interrupted = 130,
  terminated = 143,
};

constexpr int code(ExitCode c) { return static_cast<int>(c); }

constexpr ExitCode exit_code_of(sim::Verdict verdict) {
  switch (verdict) {
    case sim::Verdict::pass:
      return ExitCode::pass;
    case sim::Verdict::fail:
      return ExitCode::fail;
    case sim::Verdict::unknown:
      return ExitCode::unknown;
  }
  return ExitCode::internal;
}

}  // namespace aircut::cli
