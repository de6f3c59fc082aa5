// Accuracy set-ups from outside: any bytes. What is accepted is evaluated, and its shares must sum
// to the error.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "accuracy/accuracy.h"

namespace {

// Whether the numbers are those of a machine. Arms of kilometres cancel, and the two ways of
// summing round differently.
bool modest(const aircut::accuracy::Setup& setup) {
  for (const auto& body : setup.bodies)
    if (!(body.base_point.norm() < 1e4) || !(body.compliance.e.norm() < 1) ||
        !(body.compliance.xi.norm() < 1e-3) || !(body.compliance.c.norm() < 1e-3))
      return false;
  for (const auto& contact : setup.contacts)
    if (!(contact.contact.point.norm() < 1e4) || !(contact.force.force(contact.t).norm() < 1e6))
      return false;
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace aircut;
  const SourceText text("setup.toml", std::string(reinterpret_cast<const char*>(data), size));
  Diagnostics out;
  auto setup = accuracy::read_setup(text, out);
  if (!setup && out.errors() == 0) __builtin_trap();
  if (setup) {
    if (setup->scatter.draws)
      setup->scatter.draws->count = std::min<std::size_t>(100, setup->scatter.draws->count);
    const accuracy::Result result = accuracy::evaluate(*setup, out);
    for (const auto& segment : result.segments)
      for (const auto& contact : segment.contacts) {
        if (!contact.delta || setup->settings.second_order || !modest(*setup)) continue;
        double sum = 0, size_of = 0;
        for (const auto& share : contact.shares) {
          sum += share.delta;
          size_of += std::abs(share.delta);
        }
        if (std::isfinite(size_of) && std::abs(sum - *contact.delta) > 1e-6 * size_of + 1e-9)
          __builtin_trap();
      }
    accuracy::to_human(*setup, result);
    accuracy::to_csv(*setup, result);
  }
  for (const Diagnostic& d : out.list()) format_human(d, {});
  return 0;
}
