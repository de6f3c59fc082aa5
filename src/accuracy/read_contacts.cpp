// The contacts of a set-up without a program: which tool cuts which work where, and how. Each
// becomes a force that knows its depth. A contact gives one of
//
//   force (and moment)                     numbers, N and N·m
//   t, S, V with feed and normal           turning by the material's law
//   milling = { a_p, a_e, mode, f_t, … }   an end mill; its mean force grows with a_p, the depth
//   drilling / tapping                     force and moment along the feed
#include <cmath>
#include <numbers>

#include "accuracy/cut_force.h"
#include "accuracy/setup_keys.h"

namespace aircut::accuracy {
namespace {

// The law of a tool, else of its work's material.
const Material* material_of(Table& table, const SetupReading& reading,
                            const ContactEntry& contact) {
  const ToolEntry& tool = reading.setup.tools[contact.tool];
  const WorkEntry& work = reading.setup.works[contact.work];
  const std::string& name = tool.law.empty() ? work.material : tool.law;
  if (name.empty()) {
    table.report(make_error("accuracy_reference", table.span("tool"),
                            "tool " + std::to_string(tool.id) +
                                " has no 'law' and its work no 'material': no force is known"));
    return nullptr;
  }
  const auto found = reading.setup.materials.find(name);
  return found == reading.setup.materials.end() ? nullptr : &found->second;  // reported there
}

// Speed in m/min, from V or from a spindle speed and the largest diameter.
double cutting_speed(Table& table, ContactEntry& contact, SetupReading& reading) {
  const Settings& settings = reading.setup.settings;
  contact.diameter = positive_if(table, "diameter").value_or(0);
  const auto V = positive_if(table, "V"), rpm = positive_if(table, "rpm");
  if (const auto changed = reading.changed(contact, "V"); changed && *changed > 0) return *changed;
  if (V) return *V;
  if (!rpm || contact.diameter == 0) {
    table.error("V", "the cutting speed is missing: 'V' in m/min, or 'rpm' and 'diameter'");
    return 1;
  }
  const double of = contact.diameter - (settings.mean_diameter ? contact.t : 0);
  return std::numbers::pi * of * *rpm / 1000;
}

std::optional<Triad> given_triad(Table& table) {
  auto triad = table.table("triad");
  if (!triad) return std::nullopt;
  const auto cut = unit_vector(*triad, "cut"), thrust = unit_vector(*triad, "thrust"),
             feed = unit_vector(*triad, "feed");
  if (cut && thrust && feed) return Triad{*cut, *thrust, *feed};
  triad->error("cut", "'triad' needs the directions 'cut', 'thrust' and 'feed' of the force");
  return std::nullopt;
}

// Out of the material across the feed, in the plane of axis and radius: for outside turning known
// without being told.
std::optional<Vec3> outward(const Vec3& feed, const Vec3& axis, const Vec3& arm) {
  const Vec3 radial = arm - axis * axis.dot(arm);
  if (radial.norm() < 1e-9) return std::nullopt;
  const Vec3 out = radial.normalized();
  const Vec3 normal = out - feed * feed.dot(out);
  if (normal.norm() < 0.1) return std::nullopt;  // a radial feed makes a face: on which side?
  return normal.normalized();
}

std::optional<Triad> triad_of(Table& table, const SetupReading& reading, ContactEntry& contact) {
  auto feed = unit_vector(table, "feed");
  if (auto triad = given_triad(table)) {
    if (contact.normal.isZero()) contact.normal = triad->thrust;
    return triad;
  }
  if (!feed) {
    if (!table.has("feed"))
      table.error("feed",
                  "'feed' is missing: the direction in which the tool moves, as [0, 0, -1]");
    return std::nullopt;
  }
  const WorkEntry& work = reading.setup.works[contact.work];
  const Vec3 arm = contact.contact.point - work.axis_point;
  if (contact.normal.isZero()) {
    const auto normal = outward(*feed, work.axis, arm);
    if (!normal) {
      table.error("normal", "'normal' is missing: the direction out of the material, as [0, 0, 1]");
      return std::nullopt;
    }
    contact.normal = *normal;
  }
  if (std::abs(contact.normal.dot(*feed)) > 1e-6) {
    range_error(table, "normal", "'normal' is at right angles to 'feed'");
    return std::nullopt;
  }
  const auto triad = turning_triad(work.axis, arm, *feed, contact.normal);
  if (!triad) range_error(table, "point", "at the spindle's axis nothing turns, so nothing cuts");
  return triad;
}

void warn_outside(Table& table, const std::string& key, const std::optional<Interval>& valid,
                  double value) {
  if (!valid || valid->holds(value)) return;
  Diagnostic d =
      make_error("law_extrapolated", table.span(key),
                 quoted(key) + " = " + shortest(value) + " is outside of " + shortest(valid->low) +
                     " … " + shortest(valid->high) + ", where the law was measured");
  d.severity = Severity::warning;
  table.report(std::move(d));
}

void read_turning(Table& table, SetupReading& reading, ContactEntry& contact) {
  contact.t = table.required_number("t");
  contact.S = table.required_number("S");
  contact.t = reading.changed(contact, "t").value_or(contact.t);
  contact.S = reading.changed(contact, "S").value_or(contact.S);
  if (contact.t < 0) range_error(table, "t", "a depth is at least 0 mm");
  if (contact.S < 0) range_error(table, "S", "a feed is at least 0 mm/rev");
  contact.V = cutting_speed(table, contact, reading);
  const auto triad = triad_of(table, reading, contact);
  const Material* material = material_of(table, reading, contact);
  if (!triad || !material) return;
  const ToolEntry& tool = reading.setup.tools[contact.tool];
  const double kappa = effective_kappa(tool.kappa, tool.nose_radius, std::max(contact.t, 1e-6));
  const auto laws = turning_laws(*material, kappa);
  if (!laws) {
    table.report(make_error("accuracy_reference", table.span("t"),
                            "the material has no law for turning: 'cut', 'thrust' and 'feed', or "
                            "'kienzle'"));
    return;
  }
  if (material->turning) {
    warn_outside(table, "t", material->turning->valid_t, contact.t);
    warn_outside(table, "S", material->turning->valid_S, contact.S);
    warn_outside(table, "V", material->turning->valid_V, contact.V);
  }
  contact.cut_law = laws->front();
  contact.chip = contact.S * std::sin(kappa);
  contact.source = material->source;
  set_terms(contact.force, *triad, *laws, contact.S, contact.V);
}

// The frame of a milling cut as columns: x along the feed, z up the tool.
std::optional<Mat3> milling_frame(Table& table) {
  const auto x = unit_vector(table, "feed"), z = unit_vector(table, "axis");
  if (!x || !z) {
    if (!table.has("feed") || !table.has("axis"))
      table.error("feed",
                  "milling needs 'feed' and 'axis': the directions of the feed and up the tool");
    return std::nullopt;
  }
  if (std::abs(x->dot(*z)) > 1e-6) {
    range_error(table, "feed", "'feed' is at right angles to the tool's 'axis'");
    return std::nullopt;
  }
  Mat3 out;
  out << *x, z->cross(*x), *z;
  return out;
}

void read_milling(Table& table, SetupReading& reading, ContactEntry& contact) {
  const ToolEntry& tool = reading.setup.tools[contact.tool];
  contact.t = positive(table, "a_p");
  MillingCut cut{.a_p = contact.t, .f_t = positive(table, "f_t"), .phi = {}};
  const std::string mode = table.choice("mode", {"up", "down", "slot"}, "slot");
  const bool peak = table.choice("load", {"mean", "peak"}, "mean") == "peak";
  const double rpm = positive(table, "rpm");
  const auto frame = milling_frame(table);
  const auto a_e = positive_if(table, "a_e");
  const Material* material = material_of(table, reading, contact);
  if (!tool.cutter) {
    table.report(
        make_error("accuracy_reference", table.span("a_p"),
                   "tool " + std::to_string(tool.id) + " needs 'milling': its teeth and size"));
    return;
  }
  const Cutter& cutter = *tool.cutter;
  if (cut.a_p > most_depth * cutter.diameter)
    range_error(table, "a_p", "'a_p' is at most 20 diameters of the cutter");
  cut.a_p = std::min(cut.a_p, most_depth * cutter.diameter);
  if (!a_e && mode != "slot") table.error("a_e", "'a_e' is missing: the radial width of the cut");
  if (a_e && *a_e > cutter.diameter)
    range_error(table, "a_e", "'a_e' is at most the cutter's diameter");
  cut.phi = engagement(cutter.diameter, std::min(a_e.value_or(cutter.diameter), cutter.diameter),
                       mode == "up"     ? MillingMode::up
                       : mode == "down" ? MillingMode::down
                                        : MillingMode::slot);
  if (!material || !frame) return;
  const auto law = edge_law(*material);
  if (!law) {
    table.report(make_error("accuracy_reference", table.span("a_p"),
                            "the material has no law for milling: 'milling' or 'kienzle'"));
    return;
  }
  const MillingLoad load = milling_load(cutter, *law, cut, *frame, peak);
  contact.force = load.force;
  contact.chip = thickest_chip(cut);
  contact.torque = load.torque;
  contact.power = load.mean_torque * rpm * 2 * std::numbers::pi / 60 * 1e-6;
  contact.V = std::numbers::pi * cutter.diameter * rpm / 1000;
  contact.diameter = cutter.diameter;
  contact.source = material->source;
}

void read_drilling(Table& table, SetupReading& reading, ContactEntry& contact, bool tap) {
  const auto feed = unit_vector(table, "feed");
  if (!table.has("feed"))
    table.error("feed", "'feed' is missing: the direction of the drill's feed");
  const double diameter = positive(table, "D");
  const double S = positive(table, tap ? "pitch" : "S");
  const double rpm = positive(table, "rpm");
  const double point = tap ? 118 : table.number("point_angle_deg", 118);
  const double chisel = tap ? 1 : table.number("chisel_factor", 1);
  if (!(point > 0 && point < 180))
    range_error(table, "point_angle_deg", "a point angle is above 0 and below 180 degrees");
  const bool left = table.boolean("counter_clockwise", false);
  const Material* material = material_of(table, reading, contact);
  if (!material || !feed) return;
  if (!material->kienzle) {
    table.report(make_error("accuracy_reference", table.span("D"),
                            "the material has no 'kienzle', which drilling and tapping need"));
    return;
  }
  const AxialCut cut =
      tap ? tapping(*material->kienzle, diameter, S)
          : drilling(*material->kienzle, diameter, S, point * degree, material->feed_ratio, chisel);
  contact.force.fixed = -cut.force * *feed;
  // A drill that goes down turns clockwise seen from above, about +feed; the work holds it back.
  contact.force.moment = (left ? 1 : -1) * cut.moment * *feed;
  contact.S = S;
  contact.V = std::numbers::pi * diameter * rpm / 1000;
  contact.diameter = diameter;
  contact.torque = cut.moment;
  contact.power = cut.moment * rpm * 2 * std::numbers::pi / 60 * 1e-6;
  contact.source = material->source;
}

// Half of the stock's tolerance on a diameter is its allowance on the depth.
void read_allowance(Table& table, SetupReading& reading, ContactEntry& contact) {
  const auto dt = table.number("dt");
  auto stock = table.table("stock");
  if (dt) contact.dt = *dt;
  if (contact.dt < 0) range_error(table, "dt", "an allowance is at least 0 mm");
  if (stock) {
    const double size = positive(*stock, "size");
    const long grade = stock->integer("it_grade").value_or(0);
    const bool face = stock->choice("on", {"diameter", "face"}, "diameter") == "face";
    const auto tolerance =
        grade >= 6 && grade <= 13 ? it_tolerance(size, static_cast<int>(grade)) : std::nullopt;
    if (!tolerance)
      range_error(*stock, "it_grade", "IT grades are known from 6 to 13, for sizes up to 500 mm");
    if (dt) table.error("stock", "give the allowance once: 'dt' or 'stock'");
    contact.dt = tolerance.value_or(0) * (face ? 1 : 0.5);
  }
  contact.dt = reading.changed(contact, "dt").value_or(contact.dt);
  if (contact.dt / 2 > contact.t && contact.t > 0) {
    Diagnostic d = make_error("allowance_clipped", table.span(table.has("dt") ? "dt" : "stock"),
                              "half of the allowance " + shortest(contact.dt) +
                                  " mm is more than the depth: some parts are not cut at all");
    d.severity = Severity::warning;
    table.report(std::move(d));
  }
}

void read_force(Table& table, SetupReading& reading, ContactEntry& contact) {
  if (auto milling = table.table("milling")) return read_milling(*milling, reading, contact);
  if (auto drilling = table.table("drilling"))
    return read_drilling(*drilling, reading, contact, false);
  if (auto tapping = table.table("tapping")) return read_drilling(*tapping, reading, contact, true);
  if (table.has("t")) return read_turning(table, reading, contact);
  const auto force = vector3(table, "force"), moment = vector3(table, "moment");
  if (!table.has("force"))
    table.error(
        "force",
        "the contact has no cut: give 't', 'S' and 'V', or 'milling', 'drilling', 'tapping' "
        "or 'force'");
  contact.force.fixed = force.value_or(Vec3::Zero());
  contact.force.moment = 1e3 * moment.value_or(Vec3::Zero());
}

std::optional<std::size_t> work_of(Table& table, SetupReading& reading) {
  const auto spindle = table.integer("spindle");
  if (!spindle && reading.setup.works.size() == 1) return 0;
  if (spindle)
    if (const auto found = reading.work_index.find(*spindle); found != reading.work_index.end())
      return found->second;
  table.report(make_error(
      "accuracy_reference", table.span("spindle"),
      spindle ? "there is no work on spindle " + std::to_string(*spindle) + " under [[works]]"
              : "'spindle' is missing: which of the [[works]] is cut"));
  return std::nullopt;
}

}  // namespace

void read_contacts(Table& top, SetupReading& reading) {
  for (Table& table : top.tables("contacts")) {
    ContactEntry contact;
    contact.place = table.span();
    if (!table.has("tool"))
      table.error("tool", "'tool' is missing: the number of the tool that cuts");
    const auto id = table.integer("tool");
    std::optional<std::size_t> tool;
    if (id) tool = reading.tool(table, "tool", *id);
    const auto work = work_of(table, reading);
    const auto point = vector3(table, "point");
    if (!table.has("point")) table.error("point", "'point' is missing: where the tool cuts, mm");
    contact.name = table.text("name", id ? "T" + std::to_string(*id) : "");
    if (const auto times = table.numbers("interval_s", 2)) {
      contact.span = Span{(*times)[0], (*times)[1]};
      if (!(contact.span->from < contact.span->to))
        range_error(table, "interval_s", "'interval_s' goes from an earlier to a later time");
    }
    if (contact.span)
      if (const auto start = reading.changed(contact, "start"))
        contact.span = Span{*start, *start + contact.span->to - contact.span->from};
    contact.normal = unit_vector(table, "normal").value_or(Vec3::Zero());
    if (!tool || !work || !point) {
      for (const std::string& key : table.keys()) table.know(key);
      continue;
    }
    contact.tool = *tool;
    contact.work = *work;
    contact.contact = {reading.setup.tools[*tool].body, reading.setup.works[*work].body, *point};
    read_force(table, reading, contact);
    read_allowance(table, reading, contact);
    reading.setup.contacts.push_back(contact);
  }
  if (reading.setup.contacts.size() > most_contacts) {
    range_error(top, "contacts",
                "a set-up has at most " + std::to_string(most_contacts) + " contacts");
    reading.setup.contacts.resize(most_contacts);
  }
}

}  // namespace aircut::accuracy
