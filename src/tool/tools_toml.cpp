// tools.toml: a library of tools with solids, and the files of holders that it names.
//
//        +-----+      gauge face, z = gauge length
//        |hold-|
//        |er   |
//        +-+ +-+      z = stick-out: where the tool leaves the holder
//          | |        shank
//          | |
//          |/|        z = flute length
//          |/|        cutter
//          +-+        tip, z = 0
//
// The pieces are stacked so that they touch: the cutter up to its flute length, a neck if there is
// one, the shank up to the stick-out, the holder up to the gauge face. Keys: docs/tools.md.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "config/config.h"
#include "tool/insert.h"
#include "tool/keys.h"
#include "tool/tool.h"

namespace aircut::tool {
namespace {

using config::Reader;
using config::Table;

constexpr double gauge_tolerance = 0.5;  // mm, between length offset and gauge length
constexpr int largest_number = 99'999'999;
constexpr int most_teeth = 1000;

/// A holder: its outline from the lower face, z = 0, to the gauge face.
struct Holder {
  std::string name;
  Profile outline;
  double height() const { return outline.back().z; }
};

/// What all readers of one file share.
struct Context {
  double unit_mm = 1;
  const SourceReader& holders;
  Diagnostics& found;  ///< of the holders' files
  std::map<std::string, std::optional<Holder>> known_holders = {};
};

double read_unit(Table& top) {
  return top.choice("units", {"mm", "inch"}, "mm") == "inch" ? 25.4 : 1;
}

// ---- holders ---------------------------------------------------------------------------------

bool is_file_name(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  };
  return !name.empty() && name.size() <= 100 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), plain);
}

std::optional<Holder> read_holder_file(const SourceText& text, const std::string& name,
                                       Diagnostics& out) {
  Reader reader(text, kind_of_errors);
  Table top = reader.top();
  Holder holder;
  holder.name = name;
  const auto schema = top.integer("schema");
  if (schema && *schema != 1) top.error("schema", "this program reads schema 1 only");
  top.text("name");  // for people
  auto outline = read_profile(top, "profile", read_unit(top));
  const Diagnostics found = reader.finish();
  for (const Diagnostic& d : found.list()) out.add(d);
  if (!outline || found.errors() > 0) return std::nullopt;
  holder.outline = std::move(*outline);
  return holder;
}

/// The holder that a tool names, read once per library; an error at the key when there is none.
const Holder* find_holder(Context& context, Lengths& in, const std::string& name) {
  if (!is_file_name(name)) {
    in.fail("holder", "'holder' needs the name of a file in holders/, without folder and .toml");
    return nullptr;
  }
  auto known = context.known_holders.find(name);
  if (known == context.known_holders.end()) {
    std::optional<Holder> holder;
    if (const auto text = context.holders(name))
      holder = read_holder_file(**text, name, context.found);
    else
      in.fail("holder", "holder '" + name + "' can't be read: " + text.error().message);
    known = context.known_holders.emplace(name, std::move(holder)).first;
  } else if (!known->second) {
    in.fail("holder", "holder '" + name + "' is not usable, see the error about its file");
  }
  return known->second ? &*known->second : nullptr;
}

// ---- assembly --------------------------------------------------------------------------------

Profile cylinder(double radius, double from, double to) { return {{radius, from}, {radius, to}}; }

Profile shifted(const Profile& outline, double z) {
  Profile out = outline;
  for (ProfilePoint& p : out) p.z += z;
  return out;
}

