// The interpreter's inside: fetches lines, executes blocks, follows the O-words.
#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "interp/contour_reader.h"
#include "interp/flow.h"
#include "interp/interp.h"
#include "interp/parser.h"
#include "interp/run.h"
#include "interp/system_variables.h"

namespace aircut::interp {

/// One program text with what was found out about it.
struct ProgramFile {
  explicit ProgramFile(const SourceText& source) : text(&source), reading(source) {}

  const SourceText* text;
  Reading reading;
  std::uint64_t begin = 0;  ///< behind a byte order mark
  bool percent = false;     ///< starts and ends with `%`
  std::int64_t whole_program =
      -1;  ///< macro B: number of the call whose file it is, without header
  std::unique_ptr<FlowIndex> flow;
  std::unordered_map<std::uint64_t, std::unique_ptr<Block>> blocks;  ///< parsed lines of loops
};

struct Loop {
  int entry = -1;  ///< while, do or repeat
  std::uint64_t pass = 1;
  std::uint64_t passes = 0;               ///< repeat: how many
  std::shared_ptr<CallFrame> frame = {};  ///< of a pass, made when somebody asks
  std::string title = {};                 ///< `o100 while`, with the first frame
  Place place = {};                       ///< of its O-word, with the title
};

/// A cycle that waits for its contour (contour_reading.cpp).
struct ContourReading {
  Block cycle;  ///< its block, with the values of the words
  SourceSpan span;
  const CodeRule* rule = nullptr;
  ModalState before;
  ContourReader reader;
  std::optional<BlockPlace> last;  ///< block with which a range of blocks ends
  bool jump_behind = false;        ///< go on behind it
  bool failed = false;
};

/// A GOTO that went back, to tell an endless one.
struct BackwardJump {
  BlockPlace from;  ///< the block with the GOTO
  Place place;      ///< of its statement
  std::uint64_t to = 0;
  std::uint64_t count = 0;
};

/// The main program, or one call.
struct Frame {
  ProgramFile* file = nullptr;
  BlockPlace start;           ///< what a repeated call begins with; `after` and the line before it
  std::uint64_t at = 0;       ///< byte offset of the next line
  std::uint64_t line = 0;     ///< number of the line before it
  Block* last = nullptr;      ///< cached block that was executed last
  Block* upcoming = nullptr;  ///< the next line after a jump, when its block is known
  int sub = -1;               ///< entry of the sub
  bool fanuc = false;         ///< M98
  std::uint64_t repeats = 1;  ///< M98 L: passes still to do with this one
  std::vector<Loop> loops;
  std::shared_ptr<const CallFrame> calls;
  std::optional<ModalState> saved;            ///< M70, M73
  bool restore_at_return = false;             ///< M73
  std::unique_ptr<ContourReading> reading;    ///< its moves are a contour
  const Remapped* remap = nullptr;            ///< the sub stands for this code
  std::unique_ptr<SuspendedBlock> suspended;  ///< the rest of the line with that code

  // macro B
  bool header_seen = false;          ///< the O word of the program that the lines belong to
  bool jumped = false;               ///< some GOTO went back: lines are worth keeping
  std::size_t modal_call = 0;        ///< called by the n-th G66 in force; 0: not by one
  std::int64_t program = 0;          ///< number of the O word
  std::uint64_t call_site = 0;       ///< the calling block
  std::vector<double> locals;        ///< #1-#33 at the begin of a macro call; empty for M98
  std::optional<BackwardJump> back;  ///< the last one
};

/// A macro that is called behind every move (G66), or for every block (G66.1).
struct ModalMacro {
  std::int64_t label = 0;
  std::uint64_t repeats = 1;
  std::vector<double> locals;
  bool each_block = false;
};

class Interpreter::Impl final : public Site, private LiveValues {
 public:
  Impl(const SourceText& program, const tool::ToolTable& tools, const ParameterFile& file,
       Options options, SourceReader reader, Diagnostics& diagnostics);

