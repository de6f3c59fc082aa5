#include "page/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "base/deflate.h"
#include "base/hash.h"
#include "page/assets.h"
#include "page/pack.h"
#include "report/json_items.h"

namespace aircut::page {
namespace {

using report::Json;

constexpr double degrees = 180 / M_PI;
constexpr std::size_t most_program_bytes = 8'000'000;
constexpr std::size_t most_picture_bytes = 3'500'000;  // of all pictures together
// What a slow browser draws while the picture moves.
constexpr std::size_t coarse_stock_triangles = 4'000;
constexpr std::size_t coarse_body_triangles = 400;
constexpr std::size_t most_findings = 1000;

Json json(const Row& row) { return {{"at", row.at}, {"count", row.count}}; }

// A row of numbers in units of `unit`; one number when all are the same.
class Packer {
 public:
  Json numbers(const std::vector<double>& values, double unit) {
    std::vector<std::int64_t> whole;
    whole.reserve(values.size());
    for (const double v : values) whole.push_back(std::llround(v / unit));
    if (!whole.empty() &&
        std::all_of(whole.begin(), whole.end(), [&](std::int64_t v) { return v == whole.front(); }))
      return {{"all", static_cast<double>(whole.front()) * unit}};
    Json out = json(blob_.add(whole));
    out["unit"] = unit;
    return out;
  }
  Json text(std::string_view text) { return json(blob_.add_text(text)); }

  // Positions on a lattice of 1/65535 of the largest side: finer than a pixel at any sensible zoom.
  Json mesh(const TriangleMesh& mesh) {
    const Box3 box = bounds(mesh);
    const double unit = std::max(1e-6, box.sizes().maxCoeff() / 65535);
    std::vector<std::int64_t> corners;
    for (int axis = 0; axis < 3; ++axis)  // axis by axis, so that differences are small
      for (const Vec3& v : mesh.vertices)
        corners.push_back(std::llround((v[axis] - box.min()[axis]) / unit));
    std::vector<std::int64_t> indices;
    for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    return {{"min", {box.min().x(), box.min().y(), box.min().z()}},
            {"unit", unit},
            {"corners", json(blob_.add(corners))},
            {"indices", json(blob_.add(indices))}};
  }
  // The mesh in no more than some triangles; null when it has no more as it is.
  Json coarse(const TriangleMesh& full, std::size_t most) {
    return full.triangles.size() <= most ? Json() : mesh(at_most(full, most));
  }
  std::string bytes() const { return base64(deflated(blob_.bytes())); }

 private:
  Blob blob_;
};

Json matrix(const Pose& pose) {
  Json out = Json::array();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) out.push_back(pose.matrix()(row, column));
  return out;
}

std::string hex(const machine::Color& c) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string out = "#";
  for (const unsigned char v : {c.r, c.g, c.b}) (out += digits[v >> 4]) += digits[v & 15];
  return out;
}

Json body(Packer& packer, const machine::Body& b) {
  return {{"name", utf8(b.name)},
          {"role", machine::to_string(b.role)},
          {"link", index(b.link)},
          {"color", hex(b.color)},
          {"pose", matrix(b.X_LB)},
          {"mesh", packer.mesh(at_most(*b.mesh, most_body_triangles))},
          {"coarse", packer.coarse(*b.mesh, coarse_body_triangles)}};
}

Json bodies(Packer& packer, const Replay& replay) {
  Json out = Json::array();
  for (const machine::Body& b : replay.machine().bodies())
    if (b.mesh) out.push_back(body(packer, b));
  std::set<int> numbers;
  for (const auto& change : replay.tool_times()) numbers.insert(change.number);
  for (const int number : numbers) {
    if (number == 0) continue;
    for (const machine::Body& b : replay.tool_bodies(number)) {
      if (!b.mesh) continue;
      Json item = body(packer, b);
      item["tool"] = number;
      out.push_back(std::move(item));
    }
  }
  return out;
}

Json links(Packer& packer, const Replay& replay) {
  Json out = Json::array();
  const auto tracks = link_tracks(replay);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Json packed = Json::array();
    for (std::size_t k = 0; k < 7; ++k)
      packed.push_back(packer.numbers(tracks[i][k], k < 3 ? 1e-3 : 1e-6));
    out.push_back({{"name", utf8(replay.machine().links()[i].name)}, {"rows", std::move(packed)}});
  }
  return out;
}

