// semantics: what a control carries out without a word and a machinist would still ask about: the
// length of another tool, a cut with the spindle stopped, an offset left on, an axis past its end.
// Listens to the canonical commands; moves nothing. Units mm, rad, s.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "canon/canon.h"
#include "machine/machine.h"
#include "tool/tool.h"

namespace aircut::semantics {

/// What the program runs on, as far as it is known.
struct Context {
  const tool::ToolTable& tools;
  const machine::Machine* machine = nullptr;  ///< null: none was named
  /// A simulation follows, which tells itself about inputs and user codes that have no model.
  bool simulated = false;
  /// H is a row of the control's offset memory (Fanuc, Haas) and not the number of a tool.
  bool offset_rows = false;
};

/// How a program has ended: what the next one inherits.
struct Ending {
  bool reached = true;                  ///< its end; not an error or a limit
  const std::map<int, double>& before;  ///< numbered parameters of the control at the start
  const std::map<int, double>& after;
  bool input_read = true;  ///< some block has looked at #5399, the result of M66
};

/// Looks at one program. Borrows what it is given.
class ProgramCheck {
 public:
  /// Messages go to `out`. `program` is what the interpreter says: a mode that a refused block
  /// would have set is unsure, and what follows from it alone is not told. May be the same list.
  ProgramCheck(const Context& context, const Diagnostics& program, Diagnostics& out);
  ~ProgramCheck();
  ProgramCheck(const ProgramCheck&) = delete;
  ProgramCheck& operator=(const ProgramCheck&) = delete;

  /// The next command of the stream.
  void see(const canon::Command& command);
  /// The stream has ended.
  void finish(const Ending& ending);

  /// What nobody here can know, in words: user codes, probing. Not empty: the verdict is not pass.
  const std::vector<std::string>& unchecked() const;

  struct State;  ///< private to the check

 private:
  std::unique_ptr<State> state_;
};

/// Joints against their limits along the programmed path, without meshes and without a plan: every
/// line and arc is bounded through the machine's kinematics and halved until it is clear or out.
/// The corners that G64 rounds and the order in which a dog-leg rapid moves its joints within the
/// box of its ends change nothing for joints that are axes; else see docs/semantic-checks.md.
class TravelCheck {
 public:
  TravelCheck(const machine::Machine& machine, const machine::JointVector& start, Diagnostics& out);
  ~TravelCheck();
  TravelCheck(const TravelCheck&) = delete;
  TravelCheck& operator=(const TravelCheck&) = delete;

  void see(const canon::Command& command);
  /// What could not be bounded, in words.
  const std::vector<std::string>& unchecked() const;
  /// Where the tip is after all that it saw: what the interpreter is told when the program has
  /// switched the kinematics.
  const AxisValues& tip() const;

  struct State;  ///< private to the check

 private:
  std::unique_ptr<State> state_;
};

/// Kinds of this library with their long text.
const std::vector<KindText>& semantic_kinds();
/// True for kinds that are told about programs which a control accepts: those above and the
/// interpreter's warnings.
bool is_semantic(const std::string& kind);

}  // namespace aircut::semantics
