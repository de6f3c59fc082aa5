// `aircut diff A B`: do two programs move the machine in the same way? Both are interpreted; what
// counts are their moves (start, end, circle, feed or rapid, spindle, tool, coolant, tool length)
// and what the machine waits for. How a program is written does not count, nor where a straight
// line is cut into several.
//
// The moves of both are laid side by side with the fewest that stand alone (Myers 1986: the
// shortest way through the grid of pairs, found by the furthest place on each diagonal for 0, 1, 2
// … moves that stand alone).
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/exit_code.h"
#include "cli/job.h"

namespace aircut::cli {
namespace {

constexpr int most_alone = 4000;  // then the rest counts as different as a whole

// A move, or something that the machine waits for, with the state that it happens in.
struct Item {
  canon::Action action;
  AxisValues start, end;
  std::string file;
  std::uint64_t line = 0;
  double feed = 0, speed = 0;  ///< as programmed
  canon::FeedMode feed_mode = canon::FeedMode::per_minute;
  canon::PathMode path_mode = canon::PathMode::continuous;
  double tolerance = 0;
  canon::SpindleTurn turn = canon::SpindleTurn::stop;
  int tool = 0;
  bool mist = false, flood = false;
  AxisValues length;  ///< tool length offset
};

class Moves {
 public:
  Moves(Job& job, const SourceText& program, const ProgramArguments& arguments, double tolerance)
      : tolerance_(tolerance) {
    const interp::Options options = interpreter_options(job, arguments, program);
    now_.end = options.start;
    interp::Interpreter interpreter(program, job.tools, job.parameters, options,
                                    sub_reader(job.sources), diagnostics_);
    while (const auto command = interpreter.next()) {
      if (const auto* probe = std::get_if<canon::Probe>(&command->action))
        interpreter.resume({.tip = probe->end, .tripped = false});
      take(*command);
    }
    limit_reached_ = interpreter.statistics().limit_reached;
  }
  const std::vector<Item>& items() const { return items_; }
  const Diagnostics& diagnostics() const { return diagnostics_; }
  bool limit_reached() const { return limit_reached_; }

 private:
  void take(const canon::Command& command);
  void add(const canon::Command& command);
  bool goes_on(const Item& item) const;