  canon::Command* next();
  void resume(const ProbeHit& hit);
  void synchronise(const AxisValues& tip);
  ParameterFile parameters() const;
  Statistics statistics() const;
  std::vector<CodeCount> code_counts() const;

  const SourceSpan& span() override;
  std::optional<BlockPlace> find_block(std::int64_t number) override;
  std::optional<Fault> read_block(const BlockPlace& at, Block& out) override;
  std::uint64_t block_number() const override { return statistics_.blocks; }

 private:
  // ---- LiveValues (live.cpp)
  std::optional<double> numbered(int n, Place place, std::optional<Fault>& fault) const override;
  double predefined(int index) const override;
  std::optional<double> system_variable(int n, Place place,
                                        std::optional<Fault>& fault) const override;
  double increments_per_unit() const override;

  // ---- start (start.cpp)
  void start(const ParameterFile& file);
  void load_parameters(const ParameterFile& file);
  void load_offsets(const ParameterFile& file);
  void store_offsets(ParameterFile& file) const;
  void apply_settings();
  bool text_is_readable();
  bool find_first_line(ProgramFile& file) const;
  void emit_start_state();

  // ---- lines (interpreter.cpp)
  void step();
  Block* fetch();
  Block* parse_cached(Frame& frame);
  void parse_into(Frame& frame, Block& block);
  void end_of_file();
  bool is_percent_line(const ProgramFile& file, std::string_view line) const;
  void execute(Block& block);
  void execute_words(Block& block, const SuspendedBlock* rest = nullptr);
  void finish_words(Block& block, BlockRun& run, std::size_t first);
  const CodeRule* plain_motion(const Block& block) const;
  bool plain_move(Block& block);
  bool plain_settings(const Block& block);
  bool count_block();
  void stop() { done_ = true; }

  // ---- O-words (flow_control.cpp)
  void execute_oword(Block& block);
  FlowIndex& flow_of(ProgramFile& file);
  void branch_if(Block& block, int at);
  void take_branch(int from);
  void pass_branches(Block& block, int at);
  void enter_while(Block& block, int at);
  void enter_repeat(Block& block, int at);
  void end_loop(Block& block, int at);
  void leave_or_continue(Block& block, int at);
  void do_while(Block& block, int at);
  bool condition(Block& block, double& value);
  bool is_true(Block& block);
  bool next_pass(Loop& loop);
  Loop* loop_at(int at);
  bool entry_is_sound(int at);
  void report_at(int at);
  void report_problem(int at, Place place);
  void loop_limit(const Frame& frame, const std::string& which);
  std::string tested_values(const ProgramFile& file, std::uint64_t begin,
                            Keyword only = Keyword::none);
  Block* kept_block(int at);
  void jump_to(int at);
  void jump_behind(int at);
  void call(Block& block);
  std::optional<std::string> label_of(const Block& block);
  std::optional<std::vector<double>> arguments_of(const Block& block);

  // ---- macro B (macro_flow.cpp, macro_calls.cpp)
  void execute_macro(Block& block);
  void enter_program(Block& block);
  void enter_do(Block& block, int at);
  void end_do(int at);
  void write_out(const Block& block);
  std::optional<std::int64_t> block_number_of(const Block& block, std::size_t argument);
  bool jump_to_block(std::int64_t number, Place place);
  void leave_loops_for(const NumberedBlock& target);
  bool may_jump_into(const NumberedBlock& target, Place place);
  void goto_limit(const Frame& frame, const std::string& which);
  void call_macro_b(const FlowRequest& request);
  void call_local(const FlowRequest& request);
  void return_macro_b(const FlowRequest& request);
  bool push_program(const FlowRequest& request, std::string what);
  ProgramFile* find_program(std::int64_t number, Place place, int& entry);
  ProgramFile* open_program_file(std::int64_t number, Place place, int& entry);
  void modal_macro_call(const BlockRun& run);
  void change_modal_macros(const FlowRequest& request);
  void call_modal_macro(FlowRequest request, std::size_t level);
  bool is_handed_over(const Block& block) const;
  void hand_over(Block& block);
  std::size_t modal_level() const;
  Block& without_vacant(Block& block);
  void remember_words(const Block& block);

