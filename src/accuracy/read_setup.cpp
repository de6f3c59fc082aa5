// The set-up file from the top: settings, materials, tools, works, scatter, limits, sizes. Bodies
// and contacts have files of their own.
#include <algorithm>
#include <cmath>

#include "accuracy/setup_keys.h"

namespace aircut::accuracy {

std::string quoted(const std::string& name) { return "'" + printable(name) + "'"; }

void range_error(Table& table, const std::string& key, const std::string& message) {
  table.report(make_error("accuracy_range", table.span(key), message));
}

double positive(Table& table, const std::string& key) {
  const double value = table.required_number(key);
  if (table.has(key) && !(value > 0)) range_error(table, key, quoted(key) + " is above 0");
  return value > 0 ? value : 1;  // after an error: any value that keeps the rest readable
}

std::optional<double> positive_if(Table& table, const std::string& key) {
  table.know(key);
  if (!table.has(key)) return std::nullopt;
  return positive(table, key);
}

std::optional<Vec3> vector3(Table& table, const std::string& key) {
  const auto list = table.numbers(key, 3);
  if (!list) return std::nullopt;
  return Vec3((*list)[0], (*list)[1], (*list)[2]);
}

std::optional<Vec3> unit_vector(Table& table, const std::string& key) {
  const auto v = vector3(table, key);
  if (!v) return std::nullopt;
  if (const double size = v->norm(); size > 1e-9 && std::isfinite(size)) return *v / size;
  range_error(table, key, quoted(key) + " needs a direction, this has no length");
  return std::nullopt;
}

std::optional<Mat3> matrix3(Table& table, const std::string& key) {
  const auto rows = table.number_lists(key, 3);
  if (!rows) return std::nullopt;
  if (rows->size() != 3) {
    table.error(key, quoted(key) + " needs 3 rows of 3 numbers, this has " +
                         std::to_string(rows->size()) + " rows");
    return std::nullopt;
  }
  Mat3 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      out(r, c) = (*rows)[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
  return out;
}

std::optional<double> SetupReading::changed(const ContactEntry& contact, const std::string& key) {
  const auto node = what_if.contacts.extract({contact.name, key});
  if (node.empty()) return std::nullopt;
  return node.mapped();
}

std::optional<int> SetupReading::body(Table& table, const std::string& key) {
  const std::string name = table.required_text(key);
  const auto found = body_index.find(name);
  if (found != body_index.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, index] : body_index) names.push_back(known);
  if (table.has(key))
    table.report(make_error(key == "parent" ? "body_tree" : "accuracy_reference", table.span(key),
                            "there is no body " + quoted(name) + "." + did_you_mean(name, names)));
  return std::nullopt;
}

const Material* SetupReading::material(Table& table, const std::string& key,
                                       const std::string& name) {
  const auto found = setup.materials.find(name);
  if (found != setup.materials.end()) return &found->second;
  std::vector<std::string> names;
  for (const auto& [known, value] : setup.materials) names.push_back(known);
  table.report(
      make_error("accuracy_reference", table.span(key),
                 "there is no material " + quoted(name) + "." + did_you_mean(name, names)));
  return nullptr;
}

std::optional<std::size_t> SetupReading::tool(Table& table, const std::string& key, long id) {
  const auto found = tool_index.find(id);
  if (found != tool_index.end()) return found->second;
  table.report(make_error("accuracy_reference", table.span(key),
                          "there is no tool " + std::to_string(id) + " under [[tools]]"));
  return std::nullopt;
}

namespace {

PowerTerm power_term(Table table) {
  PowerTerm term;
  term.C = positive(table, "C");
  term.x = table.number("x", 1);
  term.y = table.number("y", 1);
  term.z = table.number("z", 0);
  term.K = table.number("K", 1);
  if (term.x < 0) range_error(table, "x", "the exponent of the depth is at least 0");
  if (!(term.y > 0)) range_error(table, "y", "the exponent of the feed is above 0");
  if (!(term.K > 0)) range_error(table, "K", "a correction factor is above 0");
  return term;
}

std::optional<Interval> interval(Table& table, const std::string& key) {
  const auto list = table.numbers(key, 2);
  if (!list) return std::nullopt;
  if ((*list)[0] < (*list)[1]) return Interval{(*list)[0], (*list)[1]};
  range_error(table, key, quoted(key) + " goes from a smaller to a larger number");
  return std::nullopt;
}

std::optional<TurningLaw> turning_law(Table& table, const std::string& source) {
  auto cut = table.table("cut"), thrust = table.table("thrust"), feed = table.table("feed");
  auto valid = table.table("valid");
  if (!cut && !thrust && !feed) return std::nullopt;
  TurningLaw law;
  law.source = source;
  if (!cut || !thrust || !feed) {
    table.error("cut", "a power law needs all of 'cut', 'thrust' and 'feed'");
    return std::nullopt;
  }
  law.cut = power_term(*cut);
  law.thrust = power_term(*thrust);
  law.feed = power_term(*feed);
  if (valid) {
    law.valid_t = interval(*valid, "t");
    law.valid_S = interval(*valid, "S");
    law.valid_V = interval(*valid, "V");
  }
  return law;
}

Material read_material(Table& table) {
  Material out;
  out.source = table.text("source", "not stated");
  out.turning = turning_law(table, out.source);
  if (auto kienzle = table.table("kienzle")) {
    out.kienzle = KienzleTerm{positive(*kienzle, "k_c11"), kienzle->number("m_c", 0)};
    if (!(out.kienzle->m >= 0 && out.kienzle->m < 1))
      range_error(*kienzle, "m_c", "'m_c' is at least 0 and below 1");
    out.thrust_ratio = kienzle->number("thrust_ratio", 0.4);
    out.feed_ratio = kienzle->number("feed_ratio", 0.5);
  }
  if (auto milling = table.table("milling"))
    out.milling =
        MillingCoefficients{milling->required_number("K_tc"), milling->required_number("K_rc"),
                            milling->number("K_ac", 0),       milling->number("K_te", 0),
                            milling->number("K_re", 0),       milling->number("K_ae", 0)};
  if (!out.turning && !out.kienzle && !out.milling)
    table.error("cut", "a material needs 'cut', 'thrust' and 'feed', or 'kienzle', or 'milling'");
  return out;
}

Cutter read_cutter(Table& table) {
  Cutter out;
  const long teeth = table.integer("N").value_or(0);
  if (!(teeth >= 1 && teeth <= most_teeth))
    range_error(table, "N", "'N' is the number of teeth, 1 … 200");
  out.teeth = static_cast<int>(std::clamp(teeth, 1L, most_teeth));
  out.diameter = positive(table, "D");
  const double helix = table.number("helix_deg", 0);
  if (!(std::abs(helix) < 85))
    range_error(table, "helix_deg", "a helix is between -85 and 85 degrees");
  out.helix = std::clamp(helix, -85.0, 85.0) * degree;
  const std::string shape = table.choice("shape", {"flat", "ball", "taper"}, "flat");
  out.shape = shape == "ball"    ? Cutter::Shape::ball
              : shape == "taper" ? Cutter::Shape::taper
                                 : Cutter::Shape::flat;
  const double half = table.number("half_angle_deg", 0);
  if (!(half >= 0 && half < 85))
    range_error(table, "half_angle_deg", "a half angle is 0 … 85 degrees");
  out.half_angle = std::clamp(half, 0.0, 85.0) * degree;
  out.counter_clockwise = table.boolean("counter_clockwise", false);
  return out;
}

std::optional<Mode> read_mode(Table& parent) {
  auto table = parent.table("mode");
  if (!table) return std::nullopt;
  Mode out;
  out.frequency = positive(*table, "frequency_Hz");
  out.stiffness = positive(*table, "stiffness_N_um") * 1e3;
  out.damping = positive(*table, "damping");
  if (!(out.damping < 1))
    range_error(*table, "damping", "'damping' is a ratio above 0 and below 1");
  if (!(out.frequency <= 1e5))
    range_error(*table, "frequency_Hz", "a frequency is at most 100000 Hz");
  return out;
}

Drill read_drill(Table& table) {
  Drill out{positive(table, "D"), table.number("point_angle_deg", 118),
            table.number("chisel_factor", 1)};
  if (!(out.point_angle > 0 && out.point_angle < 180))
    range_error(table, "point_angle_deg", "a point angle is above 0 and below 180 degrees");
  out.point_angle *= degree;
  return out;
}

void read_tools(Table& top, SetupReading& reading) {
  for (Table& table : top.tables("tools")) {
    ToolEntry tool;
    if (!table.has("id")) table.error("id", "'id' is missing: it needs the tool's number");
    tool.id = table.integer("id").value_or(0);
    if (reading.tool_index.contains(tool.id))
      table.report(make_error("accuracy_reference", table.span("id"),
                              "there are two tools with the number " + std::to_string(tool.id)));
    tool.body = reading.body(table, "body").value_or(ground);
    if (const auto node = reading.what_if.tool_bodies.extract(tool.id)) {
      const auto found = reading.body_index.find(node.mapped());
      if (found != reading.body_index.end())
        tool.body = found->second;
      else
        table.report(make_error("accuracy_reference", table.span("body"),
                                "there is no body " + quoted(node.mapped())));
    }
    tool.law = table.text("law", "");
    if (!tool.law.empty()) reading.material(table, "law", tool.law);
    const double kappa = table.number("kappa_deg", 90);
    if (!(kappa > 0 && kappa < 180))
      range_error(table, "kappa_deg", "the entering angle is above 0 and below 180 degrees");
    tool.kappa = kappa * degree;
    tool.nose_radius = table.number("nose_radius", 0);
    if (tool.nose_radius < 0) range_error(table, "nose_radius", "'nose_radius' is at least 0 mm");
    if (auto milling = table.table("milling")) tool.cutter = read_cutter(*milling);
    if (auto drill = table.table("drilling")) tool.drill = read_drill(*drill);
    tool.mode = read_mode(table);
    tool.dt = table.number("dt", 0);
    if (tool.dt < 0) range_error(table, "dt", "an allowance is at least 0 mm");
    tool.peak = table.choice("load", {"mean", "peak"}, "mean") == "peak";
    tool.place = table.span("id");
    reading.tool_index[tool.id] = reading.setup.tools.size();
    reading.setup.tools.push_back(tool);
  }
}

void read_works(Table& top, SetupReading& reading) {
  for (Table& table : top.tables("works")) {
    WorkEntry work;
    work.spindle = table.integer("spindle").value_or(0);
    if (reading.work_index.contains(work.spindle))
      table.report(make_error("accuracy_reference", table.span("spindle"),
                              "there are two works on spindle " + std::to_string(work.spindle)));
    work.body = reading.body(table, "body").value_or(ground);
    work.material = table.text("material", "");
    if (!work.material.empty()) reading.material(table, "material", work.material);
    work.axis = unit_vector(table, "axis").value_or(Vec3::UnitZ());
    work.axis_point = vector3(table, "axis_point").value_or(Vec3::Zero());
    work.place = table.span("body");
    reading.work_index[work.spindle] = reading.setup.works.size();
    reading.setup.works.push_back(work);
  }
}

void read_settings(Table& top, Settings& out, const WhatIf& what_if) {
  const std::string given = top.choice(
      "sign_policy", {"check", "as_given", "row_flip", "column_flip", "abs_diagonal"}, "check");
  const std::string policy = what_if.sign_policy.value_or(given);
  out.repair.policy = policy == "as_given"       ? SignPolicy::as_given
                      : policy == "row_flip"     ? SignPolicy::row_flip
                      : policy == "column_flip"  ? SignPolicy::column_flip
                      : policy == "abs_diagonal" ? SignPolicy::abs_diagonal
                                                 : SignPolicy::check;
  out.repair.symmetrize = top.boolean("symmetrize", false);
  out.repair.psd_project = top.boolean("psd_project", false);
  out.angular = what_if.angular.value_or(top.boolean("angular", true));
  out.coupled = what_if.coupled.value_or(top.boolean("coupled", false));
  out.second_order = top.boolean("second_order", false);
  out.mean_diameter = top.choice("speed_diameter", {"outer", "mean"}, "outer") == "mean";
}

double band(Table& table, const std::string& key) {
  const double value = table.number(key, 0);
  if (value >= 0 && value < 2) return value;
  range_error(table, key,
              quoted(key) + " is the full width of a relative band: 0 or more, below 2");
  return 0;
}

void read_scatter(Table& top, Setup& setup) {
  auto table = top.table("scatter");
  if (!table) return;
  ScatterSettings& out = setup.scatter;
  out.bands = {band(*table, "epsilon"), band(*table, "nu")};
  out.exact = table->choice("mode", {"linear", "exact"}, "linear") == "exact";
  out.independent_bodies = table->boolean("independent_bodies", false);
  const auto varying = std::count_if(setup.epsilon.begin(), setup.epsilon.end(),
                                     [](double epsilon) { return epsilon > 0; });
  if (out.independent_bodies && varying > static_cast<std::ptrdiff_t>(most_independent_bodies))
    range_error(*table, "independent_bodies",
                "at most " + std::to_string(most_independent_bodies) +
                    " bodies can have an 'epsilon' of their own");
  if (auto draws = table->table("monte_carlo")) {
    Draws d;
    const long count = draws->integer("count").value_or(10000),
               seed = draws->integer("seed").value_or(1);
    if (!(count >= 1 && count <= most_draws))
      range_error(*draws, "count", "'count' is 1 … 10000000 draws");
    d.count = static_cast<std::size_t>(std::clamp(count, 1L, most_draws));
    d.seed = static_cast<std::uint64_t>(seed);
    d.shape = draws->choice("shape", {"uniform", "normal"}, "uniform") == "normal"
                  ? Draws::Shape::normal
                  : Draws::Shape::uniform;
    out.draws = d;
  }
}

void read_limits(Table& top, Limits& out) {
  auto table = top.table("limits");
  if (!table) return;
  out.cut_force = positive_if(*table, "Fc_N");
  out.power_kW = positive_if(*table, "power_kW");
  out.torque_Nm = positive_if(*table, "torque_Nm");
  out.chip = positive_if(*table, "h_max");
  if (const auto deflection = positive_if(*table, "deflection_um"))
    out.deflection = *deflection * 1e-3;
  out.efficiency = table->number("eta", 1);
  if (out.efficiency > 0 && out.efficiency <= 1) return;
  range_error(*table, "eta", "an efficiency is above 0 and at most 1");
  out.efficiency = 1;
}

SizeKind size_kind(const std::string& word) {
  return word == "outside_diameter" ? SizeKind::outside_diameter
         : word == "bore_diameter"  ? SizeKind::bore_diameter
         : word == "width"          ? SizeKind::width
         : word == "profile"        ? SizeKind::profile
                                    : SizeKind::length;
}

void read_dimensions(Table& top, SetupReading& reading) {
  for (Table& table : top.tables("dimensions")) {
    Dimension out;
    out.name = table.required_text("name");
    out.place = table.span("name");
    out.kind = size_kind(table.choice(
        "kind",
        {"outside_diameter", "bore_diameter", "face", "depth", "length", "width", "profile"},
        "profile"));
    std::vector<double> ids;
    if (out.kind == SizeKind::width) {
      ids = table.numbers("tools", 2).value_or(std::vector<double>());
      if (!table.has("tools")) table.error("tools", "a width needs 'tools': its two tools");
    } else if (const auto id = table.integer("tool")) {
      ids = {static_cast<double>(*id)};
    } else if (!table.has("tool")) {
      table.error("tool", "'tool' is missing: the tool that makes this size");
    }
    for (const double id : ids)
      if (const auto tool = reading.tool(table, out.kind == SizeKind::width ? "tools" : "tool",
                                         std::abs(id) < 1e9 ? std::lround(id) : -1))
        out.tools.push_back(*tool);
    out.nominal = table.number("nominal", 0);
    out.tolerance = interval(table, "tolerance");
    out.compensate = table.boolean("compensate", false);
    if (const auto lines = table.numbers("lines", 2)) {
      out.lines = Interval{(*lines)[0], (*lines)[1]};
      if (!(out.lines->low >= 1 && out.lines->high >= out.lines->low))
        range_error(table, "lines", "'lines' has the first and the last line of the program");
    }
    if (auto at = table.table("at"))
      out.at = {interval(*at, "x"), interval(*at, "y"), interval(*at, "z")};
    reading.setup.dimensions.push_back(out);
  }
}

}  // namespace

void read_materials(Table& top, SetupReading& reading) {
  auto table = top.table("materials");
  if (!table) return;
  for (const std::string& name : table->keys())
    if (auto one = table->table(name)) reading.setup.materials[name] = read_material(*one);
}

std::optional<Setup> read_setup(const SourceText& text, Diagnostics& out, const WhatIf& what_if) {
  config::Reader reader(text, "accuracy_invalid");
  Table top = reader.top();
  SetupReading reading;
  if (top.integer("version").value_or(1) != 1)
    top.error("version", "this program reads version 1 of the set-up");
  read_settings(top, reading.setup.settings, what_if);
  reading.what_if = what_if;
  read_bodies(top, reading);
  read_materials(top, reading);
  reading.setup.mode = read_mode(top);
  read_tools(top, reading);
  read_works(top, reading);
  read_scatter(top, reading.setup);
  read_limits(top, reading.setup.limits);
  read_contacts(top, reading);
  read_dimensions(top, reading);
  for (const auto& [place, value] : reading.what_if.contacts)
    top.report(make_error("usage", "there is no " + quoted(place.first + "." + place.second) +
                                       " to be changed: a contact's name and t, S, V, dt or start, "
                                       "as far as the contact has it"));
  for (const auto& [id, body] : reading.what_if.tool_bodies)
    top.report(make_error("usage", "there is no tool " + std::to_string(id) + " to be moved"));
  const Diagnostics found = reader.finish();
  for (const Diagnostic& d : found.list()) out.add(d);
  if (found.errors() > 0) return std::nullopt;
  return std::move(reading.setup);
}

}  // namespace aircut::accuracy