  double tolerance_;
  Item now_;
  std::vector<Item> items_;
  Diagnostics diagnostics_;
  bool limit_reached_ = false;
};

bool same(const AxisValues& a, const AxisValues& b, double tolerance) {
  for (const Axis axis : all_axes) {
    const double unit = is_rotary(axis) ? M_PI / 180 : 1;
    if (std::abs(a[axis] - b[axis]) > tolerance * unit) return false;
  }
  return true;
}

std::vector<std::string> state_differences(const Item& a, const Item& b) {
  std::vector<std::string> out;
  const auto number = [&](const char* what, double x, double y) {
    if (std::abs(x - y) > 1e-9 * std::max(std::abs(x), std::abs(y)))
      out.push_back(std::string(what) + " " + shortest(x) + " | " + shortest(y));
  };
  const bool rapid = std::holds_alternative<canon::Rapid>(a.action);
  const double minutes = a.feed_mode == canon::FeedMode::per_revolution ? 1 : 60;
  if (!rapid) number("feed", minutes * a.feed, minutes * b.feed);
  number("spindle speed", a.speed, b.speed);
  number("tool T", a.tool, b.tool);
  number("path tolerance P", a.tolerance, b.tolerance);
  if (a.turn != b.turn) out.push_back("spindle direction");
  if (!rapid && a.feed_mode != b.feed_mode) out.push_back("feed mode");
  if (a.path_mode != b.path_mode) out.push_back("path mode");
  if (a.mist != b.mist || a.flood != b.flood) out.push_back("coolant");
  if (!same(a.length, b.length, 1e-9)) out.push_back("tool length offset");
  return out;
}

// True if the item is a line that goes on straight where the last one ended.
bool Moves::goes_on(const Item& item) const {
  if (items_.empty()) return false;
  const Item& last = items_.back();
  const bool lines = (std::holds_alternative<canon::LinearFeed>(last.action) &&
                      std::holds_alternative<canon::LinearFeed>(item.action)) ||
                     (std::holds_alternative<canon::Rapid>(last.action) &&
                      std::holds_alternative<canon::Rapid>(item.action));
  // In exact stop, and in G93, each line takes its own time.
  if (!lines || item.path_mode == canon::PathMode::exact_stop ||
      item.feed_mode == canon::FeedMode::inverse_time || !state_differences(last, item).empty())
    return false;
  const AxisValues whole = item.end - last.start, first = last.end - last.start;
  double along = 0, square = 0;
  for (const Axis axis : all_axes) {
    along += first[axis] * whole[axis];
    square += whole[axis] * whole[axis];
  }
  if (!(square > 0) || along <= 0 || along >= square) return false;
  return same(last.end, last.start + (along / square) * whole, std::max(tolerance_, 1e-9));
}

void Moves::add(const canon::Command& command) {
  Item item = now_;
  item.action = command.action;
  item.start = now_.end;
  item.end = canon::is_motion(command.action) ? canon::end_of(command.action, now_.end) : now_.end;
  const bool stands = same(item.start, item.end, 0);
  item.file = command.span.text ? command.span.text->name() : "";
  item.line = command.span.line;
  now_.end = item.end;
  const bool line = std::holds_alternative<canon::LinearFeed>(command.action) ||
                    std::holds_alternative<canon::Rapid>(command.action);
  if (line && stands) return;
  if (goes_on(item))
    items_.back().end = item.end;
  else
    items_.push_back(std::move(item));
}

void Moves::take(const canon::Command& command) {
  const canon::Action& action = command.action;
  if (canon::is_motion(action)) return add(command);
  if (const auto* rate = std::get_if<canon::SetFeedRate>(&action)) now_.feed = rate->value;
  if (const auto* feed_mode = std::get_if<canon::SetFeedMode>(&action))
    now_.feed_mode = feed_mode->mode;
  if (const auto* path_mode = std::get_if<canon::SetPathMode>(&action)) {
    now_.path_mode = path_mode->mode;
    now_.tolerance = path_mode->tolerance;
  }
  if (const auto* speed = std::get_if<canon::SetSpindleSpeed>(&action))
    if (speed->spindle == 0) now_.speed = speed->value;
  if (const auto* turn = std::get_if<canon::TurnSpindle>(&action))
    if (turn->spindle == 0) now_.turn = turn->turn;
  if (const auto* coolant = std::get_if<canon::Coolant>(&action))
    (coolant->kind == canon::Coolant::Kind::mist ? now_.mist : now_.flood) = coolant->on;
  if (const auto* change = std::get_if<canon::ChangeTool>(&action)) now_.tool = change->number;
  if (const auto* number = std::get_if<canon::SetToolNumber>(&action)) now_.tool = number->number;
  if (const auto* offset = std::get_if<canon::ToolLengthOffset>(&action)) {
    now_.end = now_.end + now_.length - offset->offset;
    now_.length = offset->offset;
  }
  const bool waits = std::holds_alternative<canon::Dwell>(action) ||
                     std::holds_alternative<canon::ChangeTool>(action) ||
                     std::holds_alternative<canon::ProgramStop>(action) ||
                     std::holds_alternative<canon::OrientSpindle>(action) ||
                     std::holds_alternative<canon::WaitInput>(action) ||
                     std::holds_alternative<canon::UserCode>(action) ||
                     std::holds_alternative<canon::DigitalOutput>(action) ||
                     std::holds_alternative<canon::AnalogOutput>(action) ||
                     std::holds_alternative<canon::ProgramEnd>(action);
  if (waits) add(command);
}

// The same way, or the same thing to wait for.
bool same_move(const Item& a, const Item& b, double tolerance) {
  if (a.action.index() != b.action.index()) return false;
  if (!same(a.end, b.end, tolerance)) return false;
  if (!canon::is_motion(a.action)) return canon::to_text(a.action) == canon::to_text(b.action);
  if (!same(a.start, b.start, tolerance)) return false;
  if (const auto* arc = std::get_if<canon::ArcFeed>(&a.action)) {
    const auto& other = std::get<canon::ArcFeed>(b.action);
    // The centre may lie anywhere along the axis.
    const Vec3 apart = arc->centre - other.centre;
    return arc->turns == other.turns && (arc->normal - other.normal).norm() < 1e-9 &&
           (apart - apart.dot(arc->normal) * arc->normal).norm() <= tolerance;
  }
  const bool line = std::holds_alternative<canon::LinearFeed>(a.action) ||
                    std::holds_alternative<canon::Rapid>(a.action);
  return line || canon::to_text(a.action) == canon::to_text(b.action);
}

// Pairs of items that are the same move, in order. `complete`: false if there are too many that
// stand alone; then the pairs end where the search ended.
std::vector<std::pair<std::size_t, std::size_t>> align(const std::vector<Item>& a,
                                                       const std::vector<Item>& b, double tolerance,
                                                       bool& complete) {
  const auto n = static_cast<std::ptrdiff_t>(a.size()), m = static_cast<std::ptrdiff_t>(b.size());
  std::vector<std::vector<std::ptrdiff_t>> trace;  // furthest x on the diagonals −d … d, by d
  std::ptrdiff_t end_k = 0, best = -1;
  std::ptrdiff_t d = 0;
  complete = false;
  const auto at = [&](std::ptrdiff_t row, std::ptrdiff_t k) {
    return trace[static_cast<std::size_t>(row)][static_cast<std::size_t>(k + row)];
  };
  for (; d <= std::min<std::ptrdiff_t>(most_alone, n + m) && !complete; ++d) {
    trace.emplace_back(2 * d + 1, -1);
    for (std::ptrdiff_t k = -d; k <= d && !complete; k += 2) {
      const bool down = d > 0 && (k == -d || (k != d && at(d - 1, k - 1) < at(d - 1, k + 1)));
      std::ptrdiff_t x = d == 0 ? 0 : down ? at(d - 1, k + 1) : at(d - 1, k - 1) + 1;
      if (x > n || x - k > m || x - k < 0) continue;
      while (
          x < n && x - k < m &&
          same_move(a[static_cast<std::size_t>(x)], b[static_cast<std::size_t>(x - k)], tolerance))
        ++x;
      trace.back()[static_cast<std::size_t>(k + d)] = x;
      complete = x >= n && x - k >= m;
      if (complete || (2 * x - k > best && d == std::min<std::ptrdiff_t>(most_alone, n + m))) {
        best = 2 * x - k;
        end_k = k;
      }
    }
  }
  std::vector<std::pair<std::size_t, std::size_t>> out;
  std::ptrdiff_t k = end_k;
  for (std::ptrdiff_t row = d - 1; row >= 0; --row) {
    const std::ptrdiff_t x = at(row, k);
    const bool down =
        row > 0 && (k == -row || (k != row && at(row - 1, k - 1) < at(row - 1, k + 1)));
    const std::ptrdiff_t from = row == 0 ? 0 : down ? at(row - 1, k + 1) : at(row - 1, k - 1) + 1;
    for (std::ptrdiff_t i = x; i > from; --i)
      out.emplace_back(static_cast<std::size_t>(i - 1), static_cast<std::size_t>(i - 1 - k));
    k += down ? 1 : -1;
  }
  std::reverse(out.begin(), out.end());
  return out;
}

std::string text_of(const Item& item) {
  return printable(item.file) + ":" + std::to_string(item.line) + "  " +
         printable(canon::to_text(item.action));
}

class Printer {
 public:
  explicit Printer(std::size_t most) : most_(most) {}
  void alone(const char* sign, const Item& item) {
    if (++count_ <= most_) std::printf("%s %s\n", sign, text_of(item).c_str());
  }
  void changed(const Item& a, const Item& b, const std::vector<std::string>& what) {
    // State stays: the moves behind the first one with the same change are only counted.
    const bool told = what == last_;
    last_ = what;
    ++count_;
    if (told || what.empty() || count_ > most_) return;
    std::printf("~ %s  |  line %llu\n", text_of(a).c_str(),
                static_cast<unsigned long long>(b.line));
    for (const std::string& text : what) std::printf("    %s\n", text.c_str());
  }
  void unchanged() { last_.clear(); }
  std::size_t count() const { return count_; }
  std::size_t hidden() const { return count_ > most_ ? count_ - most_ : 0; }

