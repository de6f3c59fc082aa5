#include "sim/checks/cut_tape.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "geometry/mesh_part.h"
#include "sim/checks/turning.h"

namespace aircut::sim {

namespace {

struct Record {
  double t0 = 0, t1 = 0;  // of the program
  double start[3], end[3], axis[3];
  std::uint64_t cutter = 0;  // index
};

Diagnostic disk_error(const char* what) {
  return make_error("output_failed",
                    std::string(what) + " for the pictures of the stock: " + std::strerror(errno));
}

using Cutters = std::vector<CutTape::Cutter>;

Vec3 vec(const double* v) { return {v[0], v[1], v[2]}; }

stock::Piece piece_of(const Record& record, const Cutters& cutters) {
  return {cutters[record.cutter].profile.get(), vec(record.start), vec(record.end),
          vec(record.axis), 0};
}

// Puts pieces that follow one another into one where the straight way past all their ends is no
// farther than a tolerance from any of them. A picture shows less than that.
class Joiner {
 public:
  explicit Joiner(double tolerance) : tolerance_(tolerance) {}

  /// What is complete, if this piece does not go on with it.
  std::optional<stock::Piece> add(const stock::Piece& piece) {
    if (piece_ && piece.cutter == piece_->cutter && piece.axis == piece_->axis &&
        (piece.start - piece_->end).norm() < 1e-6 && ends_.size() < most_ends &&
        stays_near(piece.end)) {
      ends_.push_back(piece_->end);
      piece_->end = piece.end;
      return std::nullopt;
    }
    ends_.clear();
    return std::exchange(piece_, piece);
  }
  std::optional<stock::Piece> rest() {
    ends_.clear();
    return std::exchange(piece_, std::nullopt);
  }

 private:
  // What is looked at again for every piece; longer chains gain nothing.
  static constexpr std::size_t most_ends = 12;

  bool near(const Vec3& p, const Vec3& end) const {
    const Vec3 way = end - piece_->start, from = p - piece_->start;
    const double square = way.squaredNorm();
    const double f = square > 0 ? std::clamp(from.dot(way) / square, 0.0, 1.0) : 0;
    return (from - f * way).squaredNorm() <= tolerance_ * tolerance_;
  }
  bool stays_near(const Vec3& end) const {
    return near(piece_->end, end) &&
           std::all_of(ends_.begin(), ends_.end(), [&](const Vec3& p) { return near(p, end); });
  }

  double tolerance_;
  std::optional<stock::Piece> piece_;
  std::vector<Vec3> ends_;  ///< of the pieces in it but for the last
};

class Player final : public StockHistory {
 public:
  Player(std::shared_ptr<std::FILE> file, std::shared_ptr<const Cutters> cutters,
         stock::Stock stock, double tolerance)
      : file_(std::move(file)),
        cutters_(std::move(cutters)),
        stock_(std::move(stock)),
        joiner_(tolerance) {
    more_ = read();
  }

  Expected<std::shared_ptr<const TriangleMesh>> at(double t) override {
    bool changed = !mesh_;
    while (more_ && next_.t1 <= t) {
      if (auto done = cut_until(t, std::nullopt); !done) return unexpected(done.error());
      changed = true;
    }
    if (under_way(t)) {
      if (auto done = cut_begun(t); !done) return unexpected(done.error());
      changed = true;
    }
    if (auto read = read_error(); !read) return unexpected(read.error());
    if (changed) mesh_ = std::make_shared<TriangleMesh>(stock_.mesh());
    return mesh_;
  }

  // A vertex of the lattice's mesh depends on its own cell alone: as long as nothing is taken there
  // it stays where it is, to the last bit. So whatever a tool leaves where it was, an earlier one
  // has made.
  Expected<std::vector<MadeBy>> by_tool(double t) override {
    if (tools_.empty()) look_at_new_places(0);
    while (more_ && next_.t1 <= t) {
      const int tool = tool_of(next_);
      if (auto done = cut_until(t, tool); !done) return unexpected(done.error());
      look_at_new_places(tool);
    }
    if (under_way(t)) {
      if (auto done = cut_begun(t); !done) return unexpected(done.error());
      look_at_new_places(tool_of(next_));
    }
    if (auto read = read_error(); !read) return unexpected(read.error());
    return pieces_by_tool();
  }

