#include "sim/checks/cut_tape.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "sim/checks/turning.h"

namespace aircut::sim {

namespace {

struct Record {
  double t = 0;
  double start[3], end[3], axis[3];
  std::uint64_t cutter = 0;  // index
};

Diagnostic disk_error(const char* what) {
  return make_error("output_failed",
                    std::string(what) + " for the pictures of the stock: " + std::strerror(errno));
}

using Cutters = std::vector<std::unique_ptr<stock::CutterProfile>>;

Vec3 vec(const double* v) { return {v[0], v[1], v[2]}; }

stock::Piece piece_of(const Record& record, const Cutters& cutters) {
  return {cutters[record.cutter].get(), vec(record.start), vec(record.end), vec(record.axis), 0};
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
    std::vector<stock::Piece> pieces;
    bool changed = !mesh_;
    const auto cut = [&]() -> Expected<void> {
      if (pieces.empty()) return {};
      changed = true;
      if (auto done = stock_.cut(pieces); !done) return unexpected(done.error());
      pieces.clear();
      return {};
    };
    while (more_ && next_.t <= t) {
      if (const auto piece = joiner_.add(piece_of(next_, *cutters_))) pieces.push_back(*piece);
      if (pieces.size() == 4096)
        if (auto done = cut(); !done) return unexpected(done.error());
      more_ = read();
    }
    if (std::ferror(file_.get()) != 0) return unexpected(disk_error("can't read a temporary file"));
    if (const auto piece = joiner_.rest()) pieces.push_back(*piece);
    if (auto done = cut(); !done) return unexpected(done.error());
    if (changed) mesh_ = std::make_shared<TriangleMesh>(stock_.mesh());
    return mesh_;
  }

 private:
  bool read() { return std::fread(&next_, sizeof next_, 1, file_.get()) == 1; }

  std::shared_ptr<std::FILE> file_;
  std::shared_ptr<const Cutters> cutters_;
  stock::Stock stock_;
  Joiner joiner_;
  Record next_{};
  bool more_ = false;
  std::shared_ptr<const TriangleMesh> mesh_;
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

const stock::CutterProfile* CutTape::keep(const stock::CutterProfile& cutter) {
  cutters_->push_back(std::make_unique<stock::CutterProfile>(cutter));
  return cutters_->back().get();
}

Expected<void> CutTape::add(const stock::Piece& piece, double t) {
  Record record;
  record.t = t;
  for (int i = 0; i < 3; ++i) {
    record.start[i] = piece.start[i];
    record.end[i] = piece.end[i];
    record.axis[i] = piece.axis[i];
  }
  const auto at = std::find_if(cutters_->rbegin(), cutters_->rend(),
                               [&](const auto& cutter) { return cutter.get() == piece.cutter; });
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
