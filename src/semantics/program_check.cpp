// What the stream of commands says about a program that the control accepts.
//
// The check keeps what is in force (tool, length offset, spindle, feed mode) with the place where
// it was said, and judges when the machine would act on it: at a motion, at a cut, at the end. A
// mode that is set and replaced before anything moves harms nobody, so nothing is told about it.
//
// Without stock nobody knows whether a feed move cuts, so "cut" means: the tool moves at the feed.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>

#include "base/text.h"
#include "semantics/semantics.h"
#include "semantics/words.h"

namespace aircut::semantics {

namespace {

using canon::Action;
using canon::Command;
using canon::SpindleTurn;

constexpr std::size_t most_messages = 10'000;
constexpr double same_length = 1e-6;  // mm, rad: offsets that differ by less are the same
constexpr int spindles = 8;

std::string tool_name(int number) { return "T" + std::to_string(number); }

std::string on_line(const SourceSpan& span) {
  return span ? " in line " + std::to_string(span.line) : std::string();
}

bool same(const AxisValues& a, const AxisValues& b) {
  for (const Axis axis : all_axes)
    if (std::abs(a[axis] - b[axis]) > same_length) return false;
  return true;
}

// `X 5  Z -2.5`, the axes that are not zero.
std::string axes_text(const AxisValues& values) {
  std::string out;
  for (const Axis axis : all_axes) {
    if (std::abs(values[axis]) <= same_length) continue;
    const double value = is_rotary(axis) ? values[axis] * 180 / std::numbers::pi : values[axis];
    out += (out.empty() ? "" : "  ") + std::string(1, letter(axis)) + " " +
           shortest(std::round(value * 1e4) / 1e4);
  }
  return out;
}

bool is_feed(const Action& action) {
  return std::holds_alternative<canon::LinearFeed>(action) ||
         std::holds_alternative<canon::ArcFeed>(action) ||
         std::holds_alternative<canon::SplineFeed>(action) ||
         std::holds_alternative<canon::SyncFeed>(action);
}

// The moves of which nothing else is to be said are most of a program.
bool says_more(const Action& action) { return action.index() > Action(canon::ArcFeed{}).index(); }

// Does a line have one of these words? Expressions for codes are rare enough to count as no.
bool has_code(const SourceSpan& line, char letter, std::initializer_list<double> numbers) {
  return std::any_of(numbers.begin(), numbers.end(),
                     [&](double number) { return find_word(line, letter, number).has_value(); });
}

}  // namespace

struct ProgramCheck::State {
  State(const Context& c, const Diagnostics& p, Diagnostics& o) : context(c), program(p), out(o) {}

  Context context;
  const Diagnostics& program;
  Diagnostics& out;
  std::vector<std::string> unchecked;
  std::set<std::tuple<const SourceText*, std::uint64_t, std::string>> told;
  std::size_t read = 0;  ///< of the interpreter's messages
  /// That M66 L0 has read.
  std::vector<std::pair<SourceSpan, std::string>> inputs;
  void tell_input(const SourceSpan& span, const std::string& input);

  /// Set by a block that was refused: nobody knows.
  struct Unsure {
    bool tool = false, length = false, spindle = false, speed = false;
  } unsure;

  // ---- tool and its length
  bool tool_known = false;  ///< M6 or M61 was seen
  int tool = 0;
  SourceSpan tool_at;
  AxisValues length;
  int length_tool = 0;  ///< whose length it is; 0: not a tool's
  SourceSpan length_at;
  bool length_fresh = false;    ///< given, and nothing has moved since
  bool length_checked = false;  ///< at the first cut with this tool and offset

  // ---- spindle
  std::array<SpindleTurn, spindles> turn{};
  SourceSpan turn_at;     ///< M3 or M4
  double speed_word = 0;  ///< S of the first spindle
  double css_limit = 0;   ///< G96: the highest speed, rev/min; 0: G97
  SourceSpan speed_at;    ///< the block that set what counts of the two
  bool speed_checked = false;
  bool stop_told = false, speed_told = false;
  std::optional<Diagnostic> held;      ///< a cut with the spindle stopped, unless the tool probes
  std::uint64_t stopped_in_block = 0;  ///< the block that stopped a turning spindle
  canon::FeedMode feed_mode = canon::FeedMode::per_minute;

  // ---- frames
  AxisValues g92, g92_at_start;
  SourceSpan g92_at, rotation_at, last;
  double rotation = 0;

