// The kinds of cutters of tools.toml (docs/tools.md): their keys, and the outline each one makes.
#include <algorithm>
#include <cmath>
#include <map>

#include "tool/cutter.h"
#include "tool/keys.h"

namespace aircut::tool {
namespace {

double widest(const Profile& outline) {
  double diameter = 0;
  for (const ProfilePoint& p : outline) diameter = std::max(diameter, 2 * p.r);
  return diameter;
}

/// Names the key of the file for a parameter of the APT form.
std::optional<Cutter> from_apt(Lengths& in, const Apt& apt, double diameter,
                               const std::map<std::string, std::string>& keys) {
  if (!in.good()) return std::nullopt;
  auto outline = apt_outline(apt);
  if (outline) return Cutter{std::move(*outline), diameter};
  const auto key = keys.find(outline.error().key);
  in.fail(key != keys.end() ? key->second : outline.error().key, outline.error().message);
  return std::nullopt;
}

const std::map<std::string, std::string>& simple_keys() {
  static const std::map<std::string, std::string> keys = {
      {"d", "diameter"},      {"r", "corner_radius"}, {"e", "corner_radius"},
      {"f", "corner_radius"}, {"b", "taper_angle"},   {"h", "flute_length"}};
  return keys;
}

/// flat, ball, bull: a straight cutter with a corner radius from 0 to the cutter's radius.
std::optional<Cutter> straight_cutter(Lengths& in, const std::string& kind) {
  const double diameter = in.required("diameter"), flutes = in.required("flute_length");
  double corner = kind == "ball" ? diameter / 2 : 0;
  if (kind == "bull") {
    corner = in.required("corner_radius");
    if (in.good() && corner > diameter / 2)
      in.fail("corner_radius", "'corner_radius' can't be more than half of the diameter");
  }
  return from_apt(in, apt_with_corner(diameter, corner, 0, 0, flutes), diameter, simple_keys());
}

/// taper: leans outwards (or inwards, a dovetail) by taper_angle from a tip that is flat
/// (tip_diameter), rounded at its corner, or a ball of corner_radius.
std::optional<Cutter> taper_cutter(Lengths& in) {
  const double flutes = in.required("flute_length");
  const double b = in.required_angle("taper_angle", -90, 90);
  const double corner = in.optional("corner_radius", true).value_or(0);
  const auto tip = in.optional("tip_diameter", true);
  const auto diameter = in.optional("diameter", false);
  if (!in.good()) return std::nullopt;
  // The ball at the tip: the lower line is level, e = 0, so d/2 = r (1 − sin b) / cos b.
  const double ball = 2 * corner * (1 - std::sin(b)) / std::cos(b);
  const double d = tip.value_or(ball);
  if (!(d > 0)) {
    in.fail("tip_diameter", "a taper needs 'tip_diameter' or, for a ball tip, 'corner_radius'");
    return std::nullopt;
  }
  const Apt apt = apt_with_corner(d, corner, 0, b, flutes);
  auto cutter = from_apt(in, apt, d, simple_keys());
  if (cutter) cutter->diameter = diameter.value_or(widest(cutter->outline));
  return cutter;
}

/// drill, chamfer: a cone of point_angle up to the diameter, with a flat tip if tip_diameter is
/// given, then straight.
std::optional<Cutter> pointed_cutter(Lengths& in) {
  const double diameter = in.required("diameter"), flutes = in.required("flute_length");
  const double half = in.required_angle("point_angle", 0, 180) / 2;
  const double tip = in.optional("tip_diameter", true).value_or(0);
  if (!in.good()) return std::nullopt;
  const double cone = (diameter - tip) / 2 / std::tan(half);
  if (!(tip < diameter)) {
    in.fail("tip_diameter", "'tip_diameter' must be less than the diameter");
    return std::nullopt;
  }
  if (cone > flutes + same_length) {
    in.fail("flute_length",
            "'flute_length' is shorter than the point, which is " + fixed(cone, 3) + " mm high");
    return std::nullopt;
  }
  Cutter cutter{{}, diameter};
  append_point(cutter.outline, 0, 0);
  append_point(cutter.outline, tip / 2, 0);
  append_point(cutter.outline, diameter / 2, cone);
  append_point(cutter.outline, diameter / 2, std::max(flutes, cone));
  return cutter;
}

/// lollipop: a ball on a neck. Its flute length is the height at which the neck begins.
std::optional<Cutter> lollipop_cutter(Lengths& in) {
  const double diameter = in.required("diameter"), neck = in.required("neck_diameter");
  if (in.good() && neck >= diameter)
    in.fail("neck_diameter", "'neck_diameter' must be less than the diameter");
  if (!in.good()) return std::nullopt;
  Cutter cutter{{}, diameter};
  append_point(cutter.outline, 0, 0);
  append_arc(cutter.outline, 0, diameter / 2, diameter / 2, -std::numbers::pi / 2,
             std::acos(neck / diameter));
  return cutter;
}

/// profile: any outline, from the tip up.
std::optional<Cutter> profile_cutter(Lengths& in) {
  const auto outline = read_profile(in.table(), "profile", in.unit_mm());
  const auto diameter = in.optional("diameter", false);
  if (!outline) return std::nullopt;
  return Cutter{*outline, diameter.value_or(widest(*outline))};
}

/// apt: the seven parameters themselves, `apt = { d, r, e, f, a, b, h }`, angles in degrees.
std::optional<Cutter> apt_cutter(Lengths& in) {
  auto table = in.table().table("apt");
  if (!table) {
    in.fail("apt", "'apt' is missing: it needs { d, r, e, f, a, b, h }");
    return std::nullopt;
  }
  Apt apt;
  bool good = true;
  const auto read = [&](const char* key, double& value, double scale) {
    if (!table->has(key)) table->required_number(key);
    const auto number = table->number(key);
    good = good && number && std::abs(*number * scale) <= largest_length;
    if (number && std::abs(*number * scale) > largest_length)
      table->error(key, std::string("'") + key + "' is beyond 100 m");
    value = number.value_or(0) * scale;
  };
  for (const auto& [key, value] :
       {std::pair{"d", &apt.d}, {"r", &apt.r}, {"e", &apt.e}, {"f", &apt.f}, {"h", &apt.h}})
    read(key, *value, in.unit_mm());
  read("a", apt.a, radians_per_degree);
  read("b", apt.b, radians_per_degree);
  if (!good) return std::nullopt;
  auto outline = apt_outline(apt);
  if (!outline) {
    table->error(outline.error().key, outline.error().message);
    return std::nullopt;
  }
  const double diameter = widest(*outline);
  return Cutter{std::move(*outline), diameter};
}

}  // namespace

const std::vector<std::string>& cutter_kinds() {
  static const std::vector<std::string> kinds = {
      "flat", "ball", "bull", "taper", "drill", "chamfer", "lollipop", "profile", "apt", "turning"};
  return kinds;
}

std::optional<Cutter> read_cutter(Lengths& in, const std::string& kind) {
  if (kind == "taper") return taper_cutter(in);
  if (kind == "drill" || kind == "chamfer") return pointed_cutter(in);
  if (kind == "lollipop") return lollipop_cutter(in);
  if (kind == "profile") return profile_cutter(in);
  if (kind == "apt") return apt_cutter(in);
  return straight_cutter(in, kind);
}

}  // namespace aircut::tool
