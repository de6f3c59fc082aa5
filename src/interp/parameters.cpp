#include "interp/parameters.h"

#include <algorithm>

#include "base/text.h"
#include "interp/macro_expression.h"

namespace aircut::interp {
namespace {

std::string upper(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return text;
}

constexpr bool within(int n, int first, int count) { return n >= first && n < first + count; }

// Numbers whose value follows from the machine's state.
bool is_live(int n) {
  return within(n, number::absolute_position, 9) || within(n, number::length_offset, 9) ||
         within(n, number::loaded_tool, 14) || within(n, number::current_position, 9);
}

}  // namespace

const std::vector<std::string>& predefined_names() {
  // In the order of Live::predefined.
  static const std::vector<std::string> names = {"_line",
                                                 "_motion_mode",
                                                 "_plane",
                                                 "_ccomp",
                                                 "_metric",
                                                 "_imperial",
                                                 "_absolute",
                                                 "_incremental",
                                                 "_inverse_time",
                                                 "_units_per_minute",
                                                 "_units_per_rev",
                                                 "_coord_system",
                                                 "_tool_offset",
                                                 "_retract_r_plane",
                                                 "_retract_old_z",
                                                 "_spindle_rpm_mode",
                                                 "_spindle_css_mode",
                                                 "_ijk_absolute_mode",
                                                 "_lathe_diameter_mode",
                                                 "_lathe_radius_mode",
                                                 "_spindle_on",
                                                 "_spindle_cw",
                                                 "_mist",
                                                 "_flood",
                                                 "_speed_override",
                                                 "_feed_override",
                                                 "_adaptive_feed",
                                                 "_feed_hold",
                                                 "_feed",
                                                 "_rpm",
                                                 "_x",
                                                 "_y",
                                                 "_z",
                                                 "_a",
                                                 "_b",
                                                 "_c",
                                                 "_u",
                                                 "_v",
                                                 "_w",
                                                 "_abs_x",
                                                 "_abs_y",
                                                 "_abs_z",
                                                 "_abs_a",
                                                 "_abs_b",
                                                 "_abs_c",
                                                 "_abs_u",
                                                 "_abs_v",
                                                 "_abs_w",
                                                 "_current_tool",
                                                 "_current_pocket",
                                                 "_selected_tool",
                                                 "_selected_pocket",
                                                 "_value",
                                                 "_value_returned",
                                                 "_task",
                                                 "_call_level",
                                                 "_remap_level",
                                                 "_vmajor",
                                                 "_vminor"};
  return names;
}

Parameters::Parameters(const LiveValues& live, std::map<std::string, double> ini, bool macro_b,
                       bool hal_pins)
    : live_(live),
      macro_b_(macro_b),
      ini_(std::move(ini)),
      hal_pins_(hal_pins),
      values_(number::last + 1, 0.0),
      levels_(1) {
  if (macro_b) {
    first_computed_ = macro_locals + 1;
    std::fill(values_.begin() + 1, values_.begin() + first_system, vacant_value);
  }
  values_[number::active_system] = 1;
  values_[number::debug_enabled] = 1;
}

bool Parameters::read_only(int n) { return is_live(n); }

std::optional<double> Parameters::read_high(int n, Place place, std::optional<Fault>& fault) const {
  if (macro_b_) {
    if (n == 0) return vacant_value;
    if (is_macro_variable(n)) return values_[static_cast<std::size_t>(n)];
    return live_.system_variable(n, place, fault);
  }
  if (!in_range(n)) {
    fault = Fault{"parameter_range", place,
                  "there is no parameter #" + std::to_string(n) + "; numbers go from 1 to " +
                      std::to_string(number::last)};
    return std::nullopt;
  }
  if (is_live(n)) return live_.numbered(n, place, fault);
  input_read_ = input_read_ || n == number::input_result;
  return values_[static_cast<std::size_t>(n)];
}

void Parameters::write_pin(std::string_view name, double value) {
  Name& pin = names_[static_cast<std::size_t>(intern(name))];
  pin.defined = true;
  pin.value = value;
}

void Parameters::write(int n, double value) {
  double& stored = values_[static_cast<std::size_t>(n)];
  journal_.push_back({n, true, stored});
  stored = value;
}

std::int32_t Parameters::intern(std::string_view name) {
  if (const auto found = ids_.find(name); found != ids_.end()) return found->second;
  Name entry;
  entry.text = std::string(name);
  const auto& predefined = predefined_names();
  const auto at = std::find(predefined.begin(), predefined.end(), entry.text);
  if (at != predefined.end()) {
    entry.kind = NameKind::predefined;
    entry.index = static_cast<int>(at - predefined.begin());
  } else if (name.starts_with("_ini[") && name.find(']') != std::string_view::npos) {
    const std::size_t close = name.find(']');
    const auto found = ini_.find(
        upper(std::string(name.substr(5, close - 5)) + "/" + std::string(name.substr(close + 1))));
    entry.kind = NameKind::ini;
    entry.defined = found != ini_.end();
    if (entry.defined) entry.value = found->second;
  } else if (name.starts_with("_hal[") && hal_pins_) {
    entry.kind = NameKind::pin;
  } else if (name.starts_with("_")) {
    entry.kind = NameKind::global;
  }
  const auto id = static_cast<std::int32_t>(names_.size());
  names_.push_back(std::move(entry));
  ids_.emplace(std::string(name), id);
  return id;
}

const std::string& Parameters::name_of(std::int32_t id) const {
  return names_[static_cast<std::size_t>(id)].text;
}

std::optional<std::int32_t> Parameters::known(std::string_view name) const {
  const auto found = ids_.find(name);
  if (found == ids_.end()) return std::nullopt;
  return found->second;
}

// Sorted by id; new names mostly come at the end.
std::size_t Parameters::place_of(std::int32_t id) const {
  const auto& locals = levels_.back().locals;
  return static_cast<std::size_t>(std::lower_bound(locals.begin(), locals.end(), id,
                                                   [](const auto& entry, std::int32_t wanted) {
                                                     return entry.first < wanted;
                                                   }) -
                                  locals.begin());
}

const double* Parameters::local(std::int32_t id) const {
  const auto& locals = levels_.back().locals;
  const std::size_t at = place_of(id);
  return at < locals.size() && locals[at].first == id ? &locals[at].second : nullptr;
}

bool Parameters::exists(std::int32_t id) const {
  const Name& name = names_[static_cast<std::size_t>(id)];
  switch (name.kind) {
    case NameKind::local:
      return local(id) != nullptr;
    case NameKind::predefined:
      return true;
    default:
      return name.defined;
  }
}

bool Parameters::read_only_name(std::int32_t id) const {
  const NameKind kind = names_[static_cast<std::size_t>(id)].kind;
  return kind != NameKind::local && kind != NameKind::global;
}

bool Parameters::settable_from_outside(std::int32_t id) const {
  const NameKind kind = names_[static_cast<std::size_t>(id)].kind;
  return kind == NameKind::pin || !read_only_name(id);
}

std::optional<double> Parameters::read_named(std::int32_t id, Place place,
                                             std::optional<Fault>& fault) const {
  const Name& name = names_[static_cast<std::size_t>(id)];
  if (name.kind == NameKind::predefined) return live_.predefined(name.index);
  if (name.kind == NameKind::local) {
    if (const double* value = local(id)) return *value;
  } else if (name.defined) {
    return name.value;
  }
  std::string message = "the parameter #<" + printable(name.text) + "> is not defined";
  if (name.kind == NameKind::pin)
    message +=
        ": there is no machine whose pins could be read; give the value that the pin has, "
        "e.g. --set '#<" +
        printable(name.text) + ">=1'";
  else if (name.kind == NameKind::ini)
    message +=
        "; the machine's INI file has no such entry with a number (section and key in "
        "capitals)";
  else
    message += "; set it before this line, e.g. #<" + printable(name.text) + "> = 0";
  fault = Fault{"parameter_undefined", place, std::move(message)};
  return std::nullopt;
}

void Parameters::set_named(std::int32_t id, bool defined, double value) {
  Name& name = names_[static_cast<std::size_t>(id)];
  if (name.kind != NameKind::local) {
    name.defined = defined;
    name.value = value;
    return;
  }
  auto& locals = levels_.back().locals;
  const std::size_t place = place_of(id);
  const auto at = locals.begin() + static_cast<std::ptrdiff_t>(place);
  const bool known = place < locals.size() && at->first == id;
  if (defined && known)
    at->second = value;
  else if (defined)
    locals.emplace(at, id, value);
  else if (known)
    locals.erase(at);
}

void Parameters::write_named(std::int32_t id, double value) {
  const Name& name = names_[static_cast<std::size_t>(id)];
  const double* old = name.kind == NameKind::local ? local(id) : &name.value;
  const bool defined = name.kind == NameKind::local ? old != nullptr : name.defined;
  journal_.push_back({-1 - id, defined, old ? *old : 0});
  set_named(id, true, value);
}

void Parameters::roll_back() {
  for (auto change = journal_.rbegin(); change != journal_.rend(); ++change) {
    if (change->id >= 0)
      values_[static_cast<std::size_t>(change->id)] = change->value;
    else
      set_named(-1 - change->id, change->defined, change->value);
  }
  journal_.clear();
}

void Parameters::enter(const std::vector<double>* arguments) {
  Level level;
  if (arguments) {
    level.saves = 30;
    for (std::size_t i = 0; i < 30; ++i) {
      level.saved[i] = values_[i + 1];
      values_[i + 1] = i < arguments->size() ? (*arguments)[i] : 0;
    }
  }
  levels_.push_back(std::move(level));
}

void Parameters::leave() {
  const Level& level = levels_.back();
  for (std::size_t i = 0; i < level.saves; ++i) values_[i + 1] = level.saved[i];
  levels_.pop_back();
}

void Parameters::enter_macro(const std::vector<double>& locals) {
  Level level;
  level.saves = macro_locals;
  for (std::size_t i = 0; i < level.saves; ++i) {
    level.saved[i] = values_[i + 1];
    values_[i + 1] = locals[i];
  }
  levels_.push_back(std::move(level));
}

}  // namespace aircut::interp
