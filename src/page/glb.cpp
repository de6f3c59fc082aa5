// A GLB is a header, a chunk of JSON and a chunk of numbers. The JSON's accessors say what the
// numbers mean; nodes, meshes and the animation's samplers refer to accessors by number.
#include "page/glb.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/text.h"
#include "page/pack.h"
#include "report/json_items.h"

namespace aircut::page {
namespace {

using report::Json;

constexpr int floats = 5126, unsigned_ints = 5125;          // component types of glTF
constexpr int vertex_target = 34962, index_target = 34963;  // buffer view targets
constexpr int lines_mode = 1;

/// The chunk of numbers, and what refers to it.
class Numbers {
 public:
  /// Rows of `width` floats; `bounds` adds the least and the largest of each column.
  int add(const std::vector<float>& values, int width, bool bounds, int target = 0) {
    static constexpr const char* types[] = {"", "SCALAR", "", "VEC3", "VEC4"};
    Json accessor = {{"bufferView", view(values.data(), values.size() * sizeof(float), target)},
                     {"componentType", floats},
                     {"count", values.size() / static_cast<std::size_t>(width)},
                     {"type", types[width]}};
    if (bounds) {
      Json low = Json::array(), high = Json::array();
      for (int column = 0; column < width; ++column) {
        float least = values[static_cast<std::size_t>(column)], most = least;
        for (auto i = static_cast<std::size_t>(column); i < values.size();
             i += static_cast<std::size_t>(width)) {
          least = std::min(least, values[i]);
          most = std::max(most, values[i]);
        }
        low.push_back(least);
        high.push_back(most);
      }
      accessor["min"] = low;
      accessor["max"] = high;
    }
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
  }
  int add_indices(const std::vector<std::uint32_t>& values) {
    accessors_.push_back(
        {{"bufferView", view(values.data(), values.size() * sizeof(std::uint32_t), index_target)},
         {"componentType", unsigned_ints},
         {"count", values.size()},
         {"type", "SCALAR"}});
    return static_cast<int>(accessors_.size()) - 1;
  }

  const std::string& bytes() const { return bytes_; }
  const Json& views() const { return views_; }
  const Json& accessors() const { return accessors_; }

 private:
  int view(const void* data, std::size_t size, int target) {
    Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    views_.push_back(std::move(view));
    bytes_.append(static_cast<const char*>(data), size);  // sizes are multiples of four
    return static_cast<int>(views_.size()) - 1;
  }

  std::string bytes_;
  Json views_ = Json::array(), accessors_ = Json::array();
};

double linear(unsigned char srgb) {
  const double v = srgb / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

class Scene {
 public:
  explicit Scene(const Replay& replay) : replay_(replay) {}

  std::string bytes(std::span<const StockStage> stages) {
    add_links();
    add_bodies(stages);
    add_tools();
    add_path();
    Json root = {{"name", "machine"},
                 {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}},
                 {"scale", {1e-3, 1e-3, 1e-3}},
                 {"children", Json::array()}};
    for (std::size_t i = 0; i < links_; ++i) root["children"].push_back(i);
    nodes_.push_back(std::move(root));
    for (Json& node : nodes_)
      if (node.contains("children") && node["children"].empty()) node.erase("children");

    Json all = {{"asset", {{"version", "2.0"}, {"generator", "aircut"}}},
                {"scene", 0},
                {"scenes", {{{"nodes", {nodes_.size() - 1}}}}},
                {"nodes", nodes_},
                {"meshes", meshes_},
                {"materials", materials_}};
    if (!channels_.empty())
      all["animations"] = {{{"name", "run"}, {"channels", channels_}, {"samplers", samplers_}}};
    all["accessors"] = numbers_.accessors();
    all["bufferViews"] = numbers_.views();
    all["buffers"] = {{{"byteLength", numbers_.bytes().size()}}};
    return packed(report::json_text(all, -1), numbers_.bytes());
  }

 private:
  static void append(std::string& out, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(word >> shift & 0xff);
  }
  static std::string packed(std::string json, const std::string& numbers) {
    json.append((4 - json.size() % 4) % 4, ' ');
    std::string out = "glTF";
    append(out, 2);
    append(out, 12 + 8 + json.size() + 8 + numbers.size());
    append(out, json.size());
    out += "JSON" + json;
    append(out, numbers.size());
    return (out += std::string("BIN\0", 4)) += numbers;
  }

  /// The keys whose times differ as floats, which glTF stores.
  void choose_keys() {
    const auto& keys = replay_.keys();
    std::vector<float> times;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const auto t = static_cast<float>(keys[i].t);
      if (!times.empty() && t <= times.back()) {
        chosen_.back() = i;
        continue;
      }
      times.push_back(t);
      chosen_.push_back(i);
    }
    times_ = numbers_.add(times, 1, true);
  }