template <class List, class Get>
std::vector<double> column(const List& list, const Get& get) {
  std::vector<double> out;
  out.reserve(list.size());
  for (const auto& item : list) out.push_back(static_cast<double>(get(item)));
  return out;
}

Json keys(Packer& packer, const Replay& replay) {
  using Key = Replay::Key;
  const auto& list = replay.keys();
  Json tip = Json::array();
  for (int k = 0; k < 3; ++k)
    tip.push_back(packer.numbers(column(list, [&](const Key& key) { return key.tip[k]; }), 1e-3));
  return {{"count", list.size()},
          {"t", packer.numbers(column(list, [](const Key& k) { return k.t; }), 1e-4)},
          {"tip", std::move(tip)},
          {"feed", packer.numbers(column(list, [](const Key& k) { return k.feed * 60; }), 0.1)},
          {"rapid", packer.numbers(column(list, [](const Key& k) { return k.rapid ? 1 : 0; }), 1)}};
}

Json blocks(Packer& packer, const Replay& replay) {
  using BlockTime = Replay::BlockTime;
  const auto& list = replay.blocks();
  return {
      {"count", list.size()},
      {"left_out", replay.blocks_left_out()},
      {"t", packer.numbers(column(list, [](const BlockTime& b) { return b.t; }), 1e-4)},
      {"line", packer.numbers(column(list, [](const BlockTime& b) { return b.line; }), 1)},
      {"kind", packer.numbers(
                   column(list, [](const BlockTime& b) { return static_cast<int>(b.kind); }), 1)}};
}

Json joints(Packer& packer, const Replay& replay) {
  Json out = Json::array();
  const machine::Machine& machine = replay.machine();
  for (int j = 0; j < machine.joint_count(); ++j) {
    const machine::Joint& joint = machine.joint(machine::JointId{j});
    const bool turns = joint.kind == machine::JointKind::rotary;
    const double unit = turns ? degrees : 1;
    const auto& use = replay.joint_uses()[static_cast<std::size_t>(j)];
    const auto finite = [&](double v) { return std::isfinite(v) ? Json(v * unit) : Json(nullptr); };
    out.push_back(
        {{"name", utf8(joint.name)},
         {"unit", turns ? "°" : "mm"},
         {"min", finite(joint.min)},
         {"max", finite(joint.max)},
         {"low", use.low * unit},
         {"high", use.high * unit},
         {"distance", use.distance * unit},
         {"reversals", use.reversals},
         {"values", packer.numbers(column(replay.keys(),
                                          [&](const Replay::Key& k) { return k.joints[j] * unit; }),
                                   1e-3)}});
  }
  return out;
}

// What the joints were asked for, in percent of their limits; rows without a limit are left out.
Json rates(Packer& packer, const Replay& replay) {
  static constexpr std::array<const char*, Rates::measures> names = {"speed", "acceleration",
                                                                     "jerk"};
  const auto& peaks = replay.rates().peaks();
  Json out = {{"width", peaks.width()}, {"count", peaks.values().size()}};
  for (std::size_t m = 0; m < names.size(); ++m) {
    Json rows = Json::array();
    for (int j = 0; j < replay.machine().joint_count(); ++j) {
      const machine::Joint& joint = replay.machine().joint(machine::JointId{j});
      const double limit = std::array{joint.vmax, joint.amax, joint.jmax}[m];
      if (!(limit > 0) || !std::isfinite(limit)) continue;
      const std::size_t at = static_cast<std::size_t>(j) * names.size() + m;
      const auto share = [&](const Rates::Peaks& p) {
        return at < p.of.size() ? static_cast<double>(p.of[at]) / limit * 100 : 0.;
      };
      rows.push_back({{"name", utf8(joint.name)},
                      {"values", packer.numbers(column(peaks.values(), share), 0.1)}});
    }
    out[names[m]] = std::move(rows);
  }
  return out;
}

Json removal(Packer& packer, const std::optional<sim::Summary::Stock>& stock) {
  if (!stock || stock->removed.values().empty()) return nullptr;
  const double width = stock->removed.width();
  const auto rate = [&](const sim::Volume& v) { return v.value / width * 0.06; };  // cm³/min
  return {{"width", width},
          {"count", stock->removed.values().size()},
          {"values", packer.numbers(column(stock->removed.values(), rate), 0.01)}};
}

