// A stock as a file, so that the next job goes on where this one ended.
//
// All numbers little-endian. After the first line `aircut stock 1` come the pitch, the lattice's
// origin, the initial box (doubles) and the number of bricks per axis (32 bits); then all bricks
// in the order of the table, as runs: a byte 0 (empty) or 1 (full) with a 32-bit count, or a byte 2
// with one brick. A brick holds its three families; a family is a byte 0 and a bit per ray (full or
// empty), or a byte 1 and per ray the number of intervals (a byte) with lo, hi and the directions
// of both ends (16 bits each). The file ends with the SHA-256 of all that precedes, as 64 digits.
// What is read is checked: nothing that could not have been written becomes a stock.
#include <algorithm>
#include <cmath>

#include "stock/file_bytes.h"
#include "stock/impl.h"

namespace aircut::stock {
namespace {

class Writer : public FileWriter {
 public:
  using FileWriter::FileWriter;

  void brick(const Brick& brick) {
    number(std::uint8_t{2});
    for (const RayFamily& f : brick.family) family(f);
  }

 private:
  void family(const RayFamily& f) {
    if (!f.block) {
      number(std::uint8_t{0});
      for (const std::uint16_t row : f.full) number(row);
      return;
    }
    number(std::uint8_t{1});
    for (int ray = 0; ray < rays; ++ray) {
      f.intervals(ray, intervals_);
      number(static_cast<std::uint8_t>(intervals_.size()));
      for (const Interval& v : intervals_)
        for (const std::uint16_t n : {v.lo, v.hi, v.normal_lo, v.normal_hi}) number(n);
    }
  }

  std::vector<Interval> intervals_;
};

class Reader : public FileReader {
 public:
  using FileReader::FileReader;

  std::unique_ptr<Brick> brick() {
    auto out = std::make_unique<Brick>();
    for (RayFamily& f : out->family) family(f);
    settle(*out);
    return out;
  }

 private:
  void family(RayFamily& f) {
    const auto kind = number<std::uint8_t>();
    if (kind > 1) return wrong("a family of rays is of an unknown sort");
    if (kind == 0) {
      for (std::uint16_t& row : f.full) row = number<std::uint16_t>();
      return;
    }
    f.make_block();
    for (int ray = 0; ray < rays && good(); ++ray) {
      int last = -1;
      for (int n = number<std::uint8_t>(); n > 0 && good(); --n) {
        Interval v;
        for (std::uint16_t* part : {&v.lo, &v.hi, &v.normal_lo, &v.normal_hi})
          *part = number<std::uint16_t>();
        if (!good()) return;
        if (v.lo >= v.hi || v.hi > brick_quanta || v.lo < last)
          return wrong("the intervals of a ray are not in order");
        last = v.hi;
        add_interval(f, ray, v);
      }
    }
  }
};

/// Reads the lattice; false when it makes no sense.
bool read_lattice(Reader& in, Stock::Impl& impl) {
  Lattice& lattice = impl.lattice;
  lattice.pitch = in.real();
  for (int a = 0; a < 3; ++a) lattice.origin[a] = in.real();
  for (Vec3* corner : {&impl.box.min(), &impl.box.max()})
    for (int a = 0; a < 3; ++a) (*corner)[a] = in.real();
  for (int& n : lattice.bricks) n = in.number<std::int32_t>();
  if (!in.good()) return false;
  const Vec3 size = impl.box.sizes();
  bool sound = lattice.pitch >= finest_pitch && lattice.pitch <= largest_coordinate &&
               lattice.origin.cwiseAbs().maxCoeff() <= largest_coordinate &&
               impl.box.min().cwiseAbs().maxCoeff() <= largest_coordinate &&
               impl.box.max().cwiseAbs().maxCoeff() <= largest_coordinate && size.minCoeff() > 0;
  double bricks = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    sound = sound && lattice.bricks[a] > 0 && lattice.bricks[a] < 1 << 16;
    bricks *= lattice.bricks[a];
  }
  if (!sound) {
    in.wrong("its lattice has no size");
    return false;
  }
  if (bricks * sizeof(BrickSlot) > static_cast<double>(impl.options.memory_limit)) {
    in.wrong("its lattice doesn't fit into the memory");
    return false;
  }
  return true;
}

void read_bricks(Reader& in, Stock::Impl& impl) {
  impl.table.resize(impl.lattice.count());
  impl.tops.assign(impl.lattice.columns(), impl.lattice.bricks[2]);
  for (std::size_t at = 0; at < impl.table.size() && in.good();) {
    const auto kind = in.number<std::uint8_t>();
    if (kind == 2) {
      auto brick = in.brick();
      if (!in.good()) return;
      impl.brick_bytes += brick->bytes();
      impl.table[at++].set(std::move(brick));
      if (impl.brick_bytes > impl.options.memory_limit)
        return in.wrong("its bricks don't fit into the memory");
      continue;
    }
    const std::size_t count = in.number<std::uint32_t>();
    if (kind > 2 || count == 0 || count > impl.table.size() - at)
      return in.wrong("a run of bricks is of an unknown sort or too long");
    for (std::size_t i = 0; i < count; ++i)
      impl.table[at++].set(kind == 1 ? BrickSlot::full : BrickSlot::empty);
  }
}

}  // namespace

std::string Stock::save() const {
  const Lattice& lattice = impl_->lattice;
  Writer out(milled_heading);
  out.real(lattice.pitch);
  for (int a = 0; a < 3; ++a) out.real(lattice.origin[a]);
  for (const Vec3& corner : {impl_->box.min(), impl_->box.max()})
    for (int a = 0; a < 3; ++a) out.real(corner[a]);
  for (const int n : lattice.bricks) out.number(static_cast<std::int32_t>(n));
  std::uint8_t kind = 0;
  std::uint32_t count = 0;
  const auto end_run = [&] {
    if (count == 0) return;
    out.number(kind);
    out.number(count);
    count = 0;
  };
  for (int j = 0; j < lattice.bricks[1]; ++j)
    for (int i = 0; i < lattice.bricks[0]; ++i)
      for (int k = 0; k < lattice.bricks[2]; ++k) {
        std::unique_ptr<Brick> scratch;
        if (const Brick* brick = impl_->look(i, j, k, scratch)) {
          end_run();
          out.brick(*brick);
          continue;
        }
        const std::uint8_t here = impl_->table[lattice.index(i, j, k)].is(BrickSlot::full) ? 1 : 0;
        if (here != kind) end_run();
        kind = here;
        ++count;
      }
  end_run();
  return out.finish();
}

Expected<Stock> Stock::load(std::string_view bytes, const std::string& name,
                            const StockOptions& options) {
  const auto content = file_content(bytes, milled_heading, name);
  if (!content) return unexpected(content.error());
  auto impl = std::make_unique<Impl>();
  impl->options = options;
  impl->solid = MeshSolid{};  // all of it is in the rays
  Reader in(*content);
  if (read_lattice(in, *impl)) read_bricks(in, *impl);
  if (in.good() && !in.at_end()) in.wrong("it goes on after its last brick");
  if (!in.good()) return unexpected(file_error(name, in.message()));
  return Stock(std::move(impl));
}

}  // namespace aircut::stock
