#include <algorithm>
#include <cmath>

#include "linuxcnc/folder.h"
#include "linuxcnc/module_import.h"

namespace aircut::linuxcnc {

using package::Couple;
using package::CoupleLimits;

namespace {

constexpr double mm_per_inch = 25.4;
constexpr double farthest_mm = 1e5, farthest_deg = 1e6;  // a limit beyond is none

std::string upper(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return text;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t from = text.find_first_not_of(" \t", at);
    if (from == text.npos) break;
    at = std::min(text.find_first_of(" \t", from), text.size());
    words.push_back(text.substr(from, at - from));
  }
  return words;
}

double unit_of(const ini::IniFile& ini) {
  const ini::Entry* entry = ini.find("TRAJ", "LINEAR_UNITS");
  if (!entry) return 1;
  const std::string word = upper(entry->value);
  const auto scale = ini::number_of(word);  // units per mm
  const bool inch = word == "INCH" || word == "IN" || word == "IMPERIAL" ||
                    (scale && std::fabs(*scale * mm_per_inch - 1) < 1e-4);
  return inch ? mm_per_inch : 1;
}

// Reads the HAL files and commands of a set-up in the order in which the control does.
class HalFiles {
 public:
  HalFiles(const ini::IniFile& ini, const Folder& folder, SourceMap& sources, Diagnostics& out)
      : ini_(ini), folder_(folder), sources_(sources), out_(out) {}

  void read(Hal& hal) {
    for (const ini::Entry* entry : ini_.all("HAL", "HALFILE")) file(*entry, hal);
    for (const ini::Entry* entry : ini_.all("HAL", "HALCMD"))
      hal.command(entry->value, entry->span);
    for (const ini::Entry* entry : ini_.all("HAL", "POSTGUI_HALFILE")) file(*entry, hal);
  }
  /// Files that may hold something that counts.
  const std::vector<std::string>& not_read() const { return not_read_; }

 private:
  void file(const ini::Entry& entry, Hal& hal) {
    const std::vector<std::string> words = words_of(entry.value);
    if (words.empty()) return;
    const std::string& name = words.front();
    // LinuxCNC's own library: it knows no kinematics.
    if (name.starts_with("LIB:")) return;
    if (name.ends_with(".tcl")) {
      out_.add({Severity::info,
                "not_executed",
                entry.key + " names a program, which is never run here",
                entry.span,
                {},
                {}});
      not_read_.push_back(name);
      return;
    }
    const auto path = folder_.resolve(name, false);
    const auto text = path ? sources_.open(*path) : unexpected(path.error());
    if (text) return hal.read(**text);
    not_read_.push_back(name);
    out_.add({Severity::info,
              "ini_ignored",
              entry.key + ": " + text.error().message + "; it is not read",
              entry.span,
              {},
              {}});
  }

  const ini::IniFile& ini_;
  const Folder& folder_;
  SourceMap& sources_;
  Diagnostics& out_;
  std::vector<std::string> not_read_;
};

std::vector<ModuleRow> all_modules() {
  std::vector<ModuleRow> rows;
  for (const auto part : {serial_modules(), other_modules()})
    rows.insert(rows.end(), part.begin(), part.end());
  return rows;
}

}  // namespace

ModuleImport::ModuleImport(const ini::IniFile& ini, Hal& hal, double unit_mm, Diagnostics& out,
                           MachineImport& result)
    : ini_(ini), hal_(hal), unit_mm_(unit_mm), out_(out), result_(result), text_([&] {
        const ini::Entry* name = ini.find("EMC", "MACHINE");
        return name ? name->value : std::string("LinuxCNC machine");
      }()) {}

const ini::Entry* ModuleImport::find(const std::string& section, std::string_view key) const {
  return ini_.find(section, key);
}

std::optional<double> ModuleImport::number(const std::string& section, std::string_view key) {
  const ini::Entry* entry = find(section, key);
  if (!entry) return std::nullopt;
  const auto value = ini::number_of(entry->value);
  if (!value)
    out_.error("ini_value", entry->span,
               entry->key + ": '" + printable(entry->value) + "' is not a plain number");
  return value;
}

