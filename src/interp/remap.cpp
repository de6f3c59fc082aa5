#include "interp/remap.h"

#include <algorithm>
#include <limits>

#include "interp/codes/codes.h"

namespace aircut::interp {
namespace {

constexpr const char* all_words = "ABCDEFHIJKLPQRSTUVWXYZ$@^";

ModalGroup group_of(int modal_group) {
  switch (modal_group) {
    case 4:
      return ModalGroup::stop;
    case 5:
      return ModalGroup::io;
    case 6:
      return ModalGroup::tool;
    case 7:
      return ModalGroup::spindle;
    case 8:
      return ModalGroup::coolant;
    case 9:
      return ModalGroup::override_;
    default:
      return ModalGroup::user;
  }
}

Phase phase_of(ModalGroup group) {
  switch (group) {
    case ModalGroup::stop:
      return Phase::stop;
    case ModalGroup::io:
      return Phase::io;
    case ModalGroup::tool:
      return Phase::tool_change;
    case ModalGroup::spindle:
      return Phase::spindle;
    case ModalGroup::coolant:
      return Phase::coolant;
    case ModalGroup::override_:
      return Phase::override_;
    default:
      return Phase::user;
  }
}

// A remapped row is looked at before its handler would be called.
void never_called(const CodeRule& rule, BlockRun& run) {
  run.error("unsupported_code", rule, name_of(rule) + " is remapped and can't be used here");
}

CodeRule row_of(const Remap& remap) {
  const auto code = static_cast<std::int16_t>(remap.code);
  if (remap.letter == 'G')
    return {'G', code, ModalGroup::motion, Phase::motion, AxisUse::motion, all_words, never_called};
  const ModalGroup group = group_of(remap.modal_group);
  return {'M', code, group, phase_of(group), AxisUse::none, all_words, never_called};
}

char small(char letter) { return static_cast<char>(letter | 0x20); }

}  // namespace

void RemapSet::fill(const std::vector<Remap>& remaps, CodeTable& table) {
  for (const Remap& remap : remaps) {
    Remapped& entry = all_.emplace_back();
    entry.remap = &remap;
    if (remap.letter != 'G' && remap.letter != 'M') continue;
    entry.rule = row_of(remap);
    const CodeRule* known =
        table.find(remap.letter, remap.letter == 'G' ? remap.code / 10.0 : remap.code);
    // The external programs M100-M199 have one row; a remap takes their place altogether.
    if (known && known->handler && known->group != ModalGroup::user) entry.builtin = known;
    table.replace(entry.rule);
  }
}

bool RemapSet::own_sub_runs(const Remapped& remapped) const {
  return std::find(active_.begin(), active_.end(), &remapped) != active_.end();
}

const CodeRule* RemapSet::in_force(const CodeRule* rule) const {
  for (const Remapped& entry : all_) {
    if (!rule || !entry.builtin || (rule != &entry.rule && rule != entry.builtin)) continue;
    return own_sub_runs(entry) ? entry.builtin : &entry.rule;
  }
  return rule;
}

const Remapped* RemapSet::of(const CodeRule* rule) const {
  for (const Remapped& entry : all_)
    if (rule == &entry.rule) return &entry;
  return nullptr;
}

const Remapped* RemapSet::of(char letter) const {
  for (const Remapped& entry : all_)
    if (entry.remap->letter == letter && entry.remap->code == 0 && !entry.rule.letter)
      return own_sub_runs(entry) ? nullptr : &entry;
  return nullptr;
}

bool remap_arguments(BlockRun& run, RemapCall& call) {
  const Remap& remap = *call.remapped->remap;
  const bool positional = remap.argspec.find('@') != std::string::npos;
  std::string missing;
  const auto pass = [&](char name, double value) {
    if (positional)
      call.arguments.push_back(value);
    else
      call.named.emplace_back(std::string(1, name), value);
  };
  bool feed = false, speed = false, line = false;
  for (const char c : remap.argspec) {
    feed = feed || c == '>';
    speed = speed || c == '^';
    line = line || c == 'n' || c == 'N';
    const bool capital = c >= 'A' && c <= 'Z';
    if (small(c) < 'a' || small(c) > 'z' || small(c) == 'n') continue;
    const char letter = static_cast<char>(small(c) - 32);
    if (const auto value = run.number(letter))
      pass(small(c), *value);
    else if (capital)
      missing += std::string(missing.empty() ? "" : " ") + c;
  }
  if (line) pass('n', static_cast<double>(run.block.line));
  const double feed_now = run.state.feed, speed_now = run.state.spindles[0].speed;
  if (feed && feed_now > 0) pass('f', feed_now);
  if (speed && speed_now > 0) pass('s', speed_now);
  if (feed && !(feed_now > 0)) missing += std::string(missing.empty() ? "" : " ") + "F above 0";
  if (speed && !(speed_now > 0)) missing += std::string(missing.empty() ? "" : " ") + "S above 0";
  if (missing.empty()) return true;
  run.error("remap_words", call.place,
            remap.name + " lacks: " + missing +
                "; its REMAP line asks for it (argspec=" + remap.argspec + ")");
  return false;
}

void list_remap(BlockRun& run, const Remap& remap) {
  canon::UserCode command;
  command.code = remap.letter == 'M' ? remap.code : -1;
  command.remap = remap.name;
  command.has_p = run.has('P');
  command.has_q = run.has('Q');
  command.p = run.number_or('P', 0);
  command.q = run.number_or('Q', 0);
  run.emit(command);
}

}  // namespace aircut::interp