 private:
  struct BitsOf {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::size_t out = 0;
      for (const double v : p)
        out = (out ^ std::bit_cast<std::uint64_t>(v)) * 0x9e3779b97f4a7c15 ^ (out >> 29);
      return out;
    }
  };
  using Places = std::unordered_map<std::array<double, 3>, std::uint32_t, BitsOf>;
  static std::array<double, 3> place_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

  int tool_of(const Record& record) const { return (*cutters_)[record.cutter].tool; }

  // Up to time t; with `tool` no farther than the pieces that it cut.
  Expected<void> cut_until(double t, std::optional<int> tool) {
    std::vector<stock::Piece> pieces;
    while (more_ && next_.t1 <= t && (!tool || tool_of(next_) == *tool)) {
      if (const auto piece = joiner_.add(piece_of(next_, *cutters_))) pieces.push_back(*piece);
      more_ = read();
      if (pieces.size() < 4096) continue;
      if (auto done = stock_.cut(pieces); !done) return unexpected(done.error());
      pieces.clear();
    }
    if (const auto piece = joiner_.rest()) pieces.push_back(*piece);
    if (pieces.empty()) return {};
    if (auto done = stock_.cut(pieces); !done) return unexpected(done.error());
    return {};
  }

  bool under_way(double t) const { return more_ && next_.t0 < t; }

  // What is done of the next piece at time t; it comes as a whole later, which takes the same and
  // the rest. As if its speed were steady: for a picture.
  Expected<void> cut_begun(double t) {
    stock::Piece piece = piece_of(next_, *cutters_);
    piece.end = piece.start + (t - next_.t0) / (next_.t1 - next_.t0) * (piece.end - piece.start);
    if (auto done = stock_.cut({&piece, 1}); !done) return unexpected(done.error());
    return {};
  }

  void look_at_new_places(int tool) {
    surface_ = stock_.mesh(stock::Facets::lattice);
    const auto turn = static_cast<std::uint32_t>(tools_.size());
    tools_.push_back(tool);
    Places now;
    now.reserve(surface_.vertices.size());
    for (const Vec3& v : surface_.vertices) {
      const auto known = made_in_.find(place_of(v));
      now.emplace(place_of(v), known == made_in_.end() ? turn : known->second);
    }
    made_in_ = std::move(now);
  }

  // A triangle across an edge belongs to the older of the two surfaces.
  std::vector<MadeBy> pieces_by_tool() const {
    std::map<int, std::vector<std::array<std::uint32_t, 3>>> triangles;
    const auto turn = [&](std::uint32_t vertex) {
      return made_in_.at(place_of(surface_.vertices[vertex]));
    };
    for (const auto& t : surface_.triangles)
      triangles[tools_[std::min({turn(t[0]), turn(t[1]), turn(t[2])})]].push_back(t);
    std::vector<MadeBy> out;
    for (const auto& [tool, list] : triangles)
      out.push_back({tool, std::make_shared<TriangleMesh>(part_of(surface_, list))});
    return out;
  }

  Expected<void> read_error() const {
    if (std::ferror(file_.get()) == 0) return {};
    return unexpected(disk_error("can't read a temporary file"));
  }
  bool read() { return std::fread(&next_, sizeof next_, 1, file_.get()) == 1; }

  std::shared_ptr<std::FILE> file_;
  std::shared_ptr<const Cutters> cutters_;
  stock::Stock stock_;
  Joiner joiner_;
  Record next_{};
  bool more_ = false;
  std::shared_ptr<const TriangleMesh> mesh_;
  TriangleMesh surface_;    ///< for by_tool()
  std::vector<int> tools_;  ///< one after the other; first 0
  Places made_in_;          ///< index into tools_
};

double longest_side(const machine::RawStock& raw) { return bounds(*raw.mesh).sizes().maxCoeff(); }

}  // namespace

double default_pitch(const machine::RawStock& raw) {
  const double wanted = std::clamp(longest_side(raw) / 500, 0.001, 1.0);
  const double decade = std::pow(10, std::floor(std::log10(wanted) + 1e-9));
  const double lead = wanted / decade * (1 + 1e-9);
  return decade * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
}