 private:
  std::size_t most_, count_ = 0;
  std::vector<std::string> last_;
};

}  // namespace

int diff_command(const DiffArguments& a) {
  Job job;
  ProgramArguments inputs = a.program;
  inputs.ini_use = ProgramArguments::IniUse::control;
  const bool open = open_inputs(job, inputs);
  print_errors(job.diagnostics, When::automatic);
  if (!open) return code(ExitCode::unknown);
  std::vector<std::unique_ptr<Moves>> sides;
  bool unknown = false;
  for (const std::string& path : {a.one, a.two}) {
    const auto program = open_program(job.sources, path);
    if (!program) {
      print_error(program.error(), When::automatic);
      return code(ExitCode::unknown);
    }
    sides.push_back(std::make_unique<Moves>(job, **program, a.program, a.tolerance));
    print_errors(sides.back()->diagnostics(), When::automatic);
    unknown = unknown || sides.back()->diagnostics().errors() > 0 || sides.back()->limit_reached();
  }
  const std::vector<Item>&one = sides[0]->items(), &two = sides[1]->items();
  bool complete = true;
  const auto pairs = align(one, two, a.tolerance, complete);
  Printer printer(a.most);
  std::size_t i = 0, j = 0;
  const auto alone_up_to = [&](std::size_t end_i, std::size_t end_j) {
    for (; i < end_i; ++i) printer.alone("-", one[i]);
    for (; j < end_j; ++j) printer.alone("+", two[j]);
  };
  for (const auto& [x, y] : pairs) {
    alone_up_to(x, y);
    const auto what = state_differences(one[x], two[y]);
    if (what.empty())
      printer.unchanged();
    else
      printer.changed(one[x], two[y], what);
    i = x + 1;
    j = y + 1;
  }
  if (complete)
    alone_up_to(one.size(), two.size());
  else
    std::printf("from %s and %s on the programs are too different to be laid side by side\n",
                i < one.size() ? text_of(one[i]).c_str() : "the end of A",
                j < two.size() ? text_of(two[j]).c_str() : "the end of B");
  if (printer.hidden() > 0) std::printf("… %zu more\n", printer.hidden());
  const bool differ = printer.count() > 0 || !complete;
  if (unknown) std::printf("not compared: what a program does behind its first error or limit\n");
  if (differ)
    std::printf("%zu differences in %zu and %zu moves\n", printer.count(), one.size(), two.size());
  else if (!unknown)
    std::printf("the motion is the same: %zu moves\n", one.size());
  return code(differ ? ExitCode::fail : unknown ? ExitCode::unknown : ExitCode::pass);
}

}  // namespace aircut::cli
