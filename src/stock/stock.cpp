#include "stock/stock.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stock/impl.h"

namespace aircut::stock {
namespace {

/// Bytes of a brick whose three families all hold rays.
constexpr std::size_t whole_brick = sizeof(Brick) + 3 * sizeof(RayBlock);

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles)
    area += (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                .norm() /
            2;
  return area;
}

/// Bytes before anything is cut: the table, and the surface bricks of a mesh.
double bytes_to_begin(const Solid& solid, const Box3& box, double pitch) {
  const double brick = cells * pitch;
  const Vec3 size = (box.sizes() / brick).array().ceil();
  double out = size.prod() * sizeof(BrickSlot);
  if (const auto* mesh = std::get_if<MeshSolid>(&solid))
    out += 1.5 * area_of(*mesh->mesh) / (brick * brick) * static_cast<double>(whole_brick);
  return out;
}

/// The finest pitch that fits, rounded up to two digits.
double finest_that_fits(const Solid& solid, const Box3& box, double pitch, std::size_t limit) {
  while (bytes_to_begin(solid, box, pitch) > static_cast<double>(limit)) pitch *= 1.002;
  const double digit = std::pow(10, std::floor(std::log10(pitch)) - 1);
  return std::ceil(pitch / digit) * digit;
}

/// Mixes 64 bits into a running value; only used to compress what SHA-256 then takes in.
std::uint64_t mix(std::uint64_t h, std::uint64_t value) {
  h = (h ^ value) * 0x9e3779b97f4a7c15u;
  return h ^ h >> 29;
}

}  // namespace

Diagnostic too_large(const Stock::Impl& stock) {
  // Bricks grow as 1/h².
  const double ratio =
      std::sqrt(static_cast<double>(stock.brick_bytes + stock.table.size() * sizeof(BrickSlot)) /
                static_cast<double>(stock.options.memory_limit));
  const double pitch = stock.lattice.pitch * std::max(ratio, 1.0) * 1.1;
  const double digit = std::pow(10, std::floor(std::log10(pitch)) - 1);
  return make_error("stock_memory", "the stock outgrew its memory of " +
                                        std::to_string(stock.options.memory_limit >> 20) +
                                        " MiB at a pitch of " + shortest(stock.lattice.pitch) +
                                        " mm; what was cut so far fits with " +
                                        fixed(std::ceil(pitch / digit) * digit, 4) + " mm");
}

Expected<void> Stock::fits(const Solid& solid, double pitch, const StockOptions& options) {
  const auto box = solid_box(solid);
  if (!box || !(pitch >= finest_pitch)) return {};  // make() tells
  if (!(bytes_to_begin(solid, *box, pitch) > static_cast<double>(options.memory_limit))) return {};
  const Vec3 size = box->sizes();
  const double finest = finest_that_fits(solid, *box, pitch, options.memory_limit);
  std::string digits = fixed(finest, 6);  // it has two
  digits.erase(digits.find_last_not_of('0') + 1);
  return unexpected(
      make_error("stock_memory", "a stock of " + fixed(size.x(), 1) + " x " + fixed(size.y(), 1) +
                                     " x " + fixed(size.z(), 1) + " mm does not fit into " +
                                     std::to_string(options.memory_limit >> 20) +
                                     " MiB at a pitch of " + shortest(pitch) +
                                     " mm; the finest pitch that fits is " + digits + " mm"));
}

