// What happens before the first line: settings, parameters, a look at the text, the start state.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"
#include "interp/impl.h"
#include "interp/lexer.h"

namespace aircut::interp {
namespace {

std::string_view trimmed(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t") - first + 1);
}

}  // namespace

Interpreter::Impl::Impl(const SourceText& program, const tool::ToolTable& tools,
                        const ParameterFile& file, Options options, SourceReader reader,
                        Diagnostics& diagnostics)
    : options_(std::move(options)),
      reader_(std::move(reader)),
      diagnostics_(diagnostics),
      table_(options_.dialect, options_.lathe),
      parameters_(*this, options_.ini_variables ? options_.ini : std::map<std::string, double>(),
                  table_.dialect().macro_b, options_.hal_pins),
      tools_(tools),
      session_{options_,
               table_,
               parameters_,
               tools_,
               {},
               {},
               options_.machine_unit == canon::Unit::inch ? 25.4 : 1.0,
               std::vector<std::uint64_t>(CodeTable::slots)} {
  if (options_.limits.max_depth == 0) options_.limits.max_depth = table_.dialect().max_depth;
  options_.spindles = std::clamp(options_.spindles, 1, max_spindles);
  frames_.emplace_back();
  frames_.back().file = &file_for(program);
  start_kinematics();
  session_.remaps.fill(options_.remaps, table_);
  for (const Axis axis : all_axes)
    if ((!options_.axes.empty() && !options_.axes.has(axis)) || options_.wrapped.has(axis) ||
        options_.indexers.has(axis))
      other_axes_ |= letter_bit(letter(axis));
  start(file);
}

void Interpreter::Impl::start(const ParameterFile& file) {
  state_.unit = options_.start_unit;
  if (table_.dialect().motion_at_start) state_.motion = 0;
  state_.retract_to_r = !table_.dialect().macro_b;  // Fanuc and Haas switch on with G98
  if (table_.dialect().macro_b && options_.lathe) {
    state_.plane = canon::Plane::zx;
    state_.lathe_diameter = true;
    state_.feed_mode = canon::FeedMode::per_revolution;
  }
  state_.tool = options_.tool_in_spindle;
  if (table_.dialect().macro_b) load_offsets(file);
  // The spindle of a random tool changer is its pocket 0.
  if (tools_.random_changer && state_.tool == 0)
    for (const tool::Tool& tool : tools_.tools)
      if (tool.pocket == 0) state_.tool = tool.number;
  load_parameters(file);
  if (!options_.keep_g92) {
    for (int n = number::g92_applied; n < number::g92_offset + 9; ++n) parameters_.write(n, 0);
    parameters_.commit();
  }
  apply_settings();
  const bool fanuc = table_.dialect().macro_b;  // starts with G54 and no shift
  const double stored = fanuc ? 1 : parameters_.stored(number::active_system);
  const int system = static_cast<int>(std::lround(std::clamp(stored, 1.0, 9.0)));
  parameters_.write(number::active_system, system);
  {
    BlockRun run(session_, scratch_, state_, *this, queue_);
    load_work_system(run, system);
    if (!fanuc && parameters_.stored(number::g92_applied) != 0)
      state_.g92 = run.stored_axes(number::g92_offset);
  }
  state_.tip = options_.start;
  parameters_.commit();
  if (!options_.dialect_reason.empty()) {
    SourceSpan at;
    at.text = frames_.back().file->text;
    at.line = 1;
    diagnostics_.add({Severity::info, "dialect_chosen", options_.dialect_reason, at});
  }
  if (!text_is_readable()) return stop();
  emit_start_state();
  if (!remaps_are_sound()) return stop();
  if (options_.startup) run_startup_line();
}

// The machine's own codes for its kinematics are remaps; those of the set-up come first.
void Interpreter::Impl::start_kinematics() {
  const KinematicsSwitch& models = options_.kinematics;
  state_.kinematics = models.start;
  for (const auto& [code, model] : models.codes) {
    const std::string name = "M" + std::to_string(code);
    const auto same = [&](const Remap& remap) { return remap.name == name; };
    if (std::any_of(options_.remaps.begin(), options_.remaps.end(), same)) continue;
    Remap remap;
    remap.code = code;
    remap.modal_group = 10;
    remap.model = model;
    remap.name = name;
    options_.remaps.push_back(std::move(remap));
  }
  tell_kinematics();
}

// motion.switchkins-type has the number by which the control knows the kinematics in force.
void Interpreter::Impl::tell_kinematics() {
  if (!options_.kinematics.output) return;
  const std::vector<int>& models = options_.kinematics.by_value;
  const auto at = std::find(models.begin(), models.end(), state_.kinematics);
  if (at != models.end())
    parameters_.write_pin(kinematics_pin, static_cast<double>(at - models.begin()));
}

// One line that the machine's set-up gives, executed as if it stood before the program.
void Interpreter::Impl::run_startup_line() {
  Frame& frame = frames_.emplace_back();
  frame.file = &file_for(*options_.startup);
  frame.at = options_.startup_line.begin;
  frame.line = options_.startup_line.line - 1;
  if (Block* block = fetch()) {
    if (block->oword.keyword == Keyword::none) {
      ++statistics_.blocks;
      execute_words(*block);
    } else {
      report("flow_syntax", block->oword.place,
             "the start-up line can't hold an O-word here; write the codes themselves");
    }
  }
  if (statistics_.ended) {  // M2 resets the modes; the program is still to come
    statistics_.ended = false;
    done_ = false;
  }
  while (frames_.size() > 1) frames_.pop_back();
  block_ = nullptr;
  span_valid_ = false;
}

// Work systems and reference points of a Fanuc-like control, by the numbers of its own variables.
void Interpreter::Impl::load_offsets(const ParameterFile& file) {
  OffsetMemory& offsets = session_.offsets;
  offsets = OffsetMemory(tools_);
  const auto read = [&](int first) -> std::optional<AxisValues> {
    AxisValues values;
    bool any = false;
    for (const Axis axis : all_axes) {
      const auto found = file.values.find(first + static_cast<int>(index(axis)));
      if (found == file.values.end()) continue;
      any = true;
      values[axis] =
          found->second * (is_rotary(axis) ? radian_per_degree : session_.machine_unit_mm);
    }
    if (state_.lathe_diameter) values[Axis::x] /= 2;
    return any ? std::optional(values) : std::nullopt;
  };
  for (int system = 0; system <= OffsetMemory::extended + OffsetMemory::max_extended; ++system)
    if (OffsetMemory::has_system(system))
      if (const auto values = read(system_variable_of(system))) offsets.system(system) = *values;
  for (int n = 1; n <= 4; ++n)
    if (const auto values = read(OffsetMemory::reference_number(n)))
      offsets.set_reference(n, *values);
}

void Interpreter::Impl::store_offsets(ParameterFile& file) const {
  const auto write = [&](int first, AxisValues values) {
    if (table_.lathe()) values[Axis::x] *= 2;
    for (const Axis axis : all_axes)
      file.values[first + static_cast<int>(index(axis))] =
          values[axis] / (is_rotary(axis) ? radian_per_degree : session_.machine_unit_mm);
  };
  for (int system = 0; system <= OffsetMemory::extended + OffsetMemory::max_extended; ++system) {
    if (!OffsetMemory::has_system(system)) continue;
    const AxisValues& values = session_.offsets.system(system);
    if (system <= 6 || !(values == AxisValues{})) write(system_variable_of(system), values);
  }
  for (int n = 1; n <= 4; ++n)
    if (const auto point = session_.offsets.reference(n))
      write(OffsetMemory::reference_number(n), *point);
}

void Interpreter::Impl::load_parameters(const ParameterFile& file) {
  for (const auto& [n, value] : file.values) {
    if (!Parameters::in_range(n) || Parameters::read_only(n)) continue;
    parameters_.write(n, value);
    kept_numbers_.push_back(n);
  }
  parameters_.commit();
}

void Interpreter::Impl::apply_settings() {
  for (const auto& [target, value] : options_.set) {
    Block block;
    const std::string line = target + "=" + shortest(value);
    const auto fault = parse_line(line, parameters_, table_, block);
    const bool macro_b = table_.dialect().macro_b;
    const bool is_setting = !fault && block.settings.size() == 1 && block.words.empty();
    bool done = false;
    if (is_setting) {
      const Setting& setting = block.settings.front();
      if (setting.name >= 0) {
        done = parameters_.settable_from_outside(setting.name);
        if (done) parameters_.write_named(setting.name, value);
      } else {
        const int n = as_integer(setting.target.number).value_or(0);
        done = setting.target.constant() &&
               (macro_b ? Parameters::is_macro_variable(n)
                        : Parameters::in_range(n) && !Parameters::read_only(n));
        if (done) parameters_.write(n, value);
      }
    }
    if (!done)
      diagnostics_.error("parameter_range", {},
                         "the parameter '" + printable(target) +
                             "' can't be set from outside; use #number or #<name>");
  }
  parameters_.commit();
}

bool Interpreter::Impl::text_is_readable() {
  ProgramFile& file = *frames_.back().file;
  const std::string_view text = file.text->content();
  SourceSpan at;
  at.text = file.text;
  at.line = 1;
  const auto refuse = [&](const char* kind, std::string message) {
    diagnostics_.error(kind, at, std::move(message));
    return false;
  };
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return refuse("encoding", "the text is UTF-16; save it as UTF-8 or plain text");
  if (text.starts_with("\xef\xbb\xbf")) {
    file.begin = 3;
    frames_.back().at = 3;
    at.length = 3;
    diagnostics_.error("encoding", at,
                       "the text begins with a byte order mark, which the control can't read; "
                       "save it as UTF-8 without one");
  }
  const std::string_view head = text.substr(0, 4096);
  const auto odd = std::count_if(head.begin(), head.end(), [](char c) {
    return (c >= 0 && c < ' ' && c != '\n' && c != '\r' && c != '\t') || c == 0x7f;
  });
  if (odd > 8 && static_cast<std::size_t>(odd) * 20 > head.size())
    return refuse("encoding", "this is not a text but binary data; give an NC program");
  if (!find_first_line(file))
    return refuse("empty_program", "the program is empty; it needs at least M2");
  return true;
}

// The first line that is not blank decides whether `%` brackets the program. False when there is
// none.
bool Interpreter::Impl::find_first_line(ProgramFile& file) const {
  const std::string_view text = file.text->content();
  for (std::uint64_t at = file.begin; at < text.size();) {
    const LineExtent extent = find_line_end(text, at, &file.reading);
    const std::string_view line = trimmed(text.substr(at, extent.end - at));
    if (!line.empty()) {
      file.percent = table_.dialect().macro_b ? line.front() == '%' : line == "%";
      return true;
    }
    at = extent.next;
  }
  return false;
}

// A file without a program header is run from its first line, behind the `%`.
BlockPlace Interpreter::Impl::first_line(const ProgramFile& file) const {
  BlockPlace place{file.begin, file.begin, 0};
  const std::string_view text = file.text->content();
  while (file.percent && place.after < text.size()) {
    const LineExtent extent = find_line_end(text, place.after);
    const std::string_view line = trimmed(text.substr(place.after, extent.end - place.after));
    place.after = extent.next;
    ++place.line;
    if (!line.empty()) break;
  }
  return place;
}

void Interpreter::Impl::emit_start_state() {
  const auto emit = [&](canon::Action action) {
    canon::Command command;
    command.action = std::move(action);
    queue_.push_back(std::move(command));
  };
  emit(canon::UseUnit{state_.unit});
  emit(canon::WorkOffset{state_.system, state_.work_offset});
  emit(canon::G92Offset{state_.g92});
  emit(canon::WorkRotation{state_.rotation});
  emit(canon::ToolLengthOffset{});
  emit(canon::SelectPlane{state_.plane});
  emit(canon::SetFeedMode{state_.feed_mode});
  emit(canon::SetFeedRate{});
  emit(canon::SetPathMode{state_.path_mode, 0});
  emit(canon::SetNaiveCam{0});
  if (state_.tool != 0) emit(canon::SetToolNumber{state_.tool});
}

ProgramFile& Interpreter::Impl::file_for(const SourceText& text) {
  auto& slot = files_[&text];
  if (!slot) {
    slot = std::make_unique<ProgramFile>(text);
  }
  return *slot;
}

}  // namespace aircut::interp