/// How far the tool stands out of its holder: `stick_out`, or `gauge_length` less the holder.
std::optional<double> read_stick_out(Lengths& in, double holder_height) {
  const auto stick_out = in.optional("stick_out", false);
  const auto gauge = in.optional("gauge_length", false);
  if (!in.good()) return std::nullopt;
  if (!stick_out && !gauge) {
    in.fail("stick_out",
            "'stick_out' is missing: the length from the tip to the holder (or 'gauge_length')");
    return std::nullopt;
  }
  const double from_gauge = gauge.value_or(0) - holder_height;
  if (!stick_out && from_gauge <= 0) {
    in.fail("gauge_length", "'gauge_length' is not more than the holder's height, " +
                                fixed(holder_height, 3) + " mm");
    return std::nullopt;
  }
  if (stick_out && gauge && std::abs(*stick_out - from_gauge) > 1e-3) {
    in.fail("gauge_length", "'gauge_length' is not 'stick_out' and the holder's height together, " +
                                fixed(*stick_out + holder_height, 3) + " mm");
    return std::nullopt;
  }
  return stick_out ? stick_out : from_gauge;
}

/// Neck and shank between the cutter's top and the holder.
void add_shank(Lengths& in, Tool& tool, double from, double stick_out) {
  const auto neck = in.optional("neck_diameter", false);
  const auto neck_end = in.optional("neck_length", false);
  const double shank = in.optional("shank_diameter", false).value_or(neck.value_or(tool.diameter));
  if (neck_end && !neck) in.fail("neck_length", "'neck_length' needs 'neck_diameter' too");
  if (!in.good()) return;
  if (neck) {
    const double end = neck_end.value_or(stick_out);
    if (end < from - same_length)
      return in.fail("neck_length", "'neck_length' (from the tip) ends below the flutes");
    if (end > stick_out + same_length)
      return in.fail("neck_length", "'neck_length' (from the tip) reaches into the holder");
    if (end > from + same_length) {
      tool.pieces.push_back({PieceRole::shank, "neck", cylinder(*neck / 2, from, end)});
      from = end;
    }
  }
  if (stick_out > from + same_length)
    tool.pieces.push_back({PieceRole::shank, "shank", cylinder(shank / 2, from, stick_out)});
}

void assemble(Context& context, Lengths& in, const std::string& kind, Tool& tool) {
  Table& table = in.table();
  // Not unknown keys when an error keeps us from reading them.
  for (const char* key :
       {"stick_out", "gauge_length", "neck_diameter", "neck_length", "shank_diameter"})
    table.know(key);
  auto cutter = read_cutter(in, kind);
  const bool has_holder = table.has("holder");
  const auto holder_name = table.text("holder");
  const Holder* holder = holder_name ? find_holder(context, in, *holder_name) : nullptr;
  const auto length = in.optional("length", false);
  if (!cutter || !in.good() || (has_holder && !holder)) return;
  const double holder_height = holder ? holder->height() : 0;
  const auto stick_out = read_stick_out(in, holder_height);
  const double top = cutter->outline.back().z;
  tool.diameter = cutter->diameter;
  tool.flute_length = top;
  tool.pieces.push_back({PieceRole::cutter, "cutter", std::move(cutter->outline)});
  if (!stick_out) return;
  if (top > *stick_out + same_length)
    in.fail(table.has("flute_length") ? "flute_length" : "stick_out",
            "the cutter is " + fixed(top, 3) +
                " mm long, but the tool stands out of its holder by " + fixed(*stick_out, 3) +
                " mm only");
  if (length && *length < *stick_out - same_length)
    in.fail("length", "'length' is less than the tool's part below the holder, " +
                          fixed(*stick_out, 3) + " mm");
  add_shank(in, tool, top, *stick_out);
  if (holder)
    tool.pieces.push_back({PieceRole::holder, "holder", shifted(holder->outline, *stick_out)});
  tool.gauge_length = *stick_out + holder_height;
}

/// `offset = { z = 120.5, x = … }`; z is the gauge length when it is not given.
void read_offset(Context& context, Lengths& in, Tool& tool) {
  tool.offset[Axis::z] = tool.gauge_length;
  auto table = in.table().table("offset");
  if (!table) return;
  for (const Axis axis : all_axes) {
    const std::string key(1, static_cast<char>(letter(axis) + ('a' - 'A')));
    if (const auto value = table->number(key))
      tool.offset[axis] = *value * (is_rotary(axis) ? radians_per_degree : in.unit_mm());
  }
  if (in.good() && tool.gauge_length > 0 &&
      std::abs(tool.offset[Axis::z] - tool.gauge_length) > gauge_tolerance) {
    Diagnostic warning = make_error(kind_of_errors, table->span("z"),
                                    "the length offset " + fixed(tool.offset[Axis::z], 3) +
                                        " mm differs from the tool's gauge " + "length " +
                                        fixed(tool.gauge_length, 3) +
                                        " mm: the control would move the tip elsewhere");
    warning.severity = Severity::warning;
    context.found.add(std::move(warning));
  }
}