Expected<Stock> Stock::make(const Solid& solid, double pitch, const StockOptions& options) {
  const auto box = solid_box(solid);
  if (!box) return unexpected(box.error());
  const Vec3 size = box->sizes();
  if (!(std::max(box->min().cwiseAbs().maxCoeff(), box->max().cwiseAbs().maxCoeff()) <=
        largest_coordinate))
    return unexpected(make_error("stock_shape", "the stock lies more than a kilometre away"));
  if (!(pitch >= finest_pitch) || !std::isfinite(pitch) || pitch > size.minCoeff())
    return unexpected(
        make_error("stock_shape",
                   "the stock's pitch must be at least 0.0001 mm and at most the smallest "
                   "side of the stock, " +
                       shortest(size.minCoeff()) + " mm"));
  if (auto room = fits(solid, pitch, options); !room) return unexpected(room.error());
  auto impl = std::make_unique<Impl>();
  impl->solid = solid;
  impl->box = *box;
  impl->options = options;
  Lattice& lattice = impl->lattice;
  lattice.origin = box->min();
  lattice.pitch = pitch;
  for (int a = 0; a < 3; ++a)
    lattice.bricks[static_cast<std::size_t>(a)] =
        std::max(1, static_cast<int>(std::ceil(size[a] / lattice.brick_size() - 1e-9)));
  impl->table.resize(lattice.count());
  impl->tops.assign(lattice.columns(), lattice.bricks[2]);
  if (const auto* mesh = std::get_if<MeshSolid>(&solid)) {
    cast_mesh(*mesh->mesh, lattice, impl->table);
    impl->solid = MeshSolid{};  // it lives on in its rays
  } else {
    for (int j = 0; j < lattice.bricks[1]; ++j)
      for (int i = 0; i < lattice.bricks[0]; ++i)
        for (int k = 0; k < lattice.bricks[2]; ++k)
          impl->table[lattice.index(i, j, k)].set(classify(solid, lattice, i, j, k));
  }
  for (const BrickSlot& slot : impl->table)
    if (slot.brick()) impl->brick_bytes += slot.brick()->bytes();
  return Stock(std::move(impl));
}

