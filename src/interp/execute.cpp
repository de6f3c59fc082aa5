// A block's words: values first, then the checks that the table gives for nothing (clashes in a
// group, axis words, words that nobody uses), then the codes in the order of their phases.
#include <algorithm>

#include "base/text.h"
#include "interp/codes/codes.h"
#include "interp/dialect.h"
#include "interp/impl.h"

namespace aircut::interp {
namespace {

constexpr std::uint32_t bit(char letter) { return letter_bit(letter); }
constexpr std::uint32_t polar_letters = bit('@') | bit('^');

std::uint32_t letters_of(const char* words) {
  std::uint32_t letters = 0;
  for (; *words; ++words) letters |= bit(*words);
  return letters;
}

char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

// Whether a line begins, behind / and N, with the code written just so: `M98`, not `M098`.
bool begins_with(std::string_view line, const std::string& code) {
  std::size_t at = 0;
  const auto next = [&] {
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
    return at < line.size() ? to_lower(line[at]) : '\0';
  };
  const auto is_number = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  if (next() == '/') ++at;
  if (next() == 'n') {
    ++at;
    while (is_number(next())) ++at;
  }
  for (const char c : code) {
    if (next() != to_lower(c)) return false;
    ++at;
  }
  return !is_number(next());
}

bool is_cycle(const CodeRule& rule) {
  return rule.handler == canned_cycle || rule.handler == fanuc_cycle;
}

// G5 and G5.1 act on their line only: the motion code before them, a cycle too, stays in force.
bool is_modal_motion(const CodeRule& rule) {
  return rule.group == ModalGroup::motion && rule.handler != cubic_spline &&
         rule.handler != quadratic_spline;
}

}  // namespace

void BlockExecutor::execute(std::string_view line) {
  if (!evaluate() || !settings()) return;
  const CodeRule* flow = code_of_flow();
  if (block_.comment && !flow) {
    const Comment& comment = *block_.comment;
    comment_action(line.substr(comment.text_begin, comment.text_length), comment.place, run_);
    if (!run_.ok()) return;
  }
  if (block_.words.empty()) return;
  if (run_.state.data_setting && !ends_data()) return;
  if (!collect() || !check_axes() || !find_motion() || !check_words()) return;
  if (flow && !stands_alone(*flow, line)) return;
  perform_from(0);
}

// M98, and M99 in its sub, are O-words in other clothes: a comment beside them does nothing, and
// the control refuses or passes over what else there is.
const CodeRule* BlockExecutor::code_of_flow() const {
  if (!(block_.letters & bit('M'))) return nullptr;
  for (const Word& word : block_.words) {
    if (!word.rule) continue;
    if (word.rule->handler == call_fanuc) return word.rule;
    if (word.rule->handler == return_fanuc && run_.level == Level::fanuc_sub) return word.rule;
  }
  return nullptr;
}

bool BlockExecutor::stands_alone(const CodeRule& rule, std::string_view line) {
  const std::uint32_t own = letters_of(rule.words);
  const auto belongs = [&](const Word& word) {
    return word.rule == &rule || (own & bit(word.letter));
  };
  const auto other = std::find_if(block_.words.begin(), block_.words.end(),
                                  [&](const Word& w) { return !belongs(w); });
  std::optional<Place> place;
  if (other != block_.words.end()) place = other->place;
  if (!block_.settings.empty()) place = block_.settings.front().place;
  if (!place && !begins_with(line, name_of(rule))) place = run_.place(rule);
  if (place)
    run_.error("flow_syntax", *place,
               name_of(rule) + " must be the first of its line, before comments too" +
                   (own ? ", and only P and L may stand behind it" : ", and nothing may follow") +
                   "; put the rest on another line");
  return !place;
}

void BlockExecutor::resume(const SuspendedBlock& rest) {
  items_ = rest.items;
  count_ = rest.count;
  run_.motion_rule = rest.motion_rule;
  run_.feed_given = rest.feed_given;
  mode_only_ = rest.mode_only;
  for (const Word& word : block_.words) letters_ |= bit(word.letter);
  run_.axis_words_ = (letters_ & (axis_letters | polar_letters)) != 0;
  perform_from(rest.next);
}

void BlockExecutor::perform_from(std::size_t first) {
  const RemapSet& remaps = run_.session.remaps;
  for (std::size_t i = first; i < count_ && run_.ok(); ++i) {
    const BlockItem& item = items_[i];
    const Remapped* remapped = remaps.empty() ? nullptr
                               : item.rule    ? remaps.of(item.rule)
                                              : remaps.of(item.letter);
    if (!remapped)
      perform(item);
    else if (remapped->remap->model)
      switch_kinematics(*item.rule, run_, *remapped->remap->model);
    else if (remapped->remap->python.empty())
      return call_remap(i);
    else {
      list_remap(run_, *remapped->remap);
      if (!item.rule || remapped->builtin) perform({item.phase, remapped->builtin, item.letter});
    }
    if (run_.switch_to_ && run_.ok()) return put_line_aside(first, i);
  }
  if (!run_.ok()) return;
  for (std::size_t i = first; i < count_; ++i)
    if (items_[i].rule) ++run_.session.executed[CodeTable::slot(*items_[i].rule)];
}

// What follows item `at` of the line.
std::unique_ptr<SuspendedBlock> BlockExecutor::rest_behind(std::size_t at) const {
  if (at + 1 >= count_) return nullptr;
  auto rest = std::make_unique<SuspendedBlock>();
  rest->block = block_;
  rest->items = items_;
  rest->count = count_;
  rest->next = at + 1;
  rest->motion_rule = run_.motion_rule;
  rest->feed_given = run_.feed_given;
  rest->mode_only = mode_only_;
  return rest;
}

// The machine's kinematics changes behind item `at`; the rest needs the position in the new one.
void BlockExecutor::put_line_aside(std::size_t first, std::size_t at) {
  for (std::size_t i = first; i <= at; ++i)
    if (items_[i].rule) ++run_.session.executed[CodeTable::slot(*items_[i].rule)];
  run_.state.kinematics = run_.switch_to_->model;
  run_.emit(*run_.switch_to_);
  run_.flow.kind = FlowRequest::Kind::kinematics;
  run_.remap = std::make_unique<RemapCall>();
  // Item 0 as what follows item "-1": unsigned arithmetic wraps as it should.
  run_.remap->rest = rest_behind(run_.switch_again_ ? at - 1 : at);
}

// The sub runs once what stands before its code on the line is done and kept.
void BlockExecutor::call_remap(std::size_t at) {
  const BlockItem& item = items_[at];
  auto call = std::make_unique<RemapCall>();
  call->remapped =
      item.rule ? run_.session.remaps.of(item.rule) : run_.session.remaps.of(item.letter);
  call->place = item.rule ? run_.place(*item.rule) : run_.place(item.letter);
  if (!remap_arguments(run_, *call)) return;
  call->rest = rest_behind(at);
  run_.flow.kind = FlowRequest::Kind::remap;
  run_.remap = std::move(call);
}

// Words and settings read the parameters as they are before the line. But a name that is new is 0
// from where the line sets it: `#<n>=[#<n>+1]` gives 1.
bool BlockExecutor::value_of(const Value& value, double& number) {
  Parameters& parameters = run_.session.parameters;
  while (true) {
    std::optional<Fault> fault;
    if (interp::evaluate(value, block_.code, parameters, number, fault)) return true;
    const bool undefined = std::string_view(fault->kind) == "parameter_undefined";
    const auto is_new = [&](const Setting& setting) {
      return undefined && setting.name >= 0 && setting.place.begin < fault->place.begin &&
             !parameters.exists(setting.name) && !parameters.read_only_name(setting.name);
    };
    const auto found = std::find_if(block_.settings.begin(), block_.settings.end(), is_new);
    if (found == block_.settings.end()) {
      run_.fault_ = fault;
      return false;
    }
    parameters.write_named(found->name, 0);
  }
}

bool BlockExecutor::evaluate() {
  if (run_.session.table.dialect().macro_b) return evaluate_macro_b();
  if (!block_.has_expressions) return true;
  for (Word& word : block_.words) {
    if (word.text.constant()) continue;
    if (!value_of(word.text, word.number)) return false;
    if (word.letter == 'G' || word.letter == 'M')
      word.rule = run_.session.table.find(word.letter, word.number);
  }
  return true;
}

bool BlockExecutor::settings() {
  if (block_.settings.empty()) return true;
  if (run_.session.table.dialect().macro_b) return macro_settings();
  Parameters& parameters = run_.session.parameters;
  // A line has room for no more settings than this: each takes four characters.
  struct Set {
    std::int32_t target;  // number, or -1 - name
    double value;
  };
  std::array<Set, 64> set;
  std::size_t count = 0;
  for (const Setting& setting : block_.settings) {
    double value = 0, target = 0;
    if (!value_of(setting.value, value)) return false;
    if (setting.name >= 0) {
      if (parameters.read_only_name(setting.name)) {
        run_.error("parameter_read_only", setting.place,
                   "#<" + printable(parameters.name_of(setting.name)) +
                       "> can't be set; use a name of your own");
        return false;
      }
      set[count++] = {-1 - setting.name, value};
      continue;
    }
    if (!value_of(setting.target, target)) return false;
    const auto index = as_integer(target);
    if (!index || !Parameters::in_range(*index)) {
      run_.error("parameter_range", setting.place,
                 "there is no parameter #" + shortest(target) + "; numbers go from 1 to " +
                     std::to_string(number::last));
      return false;
    }
    if (Parameters::read_only(*index)) {
      run_.error(
          "parameter_read_only", setting.place,
          "#" + std::to_string(*index) + " follows from the machine's state and can't be set");
      return false;
    }
    set[count++] = {*index, value};
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto [target, value] = set[i];
    if (target >= 0)
      parameters.write(target, value);
    else
      parameters.write_named(-1 - target, value);
  }
  return true;
}

void BlockExecutor::add(Phase phase, const CodeRule* rule, char letter) {
  std::size_t at = count_++;
  for (; at > 0 && items_[at - 1].phase > phase; --at) items_[at] = items_[at - 1];
  items_[at] = {phase, rule, letter};
}

// Of two codes of one group the control takes the last one.
void BlockExecutor::replace_code(const CodeRule& rule, Place place) {
  for (std::size_t i = 0; i < count_; ++i) {
    const CodeRule* other = items_[i].rule;
    if (!other || other->letter != 'G' || other->group != rule.group) continue;
    if (other->code != rule.code)
      run_.warning("modal_clash", place,
                   name_of(*other) + " stands in the same block and is of the same group (" +
                       name_of(rule.group) + "); the control takes the last one, " + name_of(rule));
    if (own_ == other) own_ = nullptr;
    if (shared_ == other) shared_ = nullptr;
    for (std::size_t k = i + 1; k < count_; ++k) items_[k - 1] = items_[k];
    --count_;
    return;
  }
}

void BlockExecutor::drop_g80() {
  const auto last =
      std::remove_if(items_.begin(), items_.begin() + count_, [](const BlockItem& item) {
        return item.rule && item.rule->letter == 'G' && item.rule->code == 800;
      });
  count_ = static_cast<std::size_t>(last - items_.begin());
}

// Behind G10 L50 the lines are data of the control until G11, or the end of the program.
bool BlockExecutor::ends_data() const {
  for (const Word& word : block_.words)
    if (word.rule && ((word.letter == 'G' && word.rule->code == 110) ||
                      (word.letter == 'M' && word.rule->group == ModalGroup::stop)))
      return true;
  return false;
}

// Finds the rows of the codes, clashes in a group, and codes that are not known.
bool BlockExecutor::collect() {
  std::uint32_t groups = 0;
  const RemapSet& remaps = run_.session.remaps;
  for (Word& word : block_.words) {
    letters_ |= bit(word.letter);
    if (!remaps.empty()) word.rule = remaps.in_force(word.rule);
    switch (word.letter) {
      case 'F':
        add(Phase::feed, nullptr, 'F');
        continue;
      case 'S':
        add(Phase::speed, nullptr, 'S');
        continue;
      case 'T':
        add(Phase::tool_select, nullptr, 'T');
        continue;
      case 'G':
      case 'M':
        break;
      default:
        continue;
    }
    const CodeRule* rule = word.rule;
    const std::string name = rule && rule->handler ? "" : word.letter + shortest(word.number);
    if (!rule) {
      run_.unknown_code(word);
      return false;
    }
    if (!rule->handler) {
      run_.error("unsupported_code", word.place,
                 name + " is known but not implemented here; this line can't be checked");
      return false;
    }
    const std::uint32_t group = 1u << static_cast<unsigned>(rule->group);
    const bool clash = (groups & group) && rule->group != ModalGroup::free;
    if (clash && word.letter == 'G' && run_.session.table.dialect().macro_b) {
      replace_code(*rule, word.place);
    } else if (clash && rule->group == ModalGroup::motion && rule->code == 800) {
      continue;  // G80 beside another motion code does nothing
    } else if (clash && rule->group == ModalGroup::motion && run_.motion_rule->code == 800) {
      drop_g80();
    } else if (clash) {
      run_.error("modal_clash", word.place,
                 name_of(*rule) + " stands on one line with another code of the same group (" +
                     name_of(rule->group) + "); put it on a line of its own");
      return false;
    }
    groups |= group;
    if (rule->axes == AxisUse::own) own_ = rule;
    if (rule->axes == AxisUse::optional) shared_ = rule;
    if (rule->group == ModalGroup::motion) run_.motion_rule = rule;
    add(rule->phase, rule, word.letter);
  }
  polar_ = (letters_ & polar_letters) != 0;
  run_.axis_words_ = (letters_ & (axis_letters | polar_letters)) != 0;
  return true;
}

// On lathes without these axes A is the angle of a G1 line, and C a chamfer at its end.
bool BlockExecutor::is_corner_word(Axis axis) const {
  if (!run_.session.table.lathe() || (axis != Axis::a && axis != Axis::c)) return false;
  return (run_.motion_rule ? run_.motion_rule->code : run_.state.motion) == 10;
}

bool BlockExecutor::check_axes() {
  if (!(letters_ & axis_letters)) return true;
  const AxisSet present = run_.session.options.axes;
  if (present.empty()) return true;
  for (const Axis axis : all_axes) {
    if (present.has(axis) || !run_.has(letter(axis))) continue;
    if (run_.has_increments() && axis >= Axis::u) continue;
    if (is_corner_word(axis)) continue;
    std::string known;
    for (const Axis other : all_axes)
      if (present.has(other)) known += std::string(known.empty() ? "" : " ") + letter(other);
    run_.error("axis_unknown", letter(axis),
               std::string("this machine has no axis ") + letter(axis) + "; it has " + known);
    return false;
  }
  return true;
}

// The motion code of the line: a given one, or the modal one when axis words are left for it.
bool BlockExecutor::find_motion() {
  const ModalState& state = run_.state;
  const CodeRule* given = run_.motion_rule;
  const bool axes = run_.axis_words_;
  if (own_ && own_->group != ModalGroup::motion) {
    if (given && run_.session.table.dialect().macro_b) {
      // G0 on a line with G28 only sets the mode.
      if (given->code == 800 || given->code <= 30) {
        mode_only_ = given->code != 800;
        return true;
      }
    }
    if (given && given->code != 800) {
      run_.error("axis_conflict", *own_,
                 name_of(*own_) + " and " + name_of(*given) +
                     " would both use the axis words of the line; put them on two lines");
      return false;
    }
    if (polar_) {
      run_.error("polar_error", run_.has('@') ? '@' : '^',
                 "polar words (@ ^) can't be used with " + name_of(*own_) + "; give X and Y");
      return false;
    }
    return true;
  }
  if (given) {
    if (given->code == 800 && axes) {
      run_.error("axis_word_unused", *given,
                 "G80 ends canned cycles and takes no axis words; give G0 or G1 to move");
      return false;
    }
    return true;
  }
  const bool centre = (letters_ & (bit('I') | bit('J') | bit('K'))) != 0;
  const bool modal_arc = (state.motion == 20 || state.motion == 30) && centre;
  if (shared_ || (!axes && !modal_arc)) return true;
  const CodeRule* modal = state.motion == 800 ? nullptr : run_.session.table.find_g(state.motion);
  if (!modal || !modal->handler) {
    for (const Word& word : block_.words) {
      if (!(bit(word.letter) & (axis_letters | polar_letters))) continue;
      run_.error("axis_word_unused", word.place,
                 std::string("no code on this line or before it uses ") + word.letter +
                     "; give a motion code such as G0 or G1");
      return false;
    }
    return true;
  }
  run_.motion_rule = modal;
  add(modal->phase, modal, 0);
  return true;
}

bool BlockExecutor::check_words() {
  std::uint32_t used = bit('G') | bit('M') | bit('F') | bit('S') | bit('T') | axis_letters;
  if (letters_ & bit('S')) used |= bit('$');
  for (std::size_t i = 0; i < count_; ++i)
    if (items_[i].rule) used |= letters_of(items_[i].rule->words);
  if (run_.motion_rule && run_.motion_rule->axes == AxisUse::motion) used |= polar_letters;
  if (!(letters_ & ~used)) return true;
  for (const Word& word : block_.words) {
    if (used & bit(word.letter)) continue;
    run_.error("word_unused", word.place,
               "no code on this line uses the word " + written(word.letter) +
                   "; remove it or add the code that it belongs to");
    return false;
  }
  return true;
}

void BlockExecutor::perform(const BlockItem& item) {
  if (!item.rule) {
    if (item.letter == 'F') return feed_word(run_);
    if (item.letter == 'S' && own_ && own_->handler == speed_limit) return;
    if (item.letter == 'S') return speed_word(run_);
    return run_.session.table.lathe() ? lathe_tool_word(run_) : tool_word(run_);
  }
  const CodeRule& rule = *item.rule;
  if (rule.group == ModalGroup::motion && run_.state.nurbs_points > 0 && rule.code != 52) {
    run_.error("spline_error", rule,
               "only control points (G5.2 lines) may stand between G5.2 and G5.3");
    return;
  }
  if (is_modal_motion(rule) && !is_cycle(rule)) leave_cycle(rule);
  if (rule.group == ModalGroup::motion && mode_only_) return after_motion(rule);
  rule.handler(rule, run_);
  if (run_.ok() && rule.group == ModalGroup::motion) after_motion(rule);
}

void BlockExecutor::leave_cycle(const CodeRule& rule) {
  run_.state.cycle.code = 0;
  run_.state.rigid_tapping = false;
  if (rule.handler != single_pass) run_.state.turning.code = 0;
}

bool BlockExecutor::move(const CodeRule& rule) {
  if (!evaluate()) return false;
  run_.motion_rule = &rule;
  run_.axis_words_ = (block_.letters & axis_letters) != 0;
  if (block_.letters & bit('F')) feed_word(run_);
  if (run_.ok()) rule.handler(rule, run_);
  if (!run_.ok()) return false;
  leave_cycle(rule);
  after_motion(rule);
  ++run_.session.executed[CodeTable::slot(rule)];
  return true;
}

void BlockExecutor::after_motion(const CodeRule& rule) {
  if (is_modal_motion(rule))
    run_.state.motion = rule.code;
  else
    run_.state.cycle.interrupted = true;
  if (rule.code != 50) run_.state.spline.valid = false;
}

}  // namespace aircut::interp