namespace {

stock::Solid solid_of(const machine::RawStock& raw) {
  stock::Solid solid;
  switch (raw.shape) {
    case machine::StockShape::box:
      solid = stock::Box{Vec3(-raw.size.x() / 2, -raw.size.y() / 2, 0),
                         Vec3(raw.size.x() / 2, raw.size.y() / 2, raw.size.z())};
      break;
    case machine::StockShape::cylinder:
      solid = stock::Cylinder{
          .radius = raw.diameter / 2, .inner_radius = raw.bore / 2, .length = raw.height};
      break;
    case machine::StockShape::mesh:
    case machine::StockShape::saved:
      solid = stock::MeshSolid{raw.mesh};
      break;
  }
  return solid;
}

}  // namespace

Expected<stock::Stock> make_stock(const machine::RawStock& raw, double pitch) {
  return stock::Stock::make(solid_of(raw), pitch);
}

Expected<void> stock_fits(const machine::Machine& machine) {
  const auto& raw = machine.stock();
  if (!raw || raw->saved || turns_the_work(machine)) return {};
  return stock::Stock::fits(solid_of(*raw), raw->pitch.value_or(default_pitch(*raw)));
}

Expected<CutTape> CutTape::make() {
  CutTape tape;
  tape.file_ = std::shared_ptr<std::FILE>(std::tmpfile(), [](std::FILE* file) {
    if (file) std::fclose(file);
  });
  if (!tape.file_) return unexpected(disk_error("can't make a temporary file"));
  tape.cutters_ = std::make_shared<Cutters>();
  return tape;
}

const stock::CutterProfile* CutTape::keep(const stock::CutterProfile& cutter, int tool) {
  cutters_->push_back({std::make_unique<stock::CutterProfile>(cutter), tool});
  return cutters_->back().profile.get();
}

Expected<void> CutTape::add(const stock::Piece& piece, double t0, double t1) {
  Record record;
  record.t0 = t0;
  record.t1 = t1;
  for (int i = 0; i < 3; ++i) {
    record.start[i] = piece.start[i];
    record.end[i] = piece.end[i];
    record.axis[i] = piece.axis[i];
  }
  const auto at = std::find_if(cutters_->rbegin(), cutters_->rend(), [&](const auto& cutter) {
    return cutter.profile.get() == piece.cutter;
  });
  record.cutter = static_cast<std::uint64_t>(cutters_->rend() - at - 1);
  if (std::fwrite(&record, sizeof record, 1, file_.get()) == 1) return {};
  return unexpected(disk_error("can't write a temporary file"));
}

Expected<stock::Stock> CutTape::stock_after(const machine::RawStock& raw, double pitch,
                                            std::uint64_t pieces) {
  auto stock = raw.saved ? stock::Stock::load(raw.saved->content(), raw.saved->name())
                         : make_stock(raw, pitch);
  if (!stock) return stock;
  if (std::fflush(file_.get()) != 0 || std::fseek(file_.get(), 0, SEEK_SET) != 0)
    return unexpected(disk_error("can't read a temporary file"));
  std::vector<stock::Piece> batch;
  Record record;
  for (std::uint64_t i = 0; i < pieces; ++i) {
    if (std::fread(&record, sizeof record, 1, file_.get()) != 1)
      return unexpected(disk_error("can't read a temporary file"));
    batch.push_back(piece_of(record, *cutters_));
    if (batch.size() < 4096 && i + 1 < pieces) continue;
    if (auto done = stock->cut(batch); !done) return unexpected(done.error());
    batch.clear();
  }
  // What is added next goes to the end again.
  if (std::fseek(file_.get(), 0, SEEK_END) != 0)
    return unexpected(disk_error("can't read a temporary file"));
  return stock;
}

Expected<std::unique_ptr<StockHistory>> CutTape::play(const machine::RawStock& raw, double steps) {
  if (std::fflush(file_.get()) != 0 || std::fseek(file_.get(), 0, SEEK_SET) != 0)
    return unexpected(disk_error("can't read a temporary file"));
  const double pitch = std::max(raw.pitch.value_or(default_pitch(raw)), longest_side(raw) / steps);
  auto stock = make_stock(raw, pitch);
  if (!stock) return unexpected(stock.error());
  return std::make_unique<Player>(file_, cutters_, std::move(*stock), pitch / 10);
}

}  // namespace aircut::sim
