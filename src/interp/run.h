// One execution of a block: what a handler sees. It changes a copy of the state, collects commands
// and errors; the interpreter keeps all of it or nothing.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interp/block.h"
#include "interp/code_table.h"
#include "interp/command_queue.h"
#include "interp/compensation.h"
#include "interp/held_move.h"
#include "interp/interp.h"
#include "interp/offset_memory.h"
#include "interp/parameters.h"
#include "interp/remap.h"
#include "interp/state.h"

namespace aircut::interp {

/// What outlives a block beside the modal state.
struct Session {
  const Options& options;
  const CodeTable& table;
  Parameters& parameters;
  tool::ToolTable& tools;
  Compensator compensator;
  std::vector<canon::SplineFeed::Point> nurbs;  ///< control points since G5.2, machine coordinates
  double machine_unit_mm = 1;
  std::vector<std::uint64_t> executed;  ///< per slot of the table
  int points_missing = 0;               ///< `decimal_point` warnings told so far
  OffsetMemory offsets{};               ///< Fanuc, Haas
  AxisValues skip_position{};           ///< of the last G31, with the tool offset: work coordinates
  RemapSet remaps{};
  std::optional<HeldMove> held{};  ///< waits for the next block's move
};

/// What a block asks of the flow of control once it has succeeded.
struct FlowRequest {
  enum class Kind : unsigned char {
    none,
    end,
    call,        ///< M98
    return_,     ///< M99
    contour,     ///< the sub of a cycle's contour
    jump,        ///< go on behind `target` (contours of N blocks that a cycle has used)
    local_call,  ///< M97
    macro_call,  ///< G65
    modal_call,  ///< G66, G66.1
    block_call,  ///< the block is handed to the macro of G66.1
    modal_end,   ///< G67
    remap,       ///< the sub of a remapped code
    kinematics   ///< the machine's other kinematics: the rest of the line waits for the position
  } kind = Kind::none;
  std::int64_t label = 0;             ///< P: program, or block of M97
  std::uint64_t repeats = 1;          ///< L
  std::optional<std::int64_t> block;  ///< M99 P
  std::vector<double> locals;         ///< #1-#33 of a macro call
  bool each_block = false;            ///< G66.1
  Place place;                        ///< for messages
  BlockPlace target;
  const CodeRule* cycle = nullptr;  ///< that asks for a contour
  BlockPlace first;                 ///< contour: its first block, `target` is its last
  bool is_range = false;            ///< contour: from `first` to `target`, not a sub
  bool jump_behind = false;         ///< go on behind `target` when the contour is cut
  AxisValues contour_start;         ///< tip from which a contour begins
};

/// M70, M71, M73: done once the block has succeeded, by the flow of control, which owns the levels.
struct StackRequest {
  std::optional<ModalState> save;
  bool drop = false;
  bool restore_at_return = false;
};

/// In what a block stands.
enum class Level : unsigned char { main, sub, fanuc_sub };

/// Knows the place of the block that is being executed, with the calls that led there.
class Site {
 public:
  virtual ~Site() = default;
  virtual const SourceSpan& span() = 0;
  virtual std::uint64_t block_number() const = 0;
  virtual std::optional<BlockPlace> find_block(std::int64_t number) = 0;
  virtual std::optional<Fault> read_block(const BlockPlace& at, Block& out) = 0;
};

class ContourReader;

class BlockRun {
 public:
  BlockRun(Session& s, const Block& b, ModalState& next, Site& site, CommandQueue& out)
      : session(s), block(b), state(next), plane_before(next.plane), site_(site), out_(out) {}

  Session& session;
  const Block& block;
  ModalState& state;
  canon::Plane plane_before;  ///< at the start of the line
  FlowRequest flow;
  StackRequest stack;
  std::unique_ptr<RemapCall> remap;  ///< of FlowRequest::Kind::remap
  Level level = Level::main;
  const ModalState* saved = nullptr;       ///< by M70 on this level
  const CodeRule* motion_rule = nullptr;   ///< explicit or modal, of this line
  bool machine_coordinates = false;        ///< G53
  bool feed_given = false;                 ///< the line has an F word
  const ContourReader* contour = nullptr;  ///< second step of a cycle that has asked for it

  // ---- words
  bool has(char letter) const { return block.find(letter) != nullptr; }
  std::optional<double> number(char letter) const {
    const Word* word = block.find(letter);
    if (!word) return std::nullopt;
    return word->number;
  }
  double number_or(char letter, double otherwise) const {
    return number(letter).value_or(otherwise);
  }
  /// The integer of a word that is there; an error and nothing when it is not an integer in
  /// [least, most].
  std::optional<int> integer(char letter, int least, int most, const char* kind = "word_value");
  /// A length word in mm.
  double length(char letter, double otherwise = 0) const {
    const Word* word = block.find(letter);
    return word ? word->number * state.unit_mm() : otherwise;
  }
  bool has_axis_words() const { return axis_words_; }
  /// What stands between the parentheses of the block's comment.
  std::string text_of(const Comment& comment) const;
  /// Blocks executed so far, this one included.
  double block_count() const { return static_cast<double>(site_.block_number()); }
  /// An axis word's number in mm or rad, X halved in diameter mode; nothing without the word.
  std::optional<double> axis(Axis which) const;
  /// False when the axis' letter means something else: U V W of lathes are increments, and A and C
  /// of a lathe without these axes an angle and a corner.
  bool is_axis(Axis which) const;
  double axis_number(const Word& word, Axis which) const {
    if (is_rotary(which)) return word.number * radian_per_degree;
    const double value = word.number * state.unit_mm();
    return which == Axis::x && state.lathe_diameter ? value / 2 : value;
  }
  /// Lathes of Fanuc and Haas: U, V and W are increments of X, Y and Z.
  bool has_increments() const {
    return session.options.lathe && session.options.dialect != Dialect::linuxcnc;
  }
  /// Such an increment in mm, U halved in diameter mode; nothing without the word.
  std::optional<double> increment(Axis which) const;