void ModuleImport::unchecked(const std::string& what) {
  out_.warning("ini_not_modelled", span_, module_ + ": " + what);
  result_.unchecked.push_back(module_ + ": " + what);
}

void ModuleImport::undrawn(const std::string& what) { result_.undrawn.push_back(what); }

void ModuleImport::error(const std::string& what) {
  out_.error("ini_kinematics", span_, module_ + ": " + what);
}

// `trivkins coordinates=XYYZ kinstype=BOTH`: what the module is loaded with.
void ModuleImport::parameters(const ini::Entry& kinematics) {
  const std::vector<std::string> words = words_of(kinematics.value);
  module_ = words.front();
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    const std::string key = words[i].substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : words[i].substr(equals + 1);
    if (key == "coordinates") {
      coordinates_ = upper(value);
      for (const char c : coordinates_)
        if (!axis_of_letter(c)) {
          error("coordinates= holds letters of axes (X Y Z A B C U V W), '" +
                printable(std::string(1, c)) + "' is none");
          coordinates_.clear();
          break;
        }
    } else if (key == "sparm") {
      identity_first_ = value == "identityfirst";
      if (!identity_first_) unchecked("sparm=" + printable(value) + " is not known");
    } else if (key != "kinstype") {  // that is for the screen
      out_.warning("ini_ignored", kinematics.span,
                   "'" + printable(words[i]) + "' is no parameter of a kinematics module");
    }
  }
}

void ModuleImport::count_joints() {
  const auto count = number("KINS", "JOINTS");
  constexpr int most = 16;
  if (count && *count == std::round(*count) && *count >= 1 && *count <= most) {
    joints_ = static_cast<int>(*count);
    return;
  }
  const ini::Entry* entry = find("KINS", "JOINTS");
  if (!entry)
    error("[KINS]JOINTS is missing: the number of joints");
  else if (count)
    out_.error("ini_value", entry->span, "JOINTS: must be a whole number from 1 to 16");
}

std::string ModuleImport::letters(std::string_view usual) {
  return coordinates_.empty() ? std::string(usual) : coordinates_;
}

std::string ModuleImport::section_of(int joint) const { return "JOINT_" + std::to_string(joint); }

CoupleLimits ModuleImport::limits(int joint, bool rotary, char axis) {
  const double scale = rotary ? 1 : unit_mm_, farthest = rotary ? farthest_deg : farthest_mm;
  const std::string own = section_of(joint), of_axis = std::string("AXIS_") + axis;
  const ini::Entry* type = find(own, "TYPE");
  if (type && rotary != (upper(type->value) == "ANGULAR"))
    out_.warning("ini_not_modelled", type->span,
                 "TYPE: joint " + std::to_string(joint) + " of " + module_ + " is taken as " +
                     (rotary ? "ANGULAR" : "LINEAR"));
  CoupleLimits l;
  const auto least = [](std::optional<double>& so_far, std::optional<double> value, double sign) {
    if (value && (!so_far || *value * sign < *so_far * sign)) so_far = value;
  };
  std::optional<double> vmax = number(own, "MAX_VELOCITY"), amax = number(own, "MAX_ACCELERATION");
  // What the control takes without.
  if (!vmax) vmax = 1.0;
  if (!amax) amax = 1.0;
  l.min = number(own, "MIN_LIMIT");
  l.max = number(own, "MAX_LIMIT");
  if (axis) {
    least(l.min, number(of_axis, "MIN_LIMIT"), -1);
    least(l.max, number(of_axis, "MAX_LIMIT"), 1);
    least(vmax, number(of_axis, "MAX_VELOCITY"), 1);
    least(amax, number(of_axis, "MAX_ACCELERATION"), 1);
    if (!rotary) least(vmax, number("TRAJ", "MAX_LINEAR_VELOCITY"), 1);
    if (!rotary) least(amax, number("TRAJ", "MAX_LINEAR_ACCELERATION"), 1);
  }
  for (const auto& [value, key] : {std::pair(*vmax, "MAX_VELOCITY"), {*amax, "MAX_ACCELERATION"}})
    if (!(value > 0))
      out_.error("ini_value", span_,
                 std::string(key) + " of joint " + std::to_string(joint) + " or its axis is " +
                     shortest(value) + ", it must be more than 0");
  l.vmax = std::clamp(*vmax, 1e-9, 1e6) * scale;
  l.amax = std::clamp(*amax, 1e-9, 1e6) * scale;
  for (std::optional<double>* end : {&l.min, &l.max}) {
    const double side = end == &l.min ? -1 : 1;
    if (*end) **end *= scale;
    if (*end && std::fabs(**end) > farthest) end->reset();
    if (!rotary && !*end) *end = side * farthest;  // nothing is farther
  }
  if (l.min && l.max && *l.min > *l.max) {
    out_.error("ini_value", span_,
               "the limits of joint " + std::to_string(joint) + " and its axis leave no travel");
    l.max = l.min;
  }
  l.home = number(own, "HOME").value_or(0) * scale;
  const double inside = std::clamp(l.home, l.min.value_or(-farthest), l.max.value_or(farthest));
  if (inside != l.home) {
    const ini::Entry* home = find(own, "HOME");
    out_.warning("ini_not_modelled", home ? home->span : span_,
                 "HOME of joint " + std::to_string(joint) +
                     " is outside of its limits; runs start at the limit");
    l.home = inside;
  }
  return l;
}