  void call_fanuc(const FlowRequest& request);
  bool enter_sub(ProgramFile& file, int at, const std::vector<double>* arguments, std::string what);
  void pass_sub(Block& block, int at);
  bool is_first_definition(const Block& block, int at);
  void pass_value(int end);
  void leave_sub(Block& block);
  void return_fanuc();
  void return_from_call();
  void call_remap(RemapCall& call);
  void resume_line(std::unique_ptr<SuspendedBlock> rest);
  bool remaps_are_sound();
  void start_kinematics();
  void tell_kinematics();
  void run_startup_line();
  ProgramFile* find_known_sub(const std::string& name);
  ProgramFile* find_sub(const std::string& name, const Block& block, Place place);
  ProgramFile* find_fanuc_sub(const std::string& label, Place place, int& at);
  ProgramFile* open_sub_file(const std::string& name, Place place, bool fanuc, bool& found);
  std::vector<std::string> sub_folders() const;
  bool push_frame(Frame frame, std::string what, const std::vector<double>* arguments = nullptr);
  bool count_file(ProgramFile& file, Place place);
  BlockPlace first_line(const ProgramFile& file) const;
  ProgramFile& file_for(const SourceText& text);
  FlowIndex& flow() { return *frames_.back().file->flow; }
  FlowEntry& entry(int at) { return flow().entries[static_cast<std::size_t>(at)]; }
  void find_calls(std::shared_ptr<const CallFrame>& calls);

  // ---- contours of turning cycles (contour_reading.cpp)
  void start_contour(const FlowRequest& request, const CodeRule& rule);
  void start_contour_range(const FlowRequest& request, std::unique_ptr<ContourReading> reading);
  bool leave_contour_range();
  void read_contour_block(Block& block);
  void finish_contour(std::unique_ptr<ContourReading> reading);

  // ---- messages (interpreter.cpp)
  SourceSpan span_of(Place place);
  void report(const Fault& fault);
  void report(const char* kind, Place place, std::string message);
  void warn(const Fault& fault);
  void inform(const Fault& fault);
  const char* dialect_advice(const SourceSpan& at) const;
  bool is_cascade(const Fault& fault) const;
  void run_block(BlockRun& run, Block& block, const SuspendedBlock* rest = nullptr);
  void remember_failure(const Block& block);
  void give_up_corner(const Block& block, const std::string& message);
  void release_corner(const Block& block);

  /// What failed blocks would have set: errors that only follow from that are not told.
  struct Unsure {
    std::optional<AxisValues> tip;  ///< where the tip would be if they had been executed
    bool feed = false, spindle = false, motion = false;
    std::set<std::string> names;
  };
  bool follows_from_position(const Fault& fault, Block& block);
  void clear_unsure(const Block& block, const AxisValues& before);