  void animate(std::size_t node, const char* path, const char* way, int times, int values) {
    channels_.push_back(
        {{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers_.push_back({{"input", times}, {"interpolation", way}, {"output", values}});
  }

  void add_links() {
    choose_keys();
    const auto tracks = link_tracks(replay_);
    links_ = tracks.size();
    for (std::size_t i = 0; i < links_; ++i) {
      const LinkTrack& track = tracks[i];
      nodes_.push_back({{"name", utf8(replay_.machine().links()[i].name)},
                        {"translation", {track[0][0], track[1][0], track[2][0]}},
                        {"rotation", {track[3][0], track[4][0], track[5][0], track[6][0]}},
                        {"children", Json::array()}});
      follow(i, "translation", track, 0, 3);
      follow(i, "rotation", track, 3, 4);
    }
  }

  void follow(std::size_t node, const char* path, const LinkTrack& track, std::size_t first,
              std::size_t width) {
    bool moves = false;
    std::vector<float> values;
    for (const std::size_t i : chosen_)
      for (std::size_t k = first; k < first + width; ++k) {
        values.push_back(static_cast<float>(track[k][i]));
        moves = moves || values.back() != static_cast<float>(track[k][0]);
      }
    if (moves)
      animate(node, path, "LINEAR", times_, numbers_.add(values, static_cast<int>(width), false));
  }

  int material(const machine::Color& color) {
    const auto [found, is_new] =
        known_.try_emplace({color.r, color.g, color.b}, static_cast<int>(materials_.size()));
    if (!is_new) return found->second;
    materials_.push_back(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {linear(color.r), linear(color.g), linear(color.b), 1}},
           {"metallicFactor", 0.3},
           {"roughnessFactor", 0.55}}},
         {"doubleSided", true}});
    return found->second;
  }

  /// A mesh of triangles; without normals, so viewers show its facets.
  int add_mesh(const TriangleMesh& mesh, int material) {
    std::vector<float> places;
    for (const Vec3& v : mesh.vertices)
      for (int k = 0; k < 3; ++k) places.push_back(static_cast<float>(v[k]));
    std::vector<std::uint32_t> indices;
    for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    Json primitive = {{"attributes", {{"POSITION", numbers_.add(places, 3, true, vertex_target)}}},
                      {"indices", numbers_.add_indices(indices)},
                      {"material", material}};
    meshes_.push_back({{"primitives", {std::move(primitive)}}});
    return static_cast<int>(meshes_.size()) - 1;
  }