Couple ModuleImport::couple(int joint, bool rotary, const Eigen::Vector3d& direction,
                            const std::string& parent) {
  Couple c;
  c.name = "J" + std::to_string(joint);
  c.rotary = rotary;
  c.direction = direction;
  c.parent = parent;
  c.limits = limits(joint, rotary);
  return c;
}

std::optional<HalInput> ModuleImport::input(const std::string& pin) {
  const std::string name = module_ + "." + pin;
  const bool again = !asked_.insert(name).second;
  auto in = hal_.input(name);
  if (!in || again) return in;
  std::string from;
  for (const std::string& what : in->unknown) from += (from.empty() ? "" : ", ") + printable(what);
  if (!from.empty()) unchecked(pin + " comes from " + from + ", whose value no file gives");
  return in;
}

double ModuleImport::plain(const std::string& pin, std::optional<double> usual) {
  const auto in = input(pin);
  if (in && in->unknown.empty()) return in->value;
  if (usual) return *usual;
  if (!in) error("no HAL file of the set-up gives " + module_ + "." + pin + " (setp)");
  return 0;
}

double ModuleImport::length(const std::string& pin, std::optional<double> usual) {
  return plain(pin, usual) * unit_mm_;
}

Eigen::Vector3d ModuleImport::point(const std::string& pins) {
  return {length(pins + ".x", {}), length(pins + ".y", {}), length(pins + ".z", {})};
}

bool ModuleImport::gets_tool_length(const std::string& pin) {
  const auto in = input(pin);
  return in && in->tool_length;
}

void ModuleImport::leave_out(const std::vector<int>& joints, const std::string& letters) {
  if (joints.empty()) return;
  std::string which;
  for (const int joint : joints) which += (which.empty() ? "" : ", ") + std::to_string(joint);
  out_.add({Severity::info,
            "ini_not_modelled",
            "joints " + which + " of " + module_ + " are not part of the machine that is moved" +
                (letters.empty() ? "" : ", so words " + letters + " are refused"),
            span_,
            {},
            {}});
}

void ModuleImport::leave_out_from(int first) {
  std::vector<int> rest;
  for (int joint = first; joint < joints_; ++joint) rest.push_back(joint);
  leave_out(rest);
}

std::optional<Eigen::Vector3d> ModuleImport::home_point() const {
  if (const ini::Entry* entry = find("TRAJ", "HOME")) {
    const std::vector<std::string> words = words_of(entry->value);
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    bool good = words.size() >= 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
      const auto value = ini::number_of(words[i]);
      good = value.has_value();
      p[static_cast<int>(i)] = value.value_or(0) * unit_mm_;
    }
    if (good) return p;
  }
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  bool said = false;
  for (int i = 0; i < 3; ++i) {
    const ini::Entry* entry = find(std::string("AXIS_") + static_cast<char>('X' + i), "HOME");
    const auto value = entry ? ini::number_of(entry->value) : std::nullopt;
    said = said || value;
    p[i] = value.value_or(0) * unit_mm_;
  }
  return said ? std::optional(p) : std::nullopt;
}