  Options options_;
  SourceReader reader_;
  Diagnostics& diagnostics_;
  CodeTable table_;
  Parameters parameters_;
  tool::ToolTable tools_;
  ModalState state_;
  ModalState next_;
  Session session_;
  CommandQueue queue_;
  std::size_t head_ = 0;
  std::vector<Frame> frames_;
  std::map<const SourceText*, std::unique_ptr<ProgramFile>> files_;
  std::vector<ProgramFile*> opened_order_;  ///< files of subs
  Block scratch_;
  std::unique_ptr<Block> refused_;                    ///< of a loop's line that could not be read
  int contour_frame_ = -1;                            ///< the call whose moves are a contour
  std::unique_ptr<ContourReading> finished_reading_;  ///< messages still refer to it
  Block* block_ = nullptr;                            ///< in execution
  std::unique_ptr<SuspendedBlock> resumed_;  ///< the line that goes on behind a remapped code
  std::unique_ptr<SuspendedBlock> waiting_;  ///< a line that waits for synchronise()
  SourceSpan span_;
  bool span_valid_ = false;
  bool done_ = false;
  double value_ = 0;  ///< #<_value>
  bool value_returned_ = false;
  bool percent_seen_ = false;
  bool continue_pending_ = false;  ///< a do loop was continued: the next repeat runs twice
  bool break_pending_ = false;     ///< a while loop was left by break: the next do loop runs once
  std::uint64_t idle_blocks_ = 0;
  std::size_t kept_bytes_ = 0;            ///< of lines that are kept parsed
  std::vector<ModalMacro> modal_macros_;  ///< in force, the last G66 last
  Block reduced_;                         ///< a block without its vacant words
  Block handed_;                          ///< a block under G66.1: its modal codes, its arguments
  std::array<double, 26> last_words_{};   ///< numbers by letter, for #4107…
  std::int64_t last_number_ = 0;          ///< of the last N word
  Unsure unsure_;
  bool failed_ = false;            ///< some block has failed
  std::vector<int> kept_numbers_;  ///< that the parameter file had
  std::set<std::tuple<const SourceText*, std::uint64_t, std::string>> reported_;
  Statistics statistics_;
  std::uint32_t other_axes_ =
      0;  ///< letters of axes with rules of their own, or that are not there
};

/// The label as a program writes it: `100` → o100, `pocket` → o<pocket>.
std::string written_label(const std::string& label);
/// Expands #123, #<name>, %d %f %.Nf in the text of a (DEBUG, …) (comments.cpp).
std::string expand_message(std::string_view text, Parameters& parameters);
/// Does what the comment of a line asks for.
void comment_action(std::string_view text, Place place, BlockRun& run);

/// Evaluates, checks and executes the words of a block (execute.cpp).
class BlockExecutor {
 public:
  explicit BlockExecutor(BlockRun& run, Block& block) : run_(run), block_(block) {}
  void execute(std::string_view line);
  /// Only evaluates the words and makes the settings.
  bool values() { return evaluate() && settings(); }
  /// Goes on with a line whose remapped code was done by a sub.
  void resume(const SuspendedBlock& rest);
  /// Only moves, by the code of that row (Interpreter::Impl::plain_move).
  bool move(const CodeRule& rule);

 private:
  bool value_of(const Value& value, double& number);
  bool evaluate();
  bool evaluate_macro_b();
  bool settings();
  bool macro_settings();
  const CodeRule* code_of_flow() const;
  bool stands_alone(const CodeRule& rule, std::string_view line);
  bool collect();
  bool find_motion();
  bool check_words();
  bool check_axes();
  bool is_corner_word(Axis axis) const;
  bool ends_data() const;
  void perform_from(std::size_t first);
  void perform(const BlockItem& item);
  std::unique_ptr<SuspendedBlock> rest_behind(std::size_t at) const;
  void put_line_aside(std::size_t first, std::size_t at);
  void call_remap(std::size_t at);
  void leave_cycle(const CodeRule& rule);
  void after_motion(const CodeRule& rule);
  void add(Phase phase, const CodeRule* rule, char letter);
  void drop_g80();
  void replace_code(const CodeRule& rule, Place place);

  BlockRun& run_;
  Block& block_;
  BlockItems items_;
  std::size_t count_ = 0;
  std::uint32_t letters_ = 0;  ///< bit per letter_index
  const CodeRule* own_ = nullptr;
  const CodeRule* shared_ = nullptr;
  bool mode_only_ = false;  ///< the motion code of the line makes no move
  bool polar_ = false;
};

}  // namespace aircut::interp
