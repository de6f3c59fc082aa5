// Calls of the subs of remapped codes, and the way back into the line.
#include "interp/impl.h"

namespace aircut::interp {

void Interpreter::Impl::call_remap(RemapCall& call) {
  const Remap& remap = *call.remapped->remap;
  ProgramFile* file = find_sub(remap.ngc, *block_, call.place);
  if (!file) return;
  const int at = file->flow->find_sub(remap.ngc);
  file->flow->entries[static_cast<std::size_t>(at)].passed = true;
  if (!enter_sub(*file, at, &call.arguments, remap.name + " remap")) return;
  frames_.back().remap = call.remapped;
  frames_.back().suspended = std::move(call.rest);
  session_.remaps.enter(*call.remapped);
  for (const auto& [name, value] : call.named)
    parameters_.write_named(parameters_.intern(name), value);
  parameters_.commit();
}

// The control does not start when the sub of a remap is missing.
bool Interpreter::Impl::remaps_are_sound() {
  for (const Remap& remap : options_.remaps) {
    if (remap.ngc.empty()) continue;
    span_ = remap.span;
    span_valid_ = true;
    if (!find_sub(remap.ngc, scratch_, {0, remap.span.length})) return false;
  }
  span_valid_ = false;
  return true;
}

void Interpreter::Impl::resume_line(std::unique_ptr<SuspendedBlock> rest) {
  resumed_ = std::move(rest);
  block_ = &resumed_->block;
  execute_words(*block_, resumed_.get());
}

}  // namespace aircut::interp