  // ---- places
  Place place(char letter) const;
  Place place(const CodeRule& rule) const;
  /// True when a word of the line is that code.
  bool given(const CodeRule& rule) const;
  Place whole() const { return {0, block.length}; }

  // ---- other lines of the program (macro B)
  /// N `number` of this program: behind this block, else from the top.
  std::optional<BlockPlace> find_block(std::int64_t number) { return site_.find_block(number); }
  /// Parses a line of this program's text; places in it are relative to that line. `at.after` is
  /// filled in with where the next line begins, so that a range can be read line by line.
  std::optional<Fault> read_block(const BlockPlace& at, Block& out) {
    return site_.read_block(at, out);
  }

  // ---- results
  void error(const char* kind, Place place, std::string message);
  void error(const char* kind, char letter, std::string message) {
    error(kind, place(letter), std::move(message));
  }
  void error(const char* kind, const CodeRule& rule, std::string message) {
    error(kind, place(rule), std::move(message));
  }
  /// The error of a code without a row: what other control has it.
  void unknown_code(const Word& word);
  void warning(const char* kind, Place place, std::string message);
  void info(const char* kind, const CodeRule& rule, std::string message);
  bool ok() const { return !fault_; }
  const std::optional<Fault>& fault() const { return fault_; }
  const std::vector<Fault>& warnings() const { return warnings_; }
  const std::vector<Fault>& infos() const { return infos_; }

  /// Appends a command; while radius compensation holds a move back, it waits behind that move.
  template <class A>
  void emit(A action, std::string expanded = {}) {
    if (session.held)
      session.held->waiting.push_back(make(std::move(action), std::move(expanded)));
    else if (session.compensator.holds())
      session.compensator.hold(make(std::move(action), std::move(expanded)));
    else
      emit_now(std::move(action), std::move(expanded));
  }
  /// Appends it in front of anything that is held back.
  template <class A>
  void emit_now(A action, std::string expanded = {}) {
    canon::Command& command = out_.add();  // filled in where it stays
    if (A* same = std::get_if<A>(&command.action))
      *same = std::move(action);
    else
      command.action.template emplace<A>(std::move(action));
    command.span = span();
    command.block = block_of_command();
    if (!expanded.empty()) command.expanded = std::move(expanded);
  }
  /// Hands a move to the compensation, which holds it back.
  void emit_held(canon::Action action);
  /// Appends a command that has its place already.
  void release(canon::Command command) { out_.push_back(std::move(command)); }
  /// The same, behind a move that radius compensation holds back.
  void pass_on(canon::Command command);
  /// A command without an action that says where this block stands.
  canon::Command head() { return make({}, {}); }
  /// What is emitted from now on belongs to that block; null: to this one.
  void speak_for(const canon::Command* other) { speaks_for_ = other; }
  /// The corner in front of this block can't be made. False.
  bool fail_corner(std::string message);
  /// Whether the fault is that of the corner, and not of the block.
  bool corner_failed() const { return corner_failed_; }

  /// Asks for a kinematics of the machine. What is left of the line is done in it; with `again` by
  /// this code too, from its beginning.
  void switch_kinematics(const canon::SwitchKinematics& to, bool again = false);

  // ---- offsets and position, kept in step
  /// Emits the three commands of the work system in force.
  void emit_work_offset();
  void emit_rotation();
  void emit_g92();

  void set_parameter(int n, double value) { session.parameters.write(n, value); }
  double parameter(int n) const { return session.parameters.stored(n); }
  /// #n … as an offset: machine units and degrees to mm and rad.
  AxisValues stored_axes(int first) const;
  void store_axes(int first, const AxisValues& values);
  /// The tool with this number for changing it; the old state is kept for a roll back.
  tool::Tool* change_tool(int number);
  /// The offsets of a Fanuc-like control for changing them; kept for a roll back too.
  OffsetMemory& change_offsets();
  void roll_back_tools();

 private:
  friend class BlockExecutor;
  canon::Command make(canon::Action action, std::string expanded);
  const SourceSpan& span() { return speaks_for_ ? speaks_for_->span : site_.span(); }
  std::uint64_t block_of_command() const {
    return speaks_for_ ? speaks_for_->block : site_.block_number();
  }

  Site& site_;
  CommandQueue& out_;
  std::optional<Fault> fault_;
  std::vector<Fault> warnings_;
  std::vector<Fault> infos_;
  std::vector<tool::Tool> old_tools_;
  std::optional<OffsetMemory> old_offsets_;
  bool axis_words_ = false;
  bool corner_failed_ = false;
  std::optional<canon::SwitchKinematics> switch_to_;
  bool switch_again_ = false;
  const canon::Command* speaks_for_ = nullptr;
};

}  // namespace aircut::interp