Json tools(const Replay& replay) {
  Json uses = Json::array();
  for (const auto& use : replay.tool_uses()) {
    const tool::Tool* tool = replay.tools().find(use.number);
    uses.push_back({{"number", use.number},
                    {"name", tool ? utf8(tool->name) : ""},
                    {"feed_s", use.feed_time},
                    {"rapid_s", use.rapid_time},
                    {"feed_mm", use.feed_length},
                    {"max_feed_mm_per_min", use.max_feed * 60},
                    {"max_rpm", use.max_rpm},
                    {"first_line", use.first_line},
                    {"last_line", use.last_line}});
  }
  Json changes = Json::array();
  for (const auto& change : replay.tool_times())
    changes.push_back({{"t", change.t}, {"number", change.number}});
  return {{"uses", std::move(uses)}, {"changes", std::move(changes)}};
}

Json program(Packer& packer, const Replay& replay) {
  const std::string_view text = replay.program().content();
  const std::string shown = utf8(std::string(text.substr(0, most_program_bytes)));
  return {{"name", utf8(replay.program().name())},
          {"text", packer.text(shown)},
          {"left_out_bytes", text.size() - std::min(text.size(), most_program_bytes)}};
}

// The pictures of the run, as data: the sheet for readers without WebGL, then those of findings.
Json pictures(const PageInput& input) {
  Json out = Json::object();
  std::size_t bytes = 0;
  std::vector<std::string> names;
  for (const sim::Finding& f : input.report.findings)
    if (!f.picture.empty()) names.push_back(f.picture);
  for (const std::string& path : input.report.outputs)
    if (path == "sheet.png" || path.starts_with("accuracy-"))
      names.insert(names.begin() + std::min<std::ptrdiff_t>(1, std::ssize(names)), path);
  for (const std::string& name : names) {
    if (out.contains(utf8(name))) continue;
    std::ifstream file(input.folder + "/" + name, std::ios::binary);
    const std::string png((std::istreambuf_iterator<char>(file)), {});
    if (png.empty() || bytes + png.size() > most_picture_bytes) continue;
    bytes += png.size();
    out[utf8(name)] = "data:image/png;base64," + base64(png);
  }
  return out;
}

// result.json without the findings that nobody would go through in a page.
Json shown_report(const report::RunReport& report) {
  Json out = report::document(report);
  Json& findings = out["findings"];
  const std::size_t more = findings.size() - std::min(findings.size(), most_findings);
  findings.erase(findings.begin() + static_cast<std::ptrdiff_t>(findings.size() - more),
                 findings.end());
  out["findings_left_out"] = more;
  return out;
}

// How the page's policy names the script or style that may be used.
std::string policy_hash(std::string_view text) {
  const std::string hex = sha256(text);
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return base64(bytes);
}

void replace(std::string& text, std::string_view mark, std::string_view by) {
  const std::size_t at = text.find(mark);
  if (at != std::string::npos) text.replace(at, mark.size(), by);
}

}  // namespace

std::string page_html(const PageInput& input) {
  const Replay& replay = input.replay;
  Packer packer;
  Json run = {
      {"report", shown_report(input.report)},
      {"program", program(packer, replay)},
      {"tolerance_mm", replay.tolerance()},
      {"keys", keys(packer, replay)},
      {"blocks", blocks(packer, replay)},
      {"joints", joints(packer, replay)},
      {"rates", rates(packer, replay)},
      {"removal", removal(packer, input.report.summary.stock)},
      {"tools", tools(replay)},
      {"links", links(packer, replay)},
      {"bodies", bodies(packer, replay)},
      {"work",
       {{"link", index(replay.machine().work_link())}, {"pose", matrix(replay.machine().X_LM())}}},
      {"pictures", pictures(input)}};
  Json stages = Json::array();
  for (const StockStage& stage : input.stock)
    stages.push_back({{"t", stage.t},
                      {"mesh", packer.mesh(stage.mesh)},
                      {"coarse", packer.coarse(stage.mesh, coarse_stock_triangles)}});
  run["stock"] = std::move(stages);

  std::string page(asset_page());
  replace(page, "<!--STYLE-HASH-->", policy_hash(asset_style()));
  replace(page, "<!--BUNDLE-HASH-->", policy_hash(asset_bundle()));
  replace(page, "<!--SCRIPT-HASH-->", policy_hash(asset_script()));
  replace(page, "<!--STYLE-->", asset_style());
  replace(page, "<!--RUN-->", report::json_text(run, -1));
  replace(page, "<!--BLOB-->", packer.bytes());
  replace(page, "<!--BUNDLE-->", asset_bundle());
  replace(page, "<!--SCRIPT-->", asset_script());
  return page;
}

}  // namespace aircut::page