Stock::Stock(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Stock::Stock(Stock&&) noexcept = default;
Stock& Stock::operator=(Stock&&) noexcept = default;
Stock::~Stock() = default;

Stock Stock::clone() const {
  auto copy = std::make_unique<Impl>();
  copy->solid = impl_->solid;
  copy->box = impl_->box;
  copy->lattice = impl_->lattice;
  copy->options = impl_->options;
  copy->tops = impl_->tops;
  copy->brick_bytes = impl_->brick_bytes;
  copy->table.resize(impl_->table.size());
  for (std::size_t i = 0; i < copy->table.size(); ++i) {
    const BrickSlot& from = impl_->table[i];
    if (from.brick())
      copy->table[i].set(from.brick()->clone());
    else
      copy->table[i].set(from.is(BrickSlot::full)    ? BrickSlot::full
                         : from.is(BrickSlot::empty) ? BrickSlot::empty
                                                     : BrickSlot::untouched);
  }
  return Stock(std::move(copy));
}

const Brick* Stock::Impl::look(int i, int j, int k, std::unique_ptr<Brick>& scratch) const {
  const BrickSlot& slot = table[lattice.index(i, j, k)];
  if (slot.brick()) return slot.brick();
  if (!slot.is(BrickSlot::untouched)) return nullptr;
  scratch = fill(solid, lattice, i, j, k);
  return scratch.get();
}

double Stock::pitch() const { return impl_->lattice.pitch; }

Box3 Stock::box() const { return impl_->box; }

std::size_t Stock::bytes() const {
  return impl_->brick_bytes + impl_->table.size() * sizeof(BrickSlot);
}

std::size_t Stock::bytes_at(double pitch) const {
  const double ratio = impl_->lattice.pitch / pitch;
  const double bricks = static_cast<double>(impl_->brick_bytes) * ratio * ratio;
  const double table =
      static_cast<double>(impl_->table.size() * sizeof(BrickSlot)) * ratio * ratio * ratio;
  return static_cast<std::size_t>(bricks + table);
}

double Stock::volume_of(std::int64_t quanta) const {
  return static_cast<double>(quanta) * impl_->lattice.quantum() * impl_->lattice.pitch *
         impl_->lattice.pitch;
}

std::int64_t Stock::z_quanta() const {
  std::int64_t sum = 0;
  const Lattice& lattice = impl_->lattice;
  for (int j = 0; j < lattice.bricks[1]; ++j)
    for (int i = 0; i < lattice.bricks[0]; ++i)
      for (int k = 0; k < lattice.bricks[2]; ++k) {
        std::unique_ptr<Brick> scratch;
        if (const Brick* brick = impl_->look(i, j, k, scratch))
          sum += brick->family[2].quanta();
        else if (impl_->table[lattice.index(i, j, k)].is(BrickSlot::full))
          sum += std::int64_t{rays} * brick_quanta;
      }
  return sum;
}

std::vector<std::pair<double, double>> Stock::on_ray(int axis, const Vec3& point) const {
  const Lattice& lattice = impl_->lattice;
  std::array<int, 3> node{};
  for (int a = 0; a < 3; ++a)
    node[static_cast<std::size_t>(a)] = static_cast<int>(
        std::clamp(std::floor((point[a] - lattice.origin[a]) / lattice.pitch), 0.0,
                   static_cast<double>(lattice.bricks[static_cast<std::size_t>(a)] * cells - 1)));
  const int lane = node[axis == 0 ? 1 : 0] % cells, row = node[axis == 2 ? 1 : 2] % cells;
  std::array<int, 3> b = {node[0] / cells, node[1] / cells, node[2] / cells};
  const auto along = static_cast<std::size_t>(axis);
  std::vector<std::pair<double, double>> out;
  std::vector<Interval> intervals;
  for (b[along] = 0; b[along] < lattice.bricks[along]; ++b[along]) {
    std::unique_ptr<Brick> scratch;
    const Brick* brick = impl_->look(b[0], b[1], b[2], scratch);
    intervals.clear();
    if (brick)
      brick->family[along].intervals(row * cells + lane, intervals);
    else if (impl_->table[lattice.index(b[0], b[1], b[2])].is(BrickSlot::full))
      intervals.push_back({0, brick_quanta, 0, 0});
    for (const Interval& v : intervals) {
      const auto at = [&](std::uint16_t q) {
        return lattice.origin[axis] +
               (static_cast<double>(b[along]) * brick_quanta + q) * lattice.quantum();
      };
      const bool goes_on = !out.empty() && v.lo == 0 && out.back().second == at(0);
      if (goes_on)
        out.back().second = at(v.hi);
      else
        out.emplace_back(at(v.lo), at(v.hi));
    }
  }
  return out;
}

std::string Stock::hash() const {
  const Lattice& lattice = impl_->lattice;
  std::string digest;
  std::vector<Interval> intervals;
  const auto append = [&](std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) digest += static_cast<char>(value >> (8 * byte) & 255);
  };
  for (int j = 0; j < lattice.bricks[1]; ++j)
    for (int i = 0; i < lattice.bricks[0]; ++i)
      for (int k = 0; k < lattice.bricks[2]; ++k) {
        std::unique_ptr<Brick> scratch;
        const Brick* brick = impl_->look(i, j, k, scratch);
        const std::size_t at = lattice.index(i, j, k);
        std::uint64_t h = mix(1, at);
        std::size_t whole = 0, present = 0;
        if (!brick) {
          if (impl_->table[at].is(BrickSlot::full)) append(mix(h, 1));
          continue;
        }
        for (std::size_t ray = 0; ray < 3 * rays; ++ray) {
          brick->family[ray / rays].intervals(static_cast<int>(ray % rays), intervals);
          for (const Interval& v : intervals) {
            ++present;
            whole += v.lo == 0 && v.hi == brick_quanta;
            h = mix(h, ray << 32 | std::uint64_t{v.lo} << 16 | v.hi);
            h = mix(h, std::uint64_t{v.normal_lo} << 16 | v.normal_hi);
          }
        }
        if (present == 0) continue;
        append(whole == 3 * rays ? mix(mix(1, at), 1) : h);
      }
  return sha256(digest);
}

std::vector<Piece> arc_pieces(const Arc& arc, const Piece& pattern, double deviation) {
  // A chord over the angle a lies r (1 − cos(a/2)) inside of its arc.
  const Vec3 n = arc.normal;
  const Vec3 from = arc.start - arc.centre;
  const Vec3 radial = from - from.dot(n) * n;
  const double r = radial.norm();
  const double most = r > deviation ? 2 * std::acos(1 - deviation / r) : std::numbers::pi / 2;
  const auto count = static_cast<int>(
      std::max(1.0, std::ceil(std::abs(arc.angle) / std::min(most, std::numbers::pi / 2))));
  const Vec3 side = n.cross(radial), rise = n * (arc.end - arc.start).dot(n);
  std::vector<Piece> out;
  Vec3 last = arc.start;
  for (int i = 1; i <= count; ++i) {
    const double part = static_cast<double>(i) / count, a = arc.angle * part;
    const Vec3 next =
        i == count
            ? arc.end
            : Vec3(arc.start - radial + std::cos(a) * radial + std::sin(a) * side + part * rise);
    out.push_back(pattern);
    out.back().start = last;
    out.back().end = next;
    last = next;
  }
  return out;
}

}  // namespace aircut::stock