  /// Hangs a mesh on a link; the number of its node.
  std::size_t hang(const std::string& name, machine::LinkId link, const Pose& pose, int mesh) {
    Json holder = {{"name", utf8(name)}, {"children", {nodes_.size() + 1}}};
    if (!pose.matrix().isIdentity(0)) {
      Json matrix = Json::array();
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) matrix.push_back(pose.matrix()(row, column));
      holder["matrix"] = std::move(matrix);
    }
    nodes_[static_cast<std::size_t>(index(link))]["children"].push_back(nodes_.size());
    nodes_.push_back(std::move(holder));
    nodes_.push_back({{"name", utf8(name) + " shape"}, {"mesh", mesh}});
    return nodes_.size() - 1;
  }

  /// A node that is there only at some times; `steps` says from when on it is or is not.
  void show(std::size_t node, const std::vector<std::pair<double, bool>>& steps) {
    std::vector<float> times, scales;
    for (const auto& [t, there] : steps) {
      const auto at = static_cast<float>(t);
      if (times.empty() || at > times.back())
        times.push_back(at);
      else
        scales.resize(scales.size() - 3);  // the last of several at one time counts
      scales.insert(scales.end(), 3, there ? 1.0f : 0.0f);
    }
    animate(node, "scale", "STEP", numbers_.add(times, 1, true), numbers_.add(scales, 3, false));
  }

  void add_bodies(std::span<const StockStage> stages) {
    for (const machine::Body& b : replay_.machine().bodies()) {
      if (!b.mesh || b.mesh->triangles.empty()) continue;
      const int colour = material(b.color);
      if (b.role != machine::Role::stock || stages.empty()) {
        hang(b.name, b.link, b.X_LB, add_mesh(at_most(*b.mesh, most_body_triangles), colour));
        continue;
      }
      for (std::size_t i = 0; i < stages.size(); ++i) {
        if (stages[i].mesh.triangles.empty()) continue;
        const std::size_t node = hang(b.name + " " + std::to_string(i), b.link, b.X_LB,
                                      add_mesh(stages[i].mesh, colour));
        std::vector<std::pair<double, bool>> steps = {{0, i == 0}};
        if (i > 0) steps.emplace_back(stages[i].t, true);
        if (i + 1 < stages.size()) steps.emplace_back(stages[i + 1].t, false);
        show(node, steps);
      }
    }
  }

  void add_tools() {
    std::set<int> numbers;
    for (const auto& change : replay_.tool_times()) numbers.insert(change.number);
    numbers.erase(0);
    for (const int number : numbers)
      for (const machine::Body& b : replay_.tool_bodies(number)) {
        if (!b.mesh || b.mesh->triangles.empty()) continue;
        const std::size_t node =
            hang(b.name, b.link, b.X_LB,
                 add_mesh(at_most(*b.mesh, most_body_triangles), material(b.color)));
        std::vector<std::pair<double, bool>> steps = {{0, false}};
        for (const auto& change : replay_.tool_times())
          steps.emplace_back(change.t, change.number == number);
        show(node, steps);
      }
  }

  /// The way of the tool tip over the work: rapids, and what is cut.
  void add_path() {
    const auto& keys = replay_.keys();
    for (const bool rapid : {true, false}) {
      std::vector<float> places;
      for (std::size_t i = 1; i < keys.size(); ++i) {
        if (keys[i].rapid != rapid || keys[i].tip == keys[i - 1].tip) continue;
        for (const Vec3& v : {keys[i - 1].tip, keys[i].tip})
          for (int k = 0; k < 3; ++k) places.push_back(static_cast<float>(v[k]));
      }
      if (places.empty()) continue;
      Json primitive = {
          {"attributes", {{"POSITION", numbers_.add(places, 3, true, vertex_target)}}},
          {"mode", lines_mode},
          {"material",
           material(rapid ? machine::Color{224, 161, 0} : machine::Color{30, 136, 229})}};
      meshes_.push_back({{"primitives", {std::move(primitive)}}});
      hang(rapid ? "rapid" : "feed", replay_.machine().work_link(), replay_.machine().X_LM(),
           static_cast<int>(meshes_.size()) - 1);
    }
  }

  const Replay& replay_;
  Numbers numbers_;
  std::vector<Json> nodes_;
  std::size_t links_ = 0;
  std::vector<std::size_t> chosen_;                    ///< keys
  int times_ = 0;                                      ///< accessor of their times
  std::map<std::array<unsigned char, 3>, int> known_;  ///< materials by colour
  Json meshes_ = Json::array(), materials_ = Json::array();
  Json channels_ = Json::array(), samplers_ = Json::array();
};

}  // namespace

std::string glb_bytes(const Replay& replay, std::span<const StockStage> stages) {
  return Scene(replay).bytes(stages);
}

}  // namespace aircut::page