  bool turns() const {
    for (const SpindleTurn t : turn)
      if (t != SpindleTurn::stop) return true;
    return false;
  }
  bool css() const { return css_limit > 0; }
  /// rev/min at most; 0 when nothing says so.
  double speed() const { return !css() ? speed_word : css_limit < 1e9 ? css_limit : 0; }
  const tool::Tool* loaded() const { return tool > 0 ? context.tools.find(tool) : nullptr; }

  void tell(Diagnostic d) {
    if (told.size() >= most_messages) return;
    d.span = trimmed(d.span);
    if (!told.emplace(d.span.text, d.span.begin, d.kind).second) return;
    const bool one_list = &out == &program;
    out.add(std::move(d));
    if (one_list) read = program.list().size();
  }
  void tell(Severity severity, const char* kind, const SourceSpan& at, std::string message,
            std::string help) {
    tell({severity, kind, std::move(message), at, {{"help", std::move(help)}}, {}});
  }
  void tell_unknown(const char* kind, const SourceSpan& at, const std::string& message,
                    std::string help) {
    const std::size_t before = told.size();
    tell(Severity::warning, kind, at, message, std::move(help));
    if (told.size() > before) unchecked.push_back(trimmed(at).place() + ": " + message);
  }
  void tell_held() {
    if (held) tell(std::move(*held));
    held.reset();
  }

  void read_refusals();
  void before_motion();
  void before_cut(const Command& c);
  void check_fresh_length();
  void check_offset_row();
  void check_length(const Command& c);
  void check_spindle(const Command& c);
  void check_speed();
  void change_tool(int number, const SourceSpan& at);
  void turn_spindle(const canon::TurnSpindle& t, const Command& c);
  void tell_what_stays(const std::map<int, double>& before, const std::map<int, double>& after);

  // ---- commands that matter here; the others say nothing about a program's sense
  void on(const canon::ToolLengthOffset& c, const Command& command);
  void on(const canon::TurnSpindle& c, const Command& command) { turn_spindle(c, command); }
  void on(const canon::OrientSpindle& c, const Command&) { stop(c.spindle); }
  void on(const canon::SetSpindleSpeed& c, const Command& command);
  void on(const canon::SetSpindleMode& c, const Command& command);
  void on(const canon::SelectTool&, const Command&) {}
  void on(const canon::ChangeTool& c, const Command& command);
  void on(const canon::SetToolNumber& c, const Command& command) {
    change_tool(c.number, command.span);
  }
  void on(const canon::SetFeedMode& c, const Command&) { feed_mode = c.mode; }
  void on(const canon::G92Offset& c, const Command& command);
  void on(const canon::WorkRotation& c, const Command& command);
  void on(const canon::Dwell&, const Command&) { check_speed(); }
  void on(const canon::Probe& c, const Command& command);
  void on(const canon::WaitInput& c, const Command& command);
  void on(const canon::UserCode& c, const Command& command);
  template <class Other>
  void on(const Other&, const Command&) {}

