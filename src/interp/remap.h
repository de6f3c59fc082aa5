// Codes that the machine's set-up gives a meaning of its own (LinuxCNC: `REMAP=`).
//
// A remapped code has a row of its own in the code table, so that modal groups and phases work as
// for any code. When the codes of a line act in the order of their phases and it is its turn, the
// line is put aside, its sub is called with the line's words as named parameters, and behind the
// sub the rest of the line goes on. Inside its own sub a built-in code has its built-in meaning.
// What is no NC sub (Python) is listed as a command and never run; a built-in code then does what
// it does without the remap, so that the program can be followed further.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interp/block.h"
#include "interp/code_table.h"

namespace aircut::interp {

class BlockRun;

struct Remapped {
  const Remap* remap = nullptr;
  CodeRule rule{};                    ///< its row, of G and M
  const CodeRule* builtin = nullptr;  ///< the row of the same code without the remap
};

class RemapSet {
 public:
  /// `remaps` must outlive the set, and the set the table.
  void fill(const std::vector<Remap>& remaps, CodeTable& table);
  bool empty() const { return all_.empty(); }

  /// The row that is in force now: the built-in one while the code's own sub runs.
  const CodeRule* in_force(const CodeRule* rule) const;
  /// The remap of a row, or of the words T, S, F, when it is in force.
  const Remapped* of(const CodeRule* rule) const;
  const Remapped* of(char letter) const;

  void enter(const Remapped& remapped) { active_.push_back(&remapped); }
  void leave() { active_.pop_back(); }
  int level() const { return static_cast<int>(active_.size()); }

 private:
  bool own_sub_runs(const Remapped& remapped) const;

  std::deque<Remapped> all_;
  std::vector<const Remapped*> active_;
};

/// One thing that a line does, in the order of the phases.
struct BlockItem {
  Phase phase;
  const CodeRule* rule;  ///< null for F, S, T
  char letter;
};
using BlockItems = std::array<BlockItem, 40>;

/// A line whose remapped code is being done by a sub.
struct SuspendedBlock {
  Block block;  ///< with its words evaluated
  BlockItems items;
  std::size_t count = 0, next = 0;
  const CodeRule* motion_rule = nullptr;
  bool feed_given = false;
  bool mode_only = false;  ///< its motion code makes no move
};

/// A call that a block asks for.
struct RemapCall {
  const Remapped* remapped = nullptr;
  Place place;
  std::vector<double> arguments;                      ///< `@`: #1 …
  std::vector<std::pair<std::string, double>> named;  ///< else
  std::unique_ptr<SuspendedBlock> rest;               ///< null: nothing is left of the line
};

/// Fills the call's arguments by the remap's argspec; false with an error when one is missing.
bool remap_arguments(BlockRun& run, RemapCall& call);
/// Lists a remap that is no NC sub.
void list_remap(BlockRun& run, const Remap& remap);

}  // namespace aircut::interp