/// `teeth` and the limits of a cut. Angles in degrees, the removal in cm³ or cubic inches a minute.
void read_limits(Lengths& in, Tool& tool) {
  const auto teeth = in.table().integer("teeth");
  if (teeth && (*teeth < 1 || *teeth > most_teeth))
    in.fail("teeth", "'teeth' needs a whole number from 1 to " + std::to_string(most_teeth));
  else if (teeth)
    tool.teeth = static_cast<int>(*teeth);
  tool.limits.depth = in.optional("max_depth", false).value_or(0);
  tool.limits.width = in.optional("max_width", false).value_or(0);
  tool.limits.angle = in.angle("max_engagement", 0, 360).value_or(0);
  tool.limits.chip_load = in.optional("max_chip_load", false).value_or(0);
  if (tool.limits.chip_load > 0 && !in.table().has("teeth"))
    in.fail("max_chip_load", "'max_chip_load' needs 'teeth' too");
  if (const auto removal = in.table().number("max_removal")) {
    if (!(*removal > 0)) in.fail("max_removal", "'max_removal' needs more than 0");
    const double cube = in.unit_mm() == 1 ? 1000 : in.unit_mm() * in.unit_mm() * in.unit_mm();
    tool.limits.removal = *removal * cube / 60;
  }
}

/// One of `[[tool.block]]`: what holds an insert.
std::optional<Block> read_block(Table table, double unit_mm) {
  Block block;
  block.role = table.choice("role", {"holder", "shank"}, "holder") == "shank" ? PieceRole::shank
                                                                              : PieceRole::holder;
  block.name = table.text("name", block.role == PieceRole::shank ? "shank" : "holder");
  const auto outline = table.number_lists("outline", 2);
  const auto y = table.numbers("y", 2);
  const auto fail = [&](const char* key, const std::string& message) {
    table.error(key, message);
    return std::nullopt;
  };
  if (!table.has("outline"))
    return fail("outline", "'outline' is missing: it needs corners [[x, z], ...]");
  if (!table.has("y")) return fail("y", "'y' is missing: it needs [low, high]");
  if (!outline || !y) return std::nullopt;
  block.y_low = (*y)[0] * unit_mm;
  block.y_high = (*y)[1] * unit_mm;
  if (!(block.y_low < block.y_high)) return fail("y", "'y' needs [low, high], low less than high");
  double farthest = std::max(std::abs(block.y_low), std::abs(block.y_high));
  for (const auto& point : *outline) {
    block.outline.push_back({point[0] * unit_mm, point[1] * unit_mm});
    for (const double value : block.outline.back()) farthest = std::max(farthest, std::abs(value));
  }
  if (farthest > largest_length) return fail("outline", "the block is beyond 100 m");
  if (!make_convex(block.outline))
    return fail("outline",
                "'outline' needs at least three corners around a convex shape; a tool "
                "may have several blocks");
  return block;
}

