// The tree of bodies: measured matrices, or rods and beams made from their geometry. Matrices are
// checked and repaired in their own axes, before they are turned into the machine's.
#include <algorithm>
#include <cmath>

#include "accuracy/rods.h"
#include "accuracy/setup_keys.h"

namespace aircut::accuracy {
namespace {

void warn(Table& table, const char* kind, const std::string& key, std::string message) {
  Diagnostic d = make_error(kind, table.span(key), std::move(message));
  d.severity = Severity::warning;
  table.report(std::move(d));
}

// A matrix after the repairs that the file asks for.
Mat3 checked_matrix(Table& table, const std::string& key, const std::string& body, double unit,
                    SetupReading& reading) {
  const auto given = matrix3(table, key);
  if (!given) return Mat3::Zero();
  const Repair& repair = reading.setup.settings.repair;
  std::vector<std::string> changes;
  const Mat3 A = repaired(*given * unit, repair, changes);
  for (const std::string& change : changes)
    reading.setup.changes.push_back("body " + quoted(body) + ", " + key + ": " + change);
  const Passivity p = passivity(A);
  const std::string values = shortest(p.eigenvalues[0] / unit);
  if (!p.passive() && repair.policy == SignPolicy::check)
    table.report(make_error(
        "not_passive", table.span(key),
        quoted(key) + " of body " + quoted(body) +
            " would give back more than was put in: its symmetric part has the eigenvalue " +
            values + ". Check the signs of the probe and the load, or choose a sign_policy"));
  else if (!p.passive())
    warn(table, "matrix_suspect", key,
         quoted(key) + " of body " + quoted(body) +
             " is used although it is not passive: its symmetric part has the eigenvalue " +
             values);
  if (p.asymmetry > 0.5)
    warn(table, "matrix_suspect", key,
         quoted(key) + " of body " + quoted(body) + " is far from symmetric (" +
             fixed(p.asymmetry, 2) + "); the loads and readings may be mixed up");
  return A;
}

Compliance read_compliance(Table& table, const std::string& body, SetupReading& reading) {
  Compliance out;
  if (!table.has("e"))
    table.error("e", "body " + quoted(body) + " needs 'e', 'rod', 'steps' or 'beam'");
  out.e = checked_matrix(table, "e", body, per_micro, reading);
  out.xi = checked_matrix(table, "xi", body, per_micro, reading);
  if (const auto coupling = matrix3(table, "coupling")) out.c = *coupling * coupling_unit;
  if (!reading.setup.settings.angular) {
    out.xi.setZero();
    out.c.setZero();
  }
  return out;
}

std::optional<Mat3> rotation(Table& table) {
  const auto R = matrix3(table, "R");
  if (!R) return std::nullopt;
  if ((R->transpose() * *R - Mat3::Identity()).norm() <= 1e-9 && R->determinant() > 0) return R;
  table.report(make_error("not_a_rotation", table.span("R"),
                          "'R' is no rotation: its columns must be unit vectors at right angles "
                          "that turn right-handed"));
  return std::nullopt;
}

Body measured_body(Table& table, const std::string& name, SetupReading& reading) {
  Body body;
  body.compliance = read_compliance(table, name, reading);
  if (auto second = table.table("parallel")) {
    const Compliance other = read_compliance(*second, name, reading);
    if (const auto both = in_parallel(body.compliance, other))
      body.compliance = *both;
    else
      table.report(make_error("support_not_invertible", table.span("parallel"),
                              "two supports share a load only when both give way in every "
                              "direction: 'e' and 'xi' of each must be invertible"));
  }
  const auto R = rotation(table);
  body.compliance = rotated(body.compliance, R.value_or(Mat3::Identity()));
  const auto base = vector3(table, "base_point");
  if (table.has("xi") && !base && !table.has("coupling"))
    warn(
        table, "base_point_missing", "xi",
        "body " + quoted(name) +
            " turns but has no 'base_point': the machine's origin is taken, which is rarely right");
  body.base_point = base.value_or(Vec3::Zero());
  return body;
}

Rod read_rod(Table& table, bool single) {
  Rod rod;
  rod.clamp = vector3(table, "clamp").value_or(Vec3::Zero());
  rod.axis = unit_vector(table, "axis").value_or(Vec3::UnitZ());
  rod.poisson = table.number("poisson", 0.3);
  if (!(rod.poisson >= 0 && rod.poisson < 0.5))
    range_error(table, "poisson", "Poisson's ratio is at least 0 and below 0.5");
  if (!single) return rod;
  rod.length = positive(table, "length");
  rod.diameter = positive(table, "diameter") * table.number("flute_factor", 1);
  rod.youngs_modulus = positive(table, "E");
  if (!(rod.diameter > 0)) range_error(table, "flute_factor", "'flute_factor' is above 0");
  return rod;
}

Body beam_body(Table& table) {
  Beam beam;
  beam.clamp = vector3(table, "clamp").value_or(Vec3::Zero());
  beam.axis = unit_vector(table, "axis").value_or(Vec3::UnitZ());
  const std::string held = table.choice("held", {"chuck", "chuck_centre", "centres"}, "chuck");
  beam.held = held == "chuck"          ? Held::chuck
              : held == "chuck_centre" ? Held::chuck_centre
                                       : Held::centres;
  beam.e_clamp = table.number("e_clamp", 0) * per_micro;
  beam.e_centre = table.number("e_centre", 0) * per_micro;
  for (const char* key : {"e_clamp", "e_centre"})
    if (table.number(key, 0) < 0) range_error(table, key, quoted(key) + " is at least 0 µm/N");
  const auto section = [&](Table piece) {
    Beam one = round_beam(positive(piece, "length"), positive(piece, "diameter"),
                          positive(piece, "E"), Held::chuck);
    one.sections[0].end += beam.length();
    beam.sections.push_back(one.sections[0]);
  };
  if (table.has("sections"))
    for (Table& piece : table.tables("sections")) section(piece);
  else
    section(table);
  if (beam.sections.empty()) table.error("sections", "'sections' needs at least one piece");
  Body body;
  body.beam = beam;
  return body;
}

// The bodies that one table describes: one, or one per step of a rod.
std::vector<Body> bodies_of(Table& table, const std::string& name, SetupReading& reading) {
  if (auto rod = table.table("rod")) return {rod_body(read_rod(*rod, true))};
  if (auto beam = table.table("beam")) return {beam_body(*beam)};
  if (!table.has("steps")) return {measured_body(table, name, reading)};
  const Rod first = read_rod(table, false);
  std::vector<RodStep> steps;
  for (Table& step : table.tables("steps"))
    steps.push_back({positive(step, "length"), positive(step, "diameter"), positive(step, "E")});
  if (steps.empty()) {
    table.error("steps", "'steps' needs at least one piece");
    return {Body{}};
  }
  return stepped_bodies(first, steps);
}

double band(Table& table) {
  const double epsilon = table.number("epsilon", 0);
  if (!(epsilon >= 0 && epsilon < 2))
    range_error(table, "epsilon", "'epsilon' is the full width of a relative band: 0 … 2");
  return epsilon;
}

// Names → indices; a body of a stepped rod that is nearer the clamp has no name of its own.
void link_parents(std::vector<std::pair<Table, int>>& roots, SetupReading& reading) {
  for (auto& [table, index] : roots) {
    if (!table.has("parent")) continue;
    if (const auto parent = reading.body(table, "parent"))
      reading.setup.bodies[static_cast<std::size_t>(index)].parent = *parent;
  }
  std::vector<int> parents;
  for (const Body& body : reading.setup.bodies) parents.push_back(body.parent);
  const auto order = parents_first(parents);
  for (auto& [table, index] : roots) {
    if (std::find(order.begin(), order.end(), index) == order.end()) {
      table.report(make_error("body_tree", table.span("parent"),
                              "the parents go round in a circle and never reach the ground"));
      break;
    }
    const int parent = reading.setup.bodies[static_cast<std::size_t>(index)].parent;
    if (parent != ground && reading.setup.bodies[static_cast<std::size_t>(parent)].beam)
      table.report(make_error("body_tree", table.span("parent"),
                              "a beam carries no other body: its points move differently"));
  }
}

}  // namespace

void read_bodies(Table& top, SetupReading& reading) {
  std::vector<std::pair<Table, int>> roots;  // the body of a table that hangs on its parent
  std::vector<bool> base_on_parent;
  for (Table& table : top.tables("bodies")) {
    const std::string name = table.required_text("name");
    if (reading.body_index.contains(name))
      table.report(make_error("body_tree", table.span("name"),
                              "there are two bodies named " + quoted(name)));
    // A whole run reads these: which link of the machine carries the body and its base point.
    const std::string own_link = table.text("link", "");
    const bool on_parent = table.choice("base_on", {"body", "parent"}, "body") == "parent";
    const int first = static_cast<int>(reading.setup.bodies.size());
    const double epsilon = band(table);
    for (Body& body : bodies_of(table, name, reading)) {
      body.name = name;
      if (body.parent != ground) body.parent += first;
      reading.setup.bodies.push_back(body);
      reading.setup.epsilon.push_back(epsilon);
      reading.setup.links.push_back(own_link);
      reading.setup.link_places.push_back(table.span(table.has("link") ? "link" : "name"));
      base_on_parent.push_back(on_parent);
    }
    table.know("parent");
    roots.emplace_back(table, first);
    reading.body_index[name] = static_cast<int>(reading.setup.bodies.size()) - 1;
  }
  if (reading.setup.bodies.size() > most_bodies)
    range_error(top, "bodies", "a set-up has at most " + std::to_string(most_bodies) + " bodies");
  if (reading.setup.bodies.empty())
    top.error("bodies", "the set-up needs at least one [[bodies]]: an elastic part of the machine");
  link_parents(roots, reading);
  // A joint that is fixed to its parent stays with the parent's link.
  const std::vector<std::string> own = reading.setup.links;
  for (std::size_t b = 0; b < own.size(); ++b)
    if (const int parent = reading.setup.bodies[b].parent; base_on_parent[b])
      reading.setup.links[b] = parent == ground ? "" : own[static_cast<std::size_t>(parent)];
}

}  // namespace aircut::accuracy
