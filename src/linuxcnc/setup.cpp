#include <algorithm>
#include <cmath>
#include <numbers>

#include "linuxcnc/folder.h"
#include "linuxcnc/linuxcnc.h"

namespace aircut::linuxcnc {
namespace {

constexpr double radian_per_degree = std::numbers::pi / 180;
constexpr double mm_per_inch = 25.4;

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return text;
}

bool has_small_letter(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

class Reader {
 public:
  Reader(const ini::IniFile& file, const SourceText& text, const Folder& folder, Given given,
         SourceMap& sources, Diagnostics& out)
      : file_(file), text_(text), folder_(folder), given_(given), sources_(sources), out_(out) {}

  Setup read() {
    check_keys(file_, out_);
    units();
    coordinates();
    paths();
    numbers();
    switches();
    tool_change();
    axes();
    remaps();
    startup();
    variables();
    not_modelled();
    return std::move(setup_);
  }

 private:
  // ---- values
  const ini::Entry* find(std::string_view section, std::string_view key) const {
    return file_.find(section, key);
  }
  void error(const ini::Entry& entry, std::string message) {
    out_.error("ini_value", entry.span, entry.key + ": " + std::move(message));
  }
  std::optional<double> number(std::string_view section, std::string_view key) {
    const ini::Entry* entry = find(section, key);
    if (!entry) return std::nullopt;
    const auto value = ini::number_of(entry->value);
    if (!value)
      error(*entry, "'" + printable(entry->value) +
                        "' is not a plain number, so the control takes its default; write the "
                        "number alone, with comments on lines of their own");
    return value;
  }
  std::optional<int> integer(std::string_view section, std::string_view key, int least, int most) {
    const auto value = number(section, key);
    if (!value) return std::nullopt;
    if (*value == std::round(*value) && *value >= least && *value <= most)
      return static_cast<int>(*value);
    error(*find(section, key),
          "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return std::nullopt;
  }
  // Versions of LinuxCNC differ in what they make of YES or TRUE, so only 0 and 1 are taken.
  bool flag(std::string_view section, std::string_view key, bool otherwise) {
    const ini::Entry* entry = find(section, key);
    if (!entry) return otherwise;
    const auto value = ini::number_of(entry->value);
    if (value && *value == std::round(*value)) return *value != 0;
    error(*entry, "'" + printable(entry->value) +
                      "' is read differently by versions of the control; write 0 or 1 alone");
    return otherwise;
  }
  void unchecked(const ini::Entry& entry, const std::string& message) {
    out_.warning("ini_not_modelled", entry.key_span, entry.key + ": " + message);
    setup_.unchecked.push_back(entry.key + " of the set-up is not modelled: " + message);
  }

  // ---- sections
  void units() {
    if (const ini::Entry* entry = find("TRAJ", "LINEAR_UNITS")) {
      const std::string word = lower(entry->value);
      const auto scale = ini::number_of(word);  // units per mm
      if (word == "inch" || word == "in" || word == "imperial" ||
          (scale && std::fabs(*scale * mm_per_inch - 1) < 1e-4))
        setup_.unit_mm = mm_per_inch;
      else if (word != "mm" && word != "metric" && !(scale && *scale == 1))
        error(*entry, "must be mm or inch, this is '" + printable(entry->value) + "'");
    } else {
      out_.warning("ini_not_modelled", {},
                   "the set-up does not say [TRAJ]LINEAR_UNITS; millimetres are assumed");
      setup_.unchecked.push_back("[TRAJ]LINEAR_UNITS is missing; millimetres were assumed");
    }
    if (const ini::Entry* entry = find("TRAJ", "ANGULAR_UNITS")) {
      const std::string word = lower(entry->value);
      const auto scale = ini::number_of(word);
      if (word != "deg" && word != "degree" && !(scale && *scale == 1))
        error(*entry, "only degree is modelled, this is '" + printable(entry->value) + "'");
    }
    interp::Options& options = setup_.options;
    options.machine_unit = setup_.unit_mm == 1 ? canon::Unit::millimetre : canon::Unit::inch;
    options.start_unit = options.machine_unit;
    if (const auto spindles = integer("TRAJ", "SPINDLES", 1, 8)) options.spindles = *spindles;
  }

  void coordinates() {
    AxisSet axes;
    if (const ini::Entry* entry = find("TRAJ", "COORDINATES")) {
      for (const char c : entry->value) {
        if (c == ' ' || c == '\t') continue;
        if (const auto axis = axis_of_letter(c >= 'a' ? static_cast<char>(c - 32) : c))
          axes.add(*axis);
        else
          return error(*entry, "holds letters of axes (X Y Z A B C U V W), '" +
                                   printable(std::string(1, c)) + "' is none");
      }
    }
    if (axes.empty())
      for (const Axis axis : all_axes) axes.add(axis);
    setup_.options.axes = axes;
  }

  void paths() {
    if (const ini::Entry* entry = find("DISPLAY", "PROGRAM_PREFIX"))
      add_folder(*entry, entry->value);
    if (const ini::Entry* entry = find("RS274NGC", "SUBROUTINE_PATH")) {
      for (std::size_t at = 0; at <= entry->value.size();) {
        const std::size_t end = std::min(entry->value.find(':', at), entry->value.size());
        if (end > at) add_folder(*entry, entry->value.substr(at, end - at));
        at = end + 1;
      }
    }
    if (!given_.parameters)
      if (const ini::Entry* entry = find("RS274NGC", "PARAMETER_FILE"))
        setup_.parameter_file = parameters_of(*entry);
    if (given_.tools) return;
    if (const ini::Entry* entry = find("EMCIO", "TOOL_TABLE")) setup_.tool_table = tools_of(*entry);
    if (const ini::Entry* entry = find("EMCIO", "DB_PROGRAM")) {
      out_.warning("not_executed", entry->span,
                   "the tool table comes from a program, which is never run here; give a table "
                   "with -t FILE");
      setup_.unchecked.push_back("the program of DB_PROGRAM, which holds the tools, was not run");
    }
  }
  void add_folder(const ini::Entry& entry, const std::string& name) {
    auto path = folder_.resolve(name, true);
    if (path) return setup_.options.sub_path.push_back(*path);
    // The control passes over a folder that is not there.
    Diagnostic d = path.error();
    d.severity = Severity::warning;
    d.kind = d.kind == "path_refused" ? "path_refused" : "ini_ignored";
    d.message =
        entry.key + ": " + d.message + "; subs in it are not found, --sub-path adds folders";
    d.span = entry.span;
    out_.add(std::move(d));
  }
  // A parameter file that is not there is one that the control has not written yet: it begins with
  // zeros. A folder in its place is a mistake.
  std::string parameters_of(const ini::Entry& entry) {
    if (const auto path = folder_.resolve(entry.value, false)) return *path;
    if (!folder_.lacks(entry.value)) return file_refused(entry, "--var", "the parameters");
    out_.add({Severity::info,
              "ini_ignored",
              entry.key + ": there is no '" + printable(entry.value) +
                  "', so parameters start at 0; --var FILE names a file",
              entry.span,
              {},
              {}});
    return {};
  }
  std::string tools_of(const ini::Entry& entry) {
    const auto path = folder_.resolve(entry.value, false);
    return path ? *path : file_refused(entry, "-t", "the tool table");
  }
  // The job goes on without the file, as the control does, and can't be verified.
  std::string file_refused(const ini::Entry& entry, const std::string& option,
                           const std::string& what) {
    Diagnostic d = folder_.resolve(entry.value, false).error();
    d.severity = Severity::warning;
    d.message = entry.key + ": " + d.message + "; " + option + " FILE names another";
    d.span = entry.span;
    out_.add(std::move(d));
    setup_.unchecked.push_back(what + " of the set-up could not be read (" +
                               printable(entry.value) + "); " + option + " FILE names another");
    return {};
  }

  // A tolerance outside its range is told by the control too, which goes on with its default.
  void arc_tolerance(std::string_view key, double least, double& value) {
    const auto given = number("RS274NGC", key);
    if (!given) return;
    if (*given >= least && *given < value) {
      value = *given;
      return;
    }
    const ini::Entry& entry = *find("RS274NGC", key);
    out_.warning("ini_ignored", entry.span,
                 entry.key + ": must be from " + shortest(least) + " to below " + shortest(value) +
                     "; the control takes " + shortest(value));
  }

  void numbers() {
    interp::Options& options = setup_.options;
    arc_tolerance("CENTER_ARC_RADIUS_TOLERANCE_INCH", 0.00004, options.arc_tolerance_inch);
    arc_tolerance("CENTER_ARC_RADIUS_TOLERANCE_MM", 0.001, options.arc_tolerance);
    options.g64_tolerance = length("G64_DEFAULT_TOLERANCE");
    options.g64_naive_tolerance = length("G64_DEFAULT_NAIVETOLERANCE");
    for (const char* prefix : {"", "PARAMETER_"}) {
      if (const auto c = length(std::string(prefix) + "G73_PECK_CLEARANCE"))
        options.g73_clearance = *c;
      if (const auto c = length(std::string(prefix) + "G83_PECK_CLEARANCE"))
        options.g83_clearance = *c;
    }
    if (const auto offset = number("RS274NGC", "ORIENT_OFFSET")) options.orient_offset = *offset;
  }
  std::optional<double> length(const std::string& key) {
    const auto value = number("RS274NGC", key);
    if (!value) return std::nullopt;
    if (*value >= 0) return *value * setup_.unit_mm;
    error(*find("RS274NGC", key), "can't be negative");
    return std::nullopt;
  }

  void switches() {
    interp::Options& options = setup_.options;
    options.keep_g92 = !flag("RS274NGC", "DISABLE_G92_PERSISTENCE", false);
    options.fanuc_subs = !flag("RS274NGC", "DISABLE_FANUC_STYLE_SUB", false);
    options.g54_at_end = !flag("RS274NGC", "DISABLE_AUTO_G54", false);
    options.ini_variables = flag("RS274NGC", "INI_VARS", true);
    options.hal_pins = flag("RS274NGC", "HAL_PIN_VARS", true);
    options.retain_length_offset = flag("RS274NGC", "RETAIN_G43", false);
    options.count_arguments = flag("RS274NGC", "OWORD_NARGS", false);
  }

  void tool_change() {
    interp::Options& options = setup_.options;
    setup_.random_tool_changer = flag("EMCIO", "RANDOM_TOOLCHANGER", false);
    options.tool_change_at_g30 = flag("EMCIO", "TOOL_CHANGE_AT_G30", false);
    options.tool_change_quill_up = flag("EMCIO", "TOOL_CHANGE_QUILL_UP", false);
    options.tool_change_with_spindle = flag("EMCIO", "TOOL_CHANGE_WITH_SPINDLE_ON", false);
    const ini::Entry* entry = find("EMCIO", "TOOL_CHANGE_POSITION");
    if (!entry) return;
    std::vector<double> values;
    for (std::size_t at = 0; at < entry->value.size();) {
      const std::size_t from = entry->value.find_first_not_of(" \t", at);
      if (from == std::string::npos) break;
      at = std::min(entry->value.find_first_of(" \t", from), entry->value.size());
      const auto value = ini::number_of(entry->value.substr(from, at - from));
      if (!value || values.size() == 9) {
        values.clear();
        break;
      }
      values.push_back(*value);
    }
    if (values.size() != 3 && values.size() != 6 && values.size() != 9)
      return error(*entry, "takes 3, 6 or 9 plain numbers: X Y Z, A B C, U V W");
    AxisSet axes;
    AxisValues position;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Axis axis = all_axes[i];
      axes.add(axis);
      position[axis] = values[i] * scale_of(axis);
    }
    options.tool_change_position = {axes, position};
  }

  double scale_of(Axis axis) const { return is_rotary(axis) ? radian_per_degree : setup_.unit_mm; }

  void axes() {
    for (const Axis axis : all_axes) {
      const std::string section = std::string("AXIS_") + letter(axis);
      Travel travel;
      if (const auto value = number(section, "MIN_LIMIT")) {
        travel.min = *value * scale_of(axis);
        travel.min_span = find(section, "MIN_LIMIT")->span;
      }
      if (const auto value = number(section, "MAX_LIMIT")) {
        travel.max = *value * scale_of(axis);
        travel.max_span = find(section, "MAX_LIMIT")->span;
      }
      if (travel.min && travel.max && *travel.min > *travel.max)
        error(*find(section, "MIN_LIMIT"), "is above MAX_LIMIT");
      else if (setup_.options.axes.has(axis) && (travel.min || travel.max))
        setup_.travel[axis] = travel;
      const bool wrapped = flag(section, "WRAPPED_ROTARY", false);
      const auto joint = integer(section, "LOCKING_INDEXER_JOINT", -1, 15);
      if (is_rotary(axis)) {
        if (wrapped) setup_.options.wrapped.add(axis);
        // The control takes joint 0 for none.
        if (joint && *joint > 0) setup_.options.indexers.add(axis);
      } else if (wrapped || joint) {
        out_.warning("ini_ignored", file_.section(section)->span,
                     "WRAPPED_ROTARY and LOCKING_INDEXER_JOINT mean nothing for a linear axis");
      }
    }
  }

  void remaps() {
    for (const ini::Entry* entry : file_.all("RS274NGC", "REMAP")) {
      auto remap = read_remap(entry->value, entry->span, out_);
      if (!remap) continue;
      auto& known = setup_.options.remaps;
      if (std::any_of(known.begin(), known.end(),
                      [&](const interp::Remap& other) { return other.name == remap->name; })) {
        out_.error("ini_remap", entry->span, remap->name + " is remapped before; remove one line");
        continue;
      }
      if (!remap->python.empty())
        out_.warning("not_executed", entry->span,
                     remap->name + " runs Python on the control (" + printable(remap->python) +
                         "), which is never run here; programs that use it can't be verified");
      known.push_back(std::move(*remap));
    }
  }

  void startup() {
    const ini::Entry* entry = find("RS274NGC", "RS274NGC_STARTUP_CODE");
    if (!entry) return;
    SourceSpan& span = setup_.options.startup_line;
    const std::string_view line = entry->span.text->content().substr(entry->span.begin);
    if (line.substr(0, line.find_first_of("\r\n")).starts_with(entry->value) &&
        entry->span.covered() == entry->value) {
      span = entry->span;
    } else {  // continued over several lines
      const SourceText& text = sources_.add(text_.name() + ": start-up code", entry->value);
      span = {&text, 0, static_cast<std::uint32_t>(entry->value.size()), 1};
    }
    setup_.options.startup = span.text;
  }

  // #<_ini[section]key> looks for names in capitals and takes plain numbers.
  void variables() {
    for (const ini::Section& section : file_.sections()) {
      if (has_small_letter(section.name)) continue;
      for (const ini::Entry& entry : section.entries) {
        if (has_small_letter(entry.key) || file_.find(section.name, entry.key) != &entry) continue;
        if (const auto value = ini::number_of(entry.value))
          setup_.options.ini[section.name + "/" + entry.key] = *value;
      }
    }
  }

  void not_modelled() {
    if (const ini::Entry* entry = find("RS274NGC", "ON_ABORT_COMMAND"))
      out_.add({Severity::info,
                "ini_not_modelled",
                "ON_ABORT_COMMAND: what the control does after an abort is not simulated",
                entry->key_span,
                {},
                {}});
    if (flag("RS274NGC", "OWORD_WARNONLY", false))
      out_.add({Severity::info,
                "ini_not_modelled",
                "OWORD_WARNONLY: mistakes in O-words stay errors here; the control goes on after "
                "some of them with a state that nobody can foresee",
                find("RS274NGC", "OWORD_WARNONLY")->key_span,
                {},
                {}});
    if (flag("RS274NGC", "NO_DOWNCASE_OWORD", false))
      unchecked(*find("RS274NGC", "NO_DOWNCASE_OWORD"),
                "names of subs and parameters are case-free here");
    if (const ini::Entry* entry = find("RS274NGC", "FEATURES"))
      out_.warning("ini_ignored", entry->key_span,
                   "FEATURES: the control has keys of their own for this since version 2.8 and "
                   "does not look at it any more");
    for (const ini::Section& section : file_.sections())
      for (const ini::Entry& entry : section.entries)
        if (section.name.starts_with("AXIS_") && entry.key == "OFFSET_AV_RATIO" &&
            ini::number_of(entry.value).value_or(1) != 0)
          unchecked(entry, "offsets that come from pins while a program runs");
  }

  const ini::IniFile& file_;
  const SourceText& text_;
  const Folder& folder_;
  Given given_;
  SourceMap& sources_;
  Diagnostics& out_;
  Setup setup_;
};

}  // namespace

Expected<Setup> read_setup(const std::string& path, Given given, SourceMap& sources,
                           Diagnostics& out) {
  const auto text = sources.open(path);
  if (!text) return unexpected(text.error());
  const Folder folder(path);
  const ini::IniFile file = ini::read_ini(**text, folder.reader(sources), out);
  return Reader(file, **text, folder, given, sources, out).read();
}

const std::vector<KindText>& kinds() {
  static const std::vector<KindText> all = {
      {"hal_line", "a line of a HAL file that is not understood",
       "Warning: HAL files are read for what they say to the kinematics; nothing of them is run. "
       "Example: `source other.hal`."},
      {"hal_value", "a value of a HAL file that is no number",
       "A pin that sets a length or an angle of the kinematics needs a plain number. Example: "
       "`setp "
       "pumakins.A2 4OO`."},
      {"ini_ignored", "something in a set-up file that the control passes over",
       "Warning. The control would go on with its default. Example: "
       "CENTER_ARC_RADIUS_TOLERANCE_MM = 1."},
      {"ini_key", "a key or section of a set-up file that looks misspelt",
       "Warning. The control looks at names it knows, in capitals. Example: `WRAPED_ROTARY = 1`."},
      {"ini_kinematics", "a set-up whose machine can't be made",
       "KINEMATICS names a module that is not known here, or the set-up or its HAL files do not "
       "say "
       "what the module needs. A machine package of your own does without "
       "(docs/machine-package.md). "
       "Example: `KINEMATICS = mykins`."},
      {"ini_not_modelled", "something in a set-up file that is not simulated",
       "Warning when it can change what the machine does: the verdict is then unknown. Example: "
       "`OFFSET_AV_RATIO = 0.5`."},
      {"ini_remap", "a REMAP line that the control refuses",
       "It needs a code that may be remapped, a modal group, and ngc= or python=. Example: `REMAP "
       "= M400 modalgroup=3 ngc=probe`."},
      {"ini_value", "a value of a set-up file that can't be used",
       "Numbers stand alone, without a comment behind them; switches are 0 or 1. Example: "
       "`RETAIN_G43 = yes`."},
  };
  return all;
}

}  // namespace aircut::linuxcnc