  void stop(int spindle) { turn[static_cast<std::size_t>(spindle)] = SpindleTurn::stop; }
};

ProgramCheck::ProgramCheck(const Context& context, const Diagnostics& program, Diagnostics& out)
    : state_(std::make_unique<State>(context, program, out)) {}
ProgramCheck::~ProgramCheck() = default;

void ProgramCheck::see(const Command& command) {
  State& s = *state_;
  s.read_refusals();
  if (command.span) {
    s.last.text = command.span.text;
    s.last.begin = command.span.begin;
    s.last.length = command.span.length;
    s.last.line = command.span.line;
  }
  if (canon::is_motion(command.action)) s.before_motion();
  if (is_feed(command.action)) s.before_cut(command);
  if (says_more(command.action))
    std::visit([&](const auto& action) { s.on(action, command); }, command.action);
}

void ProgramCheck::finish(const Ending& ending) {
  if (ending.input_read)
    for (const auto& [span, input] : state_->inputs) state_->tell_input(span, input);
  state_->read_refusals();
  state_->tell_held();
  if (ending.reached) state_->tell_what_stays(ending.before, ending.after);
}

const std::vector<std::string>& ProgramCheck::unchecked() const { return state_->unchecked; }

// A refused block has set nothing, but it was meant to: what it names is unsure until it is set
// again. After a refused call everything is.
void ProgramCheck::State::read_refusals() {
  for (; read < program.list().size(); ++read) {
    const Diagnostic& d = program.list()[read];
    if (d.severity != Severity::error || !d.span) continue;
    const SourceSpan line = line_of(d.span);
    const std::string_view text = line.covered();
    const std::size_t first = text.find_first_not_of(" \t/");
    const bool flow = (first != std::string_view::npos && (text[first] | 32) == 'o') ||
                      has_code(line, 'M', {97, 98}) || has_code(line, 'G', {65, 66});
    unsure.tool |= flow || find_word(line, 'T') || has_code(line, 'M', {6, 61});
    unsure.spindle |= flow || has_code(line, 'M', {3, 4, 5, 6, 19});
    unsure.speed |= flow || find_word(line, 'S');
    unsure.length |=
        flow || find_word(line, 'H') || has_code(line, 'G', {43, 43.1, 43.2, 43.4, 43.5, 49});
  }
}

void ProgramCheck::State::before_motion() {
  if (length_fresh) check_fresh_length();
  check_speed();
}

void ProgramCheck::State::before_cut(const Command& c) {
  if (!length_checked) check_length(c);
  check_spindle(c);
}

// G43 H names another tool than the one that is in the spindle when the machine next moves.
void ProgramCheck::State::check_fresh_length() {
  length_fresh = false;
  if (!tool_known || unsure.tool || length_tool == 0 || length_tool == tool) return;
  if (context.offset_rows && tool != 0) return check_offset_row();
  SourceSpan at = word_in(length_at, 'H');
  const std::string whose = "G43 takes the length of " + tool_name(length_tool);
  length_checked = true;
  if (tool == 0)
    return tell(Severity::error, "wrong_offset", at, whose + ", but the spindle is empty",
                "change the tool in with M6 before, or leave G43 out");
  const tool::Tool* now = loaded();
  const std::string help =
      "give H" + std::to_string(tool) + ", or change " + tool_name(length_tool) + " in before";
  if (now && same(now->offset, length))
    return tell(Severity::warning, "wrong_offset", at,
                whose + ", but " + tool_name(tool) +
                    " is in the spindle; the two are equal today, so nothing is lost yet",
                help);
  std::string message = whose + ", but " + tool_name(tool) + " is in the spindle";
  if (now) {
    const double higher = length[Axis::z] - now->offset[Axis::z];
    if (std::abs(higher) > same_length)
      message += ": its tip runs " + fixed(std::abs(higher), 3) + " mm " +
                 (higher > 0 ? "higher" : "lower") + " than programmed";
  }
  tell(Severity::error, "wrong_offset", at, std::move(message), help);
}

// Any row may be meant, also one that the program has filled itself. But a row that is named after
// another tool of the table, with another length than that of the tool in the spindle, is worth a
// question.
void ProgramCheck::State::check_offset_row() {
  length_checked = true;
  const tool::Tool* now = loaded();
  if (!now || !context.tools.find(length_tool) || same(now->offset, length)) return;
  const double higher = length[Axis::z] - now->offset[Axis::z];
  tell(Severity::warning, "wrong_offset", word_in(length_at, 'H'),
       "the offset H" + std::to_string(length_tool) + " has another length than " +
           tool_name(tool) +
           ", which is in the spindle, and there is a tool of that number: the "
           "tip would run " +
           fixed(std::abs(higher), 3) + " mm " + (higher > 0 ? "higher" : "lower") +
           " than with H" + std::to_string(tool),
       "give H" + std::to_string(tool) + " if that is meant");
}

// The first cut of a tool: is a length in force, and is it the tool's own?
void ProgramCheck::State::check_length(const Command& c) {
  length_checked = true;
  if (!tool_known || tool == 0 || unsure.tool || unsure.length) return;
  const tool::Tool* now = loaded();
  if (!now) return;  // the table is asked for it by the interpreter or the simulation
  const bool active = length_tool != 0 || !same(length, AxisValues{});
  const std::string give =
      "give G43 H" + std::to_string(tool) + " after the tool change" + on_line(tool_at);
  if (!active) {
    if (same(now->offset, AxisValues{})) return;
    return tell(Severity::error, "length_offset_missing", c.span,
                "the first move at the feed with " + tool_name(tool) +
                    " has no tool length in force, and the tool table gives it " +
                    axes_text(now->offset) + " mm",
                give + ", before the tool comes near the work");
  }
  if (length_tool == 0 || length_tool == tool || same(now->offset, length)) return;
  tell(Severity::error, "wrong_offset", c.span,
       tool_name(tool) + " moves at the feed with the length of " +
           (context.offset_rows ? "H" + std::to_string(length_tool) : tool_name(length_tool)) +
           ", which is in force since" + (length_at ? on_line(length_at).substr(3) : " the start"),
       give);
}

void ProgramCheck::State::check_spindle(const Command& c) {
  if (!turns()) {
    if (stop_told || unsure.spindle) return;
    stop_told = true;
    if (feed_mode == canon::FeedMode::per_revolution)
      return tell(Severity::error, "feed_missing", c.span,
                  "feed per revolution (G95) with the spindle stopped: the axes would wait for a "
                  "revolution for ever",
                  "give M3 or M4 with S before, or G94");
    held = Diagnostic{Severity::warning,
                      "spindle_stopped_cut",
                      "this move at the feed is made with the spindle stopped; if it cuts, the "
                      "tool breaks",
                      c.span,
                      {{"help", "give M3 S… before, or G0 if the tool is clear of the work"}},
                      {}};
    return;
  }
  if (speed() > 0 || css() || speed_told || unsure.speed) return;
  speed_told = true;
  SourceSpan at = turn_at ? turn_at : c.span;
  tell(Severity::warning, "speed_missing", at,
       "the spindle is switched on, but no S gives it a speed before the first move at the feed" +
           on_line(c.span),
       "give S, the speed in rev/min, on this line or before");
}

// Looked at when time passes, not at the word: `S8000 T2 M6 M3` is meant for the new tool.
void ProgramCheck::State::check_speed() {
  if (speed_checked || turn[0] == SpindleTurn::stop || speed() <= 0) return;
  speed_checked = true;
  const double rpm = speed();
  const SourceSpan at = word_in(speed_at, css() ? 'D' : 'S');
  const std::string is =
      (css() ? "G96 lets the spindle reach " : "S asks for ") + shortest(rpm) + " rev/min, ";
  const tool::Tool* now = unsure.tool ? nullptr : loaded();
  if (now && now->max_rpm > 0 && rpm > now->max_rpm * (1 + 1e-9))
    return tell(
        Severity::error, "spindle_speed_limit", at,
        is + "but " + tool_name(tool) + " may turn at " + shortest(now->max_rpm) + " at most",
        "lower S, or correct max_rpm in the tool file");
  if (!context.machine) return;
  const machine::Spindle& spindle = context.machine->spindle();
  if (spindle.max_rpm > 0 && rpm > spindle.max_rpm * (1 + 1e-9))
    return tell(Severity::warning, "spindle_speed_limit", at,
                is + "but the machine's spindle ends at " + shortest(spindle.max_rpm) +
                    ": the control slows it down or refuses",
                "lower S, and the feed with it if the chip load counts");
  if (!css() && rpm < spindle.min_rpm * (1 - 1e-9))
    tell(Severity::warning, "spindle_speed_limit", at,
         is + "but the machine's spindle begins at " + shortest(spindle.min_rpm) +
             ": it may stand still or turn faster",
         "raise S");
}

void ProgramCheck::State::change_tool(int number, const SourceSpan& at) {
  tell_held();
  tool_known = true;
  unsure.tool = false;
  tool = number;
  tool_at = at;
  length_checked = speed_checked = stop_told = false;
}

void ProgramCheck::State::on(const canon::ChangeTool& c, const Command& command) {
  if (stopped_in_block == command.block && command.block != 0)
    tell(Severity::info, "tool_change_spindle_on", word_in(command.span, 'M', 6),
         "M6 changes the tool while the spindle still turns; this control stops it by itself, "
         "others refuse the change",
         "give M5 on a line before");
  change_tool(c.number, command.span);
}

void ProgramCheck::State::on(const canon::ToolLengthOffset& c, const Command& command) {
  unsure.length = false;
  length = c.offset;
  length_tool = c.tool;
  length_at = command.span;
  length_fresh = command.block != 0 && c.tool != 0;
  length_checked = false;
}

void ProgramCheck::State::turn_spindle(const canon::TurnSpindle& c, const Command& command) {
  const auto index = static_cast<std::size_t>(c.spindle);
  unsure.spindle = false;
  speed_checked = speed_checked && turn[index] == c.turn;
  if (c.turn == SpindleTurn::stop) {
    if (turn[index] != SpindleTurn::stop) stopped_in_block = command.block;
    turn[index] = c.turn;
    return;
  }
  turn[index] = c.turn;
  tell_held();
  stop_told = speed_told = false;
  turn_at = word_in(command.span, 'M', c.turn == SpindleTurn::clockwise ? 3 : 4);
}

void ProgramCheck::State::on(const canon::SetSpindleSpeed& c, const Command& command) {
  if (c.spindle != 0 && turn[0] != SpindleTurn::stop) return;
  unsure.speed = speed_checked = false;
  speed_word = c.value;
  if (!css()) speed_at = command.span;  // a surface speed says nothing about revolutions
}

void ProgramCheck::State::on(const canon::SetSpindleMode& c, const Command& command) {
  if (c.spindle != 0) return;
  if (c.css_max_rpm != css_limit) speed_at = command.span;
  css_limit = c.css_max_rpm;
  speed_checked = false;
}

void ProgramCheck::State::on(const canon::G92Offset& c, const Command& command) {
  if (command.block == 0) {
    g92 = g92_at_start = c.offset;
    return;
  }
  if (same(c.offset, g92)) return;
  g92 = c.offset;
  g92_at = command.span;
}

void ProgramCheck::State::on(const canon::WorkRotation& c, const Command& command) {
  if (command.block != 0 && c.angle != 0 && c.angle != rotation) rotation_at = command.span;
  rotation = c.angle;
}

void ProgramCheck::State::on(const canon::Probe&, const Command& command) {
  held.reset();                   // a probe is moved with the spindle stopped
  if (context.simulated) return;  // there is a model that it may touch
  tell_unknown("not_checked", command.span,
               "this probing move has nothing to touch here: it was taken to its end without "
               "contact, and what follows was looked at for that only",
               "look at the program for a contact too");
}

void ProgramCheck::State::on(const canon::WaitInput& c, const Command& command) {
  const SourceSpan at = word_in(command.span, 'M', 66);
  const std::string input =
      (c.analog ? "analog input " : "digital input ") + std::to_string(c.index);
  if (c.mode != 0)
    tell(Severity::warning, "wait_code", at,
         "M66 waits up to " + shortest(c.timeout) + " s for " + input +
             ", which comes from outside: the time is not known, nor that it comes",
         "let the program look at #5399, which is -1 when the signal did not come");
  if (context.simulated) return;
  // One that does not wait only matters when the program looks at the result.
  constexpr std::size_t most = 1000;  // in a loop it comes again and again
  if (c.mode == 0 && inputs.size() < most)
    inputs.emplace_back(command.span, input);
  else
    tell_input(command.span, input);
}

void ProgramCheck::State::tell_input(const SourceSpan& span, const std::string& input) {
  tell_unknown("not_checked", span,
               "M66 reads " + input + ", which has no model here: it is taken as 0",
               "what follows was checked for that value only");
}

void ProgramCheck::State::on(const canon::UserCode& c, const Command& command) {
  if (context.simulated) return;
  if (c.letter != 'M')
    return tell_unknown("not_executed", command.span,
                        "the lines from here to G11 set data of the control, which is never done "
                        "here",
                        "take them out of the program, and give the control's data in the machine");
  if (context.machine) {
    const auto& rules = context.machine->user_codes();
    const auto rule = rules.find(c.code);
    if (rule != rules.end() && (rule->second.kind == machine::UserCodeKind::ignore ||
                                rule->second.kind == machine::UserCodeKind::time))
      return;
  }
  if (!c.remap.empty())
    return tell_unknown("not_executed", command.span,
                        c.remap + " is remapped to Python, which is never run here",
                        "what follows was checked as if the remap did nothing more than the code "
                        "itself");
  const std::string name = "M" + std::to_string(c.code);
  tell_unknown(
      "not_executed", word_in(command.span, 'M', c.code),
      name + " runs a program of the control, which is never run here",
      "say in a machine's [mcodes] that it can be ignored: " + name + " = { kind = \"ignore\" }");
}

// G92 and a rotation of a work system outlive the program; only what it has changed itself is told.
void ProgramCheck::State::tell_what_stays(const std::map<int, double>& before,
                                          const std::map<int, double>& after) {
  if (!same(g92, AxisValues{}) && !same(g92, g92_at_start)) {
    SourceSpan at = word_in(g92_at, 'G', 92);
    if (at.length == g92_at.length) at = word_in(g92_at, 'G', 52);
    tell(Severity::warning, "offset_left_on", at,
         "this offset is still on when the program ends (" + axes_text(g92) +
             "): the next program starts with it",
         "give G92.1 before the end");
  }
  constexpr int first_rotation = 5230, systems = 9, stride = 20;
  const auto value = [](const std::map<int, double>& parameters, int n) {
    const auto found = parameters.find(n);
    return found == parameters.end() ? 0.0 : found->second;
  };
  static constexpr const char* names[] = {"G54", "G55",   "G56",   "G57",  "G58",
                                          "G59", "G59.1", "G59.2", "G59.3"};
  for (int system = 0; system < systems; ++system) {
    const int n = first_rotation + stride * system;
    const double angle = value(after, n);
    if (angle == 0 || angle == value(before, n)) continue;
    tell(Severity::warning, "offset_left_on", rotation_at ? rotation_at : last,
         std::string(names[system]) + " is still turned by " + shortest(angle) +
             "° when the program ends: the next program that uses it is turned too",
         "give G10 L2 P" + std::to_string(system + 1) + " R0 before the end");
  }
}

}  // namespace aircut::semantics
