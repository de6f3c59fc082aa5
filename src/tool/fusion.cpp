// Tool libraries of Fusion: { "data": [ tool, … ] }. A tool has `type`, `unit`, `geometry` (DC
// diameter, LCF flutes, LB from the tip to the holder, SFDM shank, RE corner radius, SIG point
// angle, TA half angle, NOF teeth, HAND right), `shaft` and `holder` as lists of cones from below
// up, and its number under `post-process`. What lies above a holder's gauge length is inside the
// spindle.
#include <algorithm>
#include <cmath>

#include "tool/keys.h"
#include "tool/library.h"

namespace aircut::tool {
namespace {

constexpr double most_number = 99'999'999;

double unit_of(const Json& object, double otherwise) {
  const std::string unit = text_at(object, "unit");
  if (unit == "inches") return 25.4;
  if (unit == "millimeters") return 1;
  return otherwise;
}

/// Cones from `z` up to at most `top`; nothing when one has no size.
std::optional<Profile> cones(const Json& segments, double unit, double z, double top) {
  Profile out;
  if (!segments.is_array()) return std::nullopt;
  for (const Json& segment : segments) {
    const auto height = number_at(segment, "height");
    const auto low = number_at(segment, "lower-diameter");
    const auto high = number_at(segment, "upper-diameter");
    if (!height || !low || !high || !(*height >= 0) || !(*low >= 0) || !(*high >= 0))
      return std::nullopt;
    const double end = z + *height * unit;
    if (z >= top || !(end <= largest_length)) break;
    const double part = end > top ? (top - z) / (end - z) : 1;
    out.push_back({*low * unit / 2, z});
    out.push_back({(*low + part * (*high - *low)) * unit / 2, std::min(end, top)});
    z = end;
  }
  return out;
}

/// The kind of cutter in the words of tools.toml and its own keys; empty: not known.
std::string cutter_of(const Json& tool, double unit, Draft& draft) {
  const Json& geometry = at(tool, "geometry");
  const auto mm = [&](const char* key) {
    const auto value = number_at(geometry, key);
    return value ? std::optional(*value * unit) : std::nullopt;
  };
  const std::string type = text_at(tool, "type");
  const double corner = mm("RE").value_or(0), lean = number_at(geometry, "TA").value_or(0);
  if (type == "flat end mill" || type == "reamer" || type == "tap right hand" ||
      type == "tap left hand" || type == "counter bore" || type == "slot mill")
    return "flat";
  if (type == "ball end mill") return "ball";
  if (type == "face mill" && lean > 0) return "";
  if (type == "face mill" && corner == 0) return "flat";
  if (type == "bull nose end mill" || type == "face mill") {
    draft.length("corner_radius", corner);
    return "bull";
  }
  if (type == "chamfer mill") {
    draft.angle("point_angle", 2 * lean);
    draft.length("tip_diameter", mm("tip-diameter"));
    return "chamfer";
  }
  if (type == "drill" || type == "spot drill") {
    draft.angle("point_angle", number_at(geometry, "SIG"));
    return "drill";
  }
  return "";
}

std::optional<Tool> read_one(const Json& json, const SourceSpan& span, Diagnostics& out) {
  const double unit = unit_of(json, 0);
  const Json &geometry = at(json, "geometry"), &post = at(json, "post-process");
  const auto fail = [&](const std::string& message) {
    out.add(make_error(kind_of_errors, span, message));
    return std::nullopt;
  };
  const auto number = number_at(post, "number");
  const std::string name = text_at(json, "description");
  const std::string who = "tool \"" + printable(name) + "\"";
  if (!number || *number != std::floor(*number) || *number < 1 || *number > most_number)
    return fail(who + " needs \"post-process\": { \"number\": … }, a whole number from 1 on");
  if (unit == 0) return fail(who + " needs \"unit\": \"millimeters\" or \"inches\"");
  const auto mm = [&](const char* key) {
    const auto value = number_at(geometry, key);
    return value ? std::optional(*value * unit) : std::nullopt;
  };
  Draft draft(static_cast<int>(*number), name, span);
  draft.kind(cutter_of(json, unit, draft));
  const auto flutes = mm("LCF"), body = mm("LB"), shank = mm("SFDM");
  draft.length("diameter", mm("DC"));
  draft.length("flute_length", flutes);
  draft.length("stick_out", body ? body : mm("OAL"));
  if (shank && *shank > 0) draft.length("shank_diameter", shank);
  if (const auto teeth = number_at(geometry, "NOF"); teeth && *teeth >= 1 && *teeth <= 1000)
    draft.whole("teeth", static_cast<int>(*teeth));
  const Json& hand = at(geometry, "HAND");
  if ((hand.is_boolean() && !hand.get<bool>()) || text_at(json, "type") == "tap left hand")
    draft.word("hand", "left");

  const Json& holder = at(json, "holder");
  const double holder_unit = unit_of(holder, unit);
  const auto gauge = number_at(holder, "gaugeLength");
  const auto outline = cones(at(holder, "segments"), holder_unit, 0,
                             gauge && *gauge > 0 ? *gauge * holder_unit : largest_length);
  if (outline && outline->size() >= 2)
    draft.holder(*outline);
  else
    draft.unknown("its holder");
  auto tool = draft.read(out);
  if (!tool || tool->pieces.empty()) return tool;

  // A shaft of its own takes the place of the plain one.
  const double stick_out = body ? *body : mm("OAL").value_or(0);
  const double from = std::max(flutes.value_or(0), mm("shoulder-length").value_or(0));
  auto shaft = cones(at(at(json, "shaft"), "segments"), unit, from, stick_out);
  if (!shaft || shaft->size() < 2) return tool;
  const double wide = std::max(0.0, mm("shoulder-diameter").value_or(tool->diameter)) / 2;
  if (from > tool->flute_length) {
    const Profile shoulder = {{wide, tool->flute_length}, {wide, from}};
    shaft->insert(shaft->begin(), shoulder.begin(), shoulder.end());
  }
  if (shaft->back().z < stick_out) {
    const double radius = shank && *shank > 0 ? *shank / 2 : shaft->back().r;
    const double z = shaft->back().z;
    shaft->push_back({radius, z});
    shaft->push_back({radius, stick_out});
  }
  std::erase_if(tool->pieces, [](const Piece& p) { return p.role == PieceRole::shank; });
  tool->pieces.insert(tool->pieces.begin() + 1, {PieceRole::shank, "shank", std::move(*shaft)});
  return tool;
}

}  // namespace

Expected<ToolTable> read_fusion(const SourceText& text, Diagnostics& out) {
  Diagnostics found;
  ToolTable table;
  const auto list = tool_list(text, "data");
  if (!list) {
    out.add(list.error());
    return unexpected(list.error());
  }
  const Json& data = *list;
  const Places places(text, "data");
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (text_at(data[i], "type") == "holder") continue;  // a holder by itself
    add_tool(table, read_one(data[i], places[i], found), found);
  }
  for (const Diagnostic& d : found.list()) out.add(d);
  return finish(std::move(table), found);
}

}  // namespace aircut::tool