// What the HAL files say to the module and nothing here asked for.
void ModuleImport::tell_unused() {
  const std::vector<ModuleRow> rows = all_modules();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const ModuleRow& r) { return r.name == module_; });
  for (const auto& [pin, span] : hal_.pins(module_ + ".")) {
    const std::string word = " " + pin.substr(module_.size() + 1) + " ";
    if (asked_.contains(pin) || row->harmless.find(word) != std::string_view::npos) continue;
    out_.warning("ini_not_modelled", span,
                 "what " + printable(pin) + " gets is not understood here");
    result_.unchecked.push_back("the HAL line for " + printable(pin) + " was not understood");
  }
}

// net … motion.analog-out-03 => motion.switchkins-type: M68 E3 Q1 takes the second model.
void ModuleImport::switching() {
  constexpr std::string_view output = "motion.analog-out-";
  const std::string pin = "motion.switchkins-type";
  for (const package::DriveText& drive : text_.drives()) result_.models.push_back(drive.name);
  const auto from = hal_.driver(pin);
  if (from && from->starts_with(output)) {
    constexpr double last = 63;
    const auto number = parse_number(from->substr(output.size()));
    if (number && *number >= 0 && *number <= last)
      result_.switch_output = static_cast<int>(*number);
  }
  const bool fed = from || !hal_.pins(pin).empty();
  if (fed && !result_.switch_output)
    result_.unchecked.push_back(pin +
                                ", which switches the kinematics, is not driven by an "
                                "analog output of the program");
}

void ModuleImport::speed() {
  const auto high = number("SPINDLE_0", "MAX_FORWARD_VELOCITY");
  const auto low = number("SPINDLE_0", "MIN_FORWARD_VELOCITY");
  if (high && *high > 0 && *high < 1e7)
    text_.spindle_speed(std::clamp(low.value_or(0), 0.0, *high), *high);
}

void ModuleImport::run(const ini::Entry& kinematics) {
  span_ = kinematics.span;
  parameters(kinematics);
  count_joints();
  const std::vector<ModuleRow> rows = all_modules();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const ModuleRow& r) { return r.name == module_; });
  if (row == rows.end()) {
    std::vector<std::string> names;
    std::string known;
    for (const ModuleRow& r : rows) {
      names.emplace_back(r.name);
      known += (known.empty() ? "" : ", ") + names.back();
    }
    out_.error("ini_kinematics", kinematics.span,
               "the kinematics module '" + printable(module_) + "' is not known here." +
                   did_you_mean(module_, names) + " Known are " + known);
    return;
  }
  if (joints_ == 0) return;
  row->write(*this);
  speed();
  switching();
  tell_unused();
  result_.toml = text_.text();
}

Expected<std::optional<MachineImport>> import_machine(const std::string& path, SourceMap& sources,
                                                      Diagnostics& out) {
  const auto text = sources.open(path);
  if (!text) return unexpected(text.error());
  const Folder folder(path);
  Diagnostics read;  // read_setup() tells what is wrong with the lines themselves
  const ini::IniFile ini = ini::read_ini(**text, folder.reader(sources), read);
  const ini::Entry* kinematics = ini.find("KINS", "KINEMATICS");
  if (!kinematics) return std::optional<MachineImport>();
  Hal hal(ini, out);
  HalFiles files(ini, folder, sources, out);
  files.read(hal);
  MachineImport result;
  ModuleImport import(ini, hal, unit_of(ini), out, result);
  import.run(*kinematics);
  const std::vector<ModuleRow> rows = all_modules();
  const std::string name = words_of(kinematics->value).front();
  const bool has_pins = std::any_of(rows.begin(), rows.end(), [&](const ModuleRow& row) {
    return row.name == name && row.has_pins;
  });
  for (const std::string& file : files.not_read())
    if (has_pins)
      result.unchecked.push_back("the HAL file '" + printable(file) +
                                 "', which may set the kinematics, was not read");
  if (out.errors() == 0) return std::optional(std::move(result));
  const auto first = std::find_if(out.list().begin(), out.list().end(), [](const Diagnostic& d) {
    return d.severity == Severity::error;
  });
  return unexpected(*first);
}

}  // namespace aircut::linuxcnc