/// A lathe tool: no solid of revolution, but an insert and blocks; the nose circle is its diameter.
void read_turning(Lengths& in, Tool& tool) {
  tool.diameter = 2 * in.optional("nose_radius", true).value_or(0);
  tool.flute_length = in.optional("edge_length", false).value_or(0);
  tool.front_angle = in.angle("front_angle", -360, 720).value_or(0);
  tool.back_angle = in.angle("back_angle", -360, 720).value_or(0);
  const auto orientation = in.table().integer("orientation");
  if (orientation && (*orientation < 0 || *orientation > 9))
    in.fail("orientation", "'orientation' needs a whole number from 0 to 9");
  else if (orientation)
    tool.orientation = static_cast<int>(*orientation);
  const auto thickness = in.optional("thickness", false);
  for (Table& table : in.table().tables("block"))
    if (auto block = read_block(table, in.unit_mm())) tool.blocks.push_back(std::move(*block));
  const bool held = !tool.blocks.empty();
  if (!held && !thickness) return;
  if (!held) tool.unknown = "what holds its insert ([[tool.block]])";
  if (!thickness) tool.unknown = "the thickness of its insert";
  if (!thickness || !in.good()) return;
  const auto insert = insert_of(tool);
  if (!insert) return in.fail("thickness", "the insert has " + insert.error());
  tool.blocks.push_back(insert_block(*insert, *thickness));
}

/// `number`, and `pocket`, which is the number when it is not given.
void read_numbers(Lengths& in, std::set<int>& numbers, Tool& tool) {
  Table& table = in.table();
  const auto number = table.integer("number");
  if (!table.has("number")) table.required_number("number");
  if (number && (*number < 1 || *number > largest_number))
    in.fail("number", "'number' needs a whole number from 1 to " + std::to_string(largest_number));
  else if (number && !numbers.insert(static_cast<int>(*number)).second)
    in.fail("number", "tool " + std::to_string(*number) + " was defined before");
  else if (number)
    tool.number = tool.pocket = static_cast<int>(*number);
  const auto pocket = table.integer("pocket");
  if (pocket && (*pocket < 0 || *pocket > largest_number))
    in.fail("pocket", "'pocket' needs a whole number from 0 to " + std::to_string(largest_number));
  else if (pocket)
    tool.pocket = static_cast<int>(*pocket);
}

Tool read_tool(Context& context, Table table, std::set<int>& numbers) {
  Tool tool;
  tool.span = table.span();
  Lengths in(table, context.unit_mm);
  read_numbers(in, numbers, tool);
  tool.name = table.text("name", "");
  if (!table.has("kind")) table.required_text("kind");
  const std::string kind = table.choice("kind", cutter_kinds(), "");
  if (const auto rpm = table.number("max_rpm")) {
    if (*rpm <= 0) in.fail("max_rpm", "'max_rpm' needs more than 0");
    tool.max_rpm = *rpm;
  }
  tool.center_cutting = table.boolean("center_cutting", true);
  tool.left_hand = table.choice("hand", {"right", "left"}, "right") == "left";
  const bool probe = table.boolean("probe", false);
  if (kind.empty()) {  // which keys it may have is not known then
    for (const std::string& key : table.keys()) table.know(key);
    return tool;
  }
  if (kind == "turning") {
    if (probe) in.fail("probe", "'probe' needs a solid of revolution, not kind = \"turning\"");
    read_turning(in, tool);
  } else {
    read_limits(in, tool);
    assemble(context, in, kind, tool);
  }
  if (probe)
    for (Piece& piece : tool.pieces)
      if (piece.role == PieceRole::cutter) piece.name = probe_name;
  read_offset(context, in, tool);
  return tool;
}

}  // namespace

Expected<ToolTable> read_toml(const SourceText& text, const SourceReader& holders,
                              Diagnostics& out) {
  Reader reader(text, kind_of_errors);
  Table top = reader.top();
  Diagnostics of_holders;
  Context context{.holders = holders, .found = of_holders};
  const auto schema = top.integer("schema");
  if (schema && *schema != 1) top.error("schema", "this program reads schema 1 only");
  context.unit_mm = read_unit(top);
  ToolTable result;
  std::set<int> numbers;
  for (Table& table : top.tables("tool"))
    result.tools.push_back(read_tool(context, table, numbers));

  std::optional<Diagnostic> first;
  for (const Diagnostics& found : {reader.finish(), of_holders}) {
    for (const Diagnostic& d : found.list()) {
      if (d.severity == Severity::error && !first) first = d;
      out.add(d);
    }
  }
  if (first) return unexpected(std::move(*first));
  return result;
}

}  // namespace aircut::tool
