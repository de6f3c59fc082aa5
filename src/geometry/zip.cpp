// Zip directory and deflate (RFC 1951).
//
// An archive ends with a record that says where the directory is; each directory entry names a
// file, its sizes, and where its local header stands, after which the packed bytes follow.
//
// Deflate is a row of blocks: stored bytes, or symbols in Huffman codes that are fixed or described
// at the block's start. A symbol below 256 is a byte, 256 ends the block, the others mean "repeat
// so many bytes from so far back". Codes are canonical: sorted by length, then by symbol; decoding
// counts through the lengths. Bits are taken from the low end of each byte.
#include "geometry/zip.h"

#include <algorithm>
#include <array>
#include <span>

namespace aircut::geometry {
namespace {

std::uint64_t little(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

class Bits {
 public:
  explicit Bits(std::string_view bytes) : bytes_(bytes) {}

  /// The next `count` ≤ 16 bits; after the end `failed()` holds and bits are 0.
  unsigned take(unsigned count) {
    unsigned value = 0;
    for (unsigned i = 0; i < count; ++i, ++at_) {
      if (at_ / 8 >= bytes_.size()) {
        failed_ = true;
        return 0;
      }
      value |= (static_cast<unsigned char>(bytes_[at_ / 8]) >> (at_ % 8) & 1u) << i;
    }
    return value;
  }
  void to_byte() { at_ = (at_ + 7) / 8 * 8; }
  bool failed() const { return failed_; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

constexpr unsigned longest_code = 15;

/// A canonical Huffman code.
class Code {
 public:
  explicit Code(std::span<const unsigned char> lengths) {
    for (const unsigned char length : lengths) ++count_[length];
    count_[0] = 0;
    std::array<unsigned, longest_code + 2> next{};
    for (unsigned length = 1; length <= longest_code; ++length)
      next[length + 1] = next[length] + count_[length];
    symbols_.resize(lengths.size());
    for (unsigned i = 0; i < lengths.size(); ++i)
      if (lengths[i] != 0) symbols_[next[lengths[i]]++] = i;
  }

  /// The next symbol; nothing when no code fits.
  std::optional<unsigned> decode(Bits& bits) const {
    unsigned code = 0, first = 0, index = 0;
    for (unsigned length = 1; length <= longest_code && !bits.failed(); ++length) {
      code |= bits.take(1);
      if (code < first + count_[length]) return symbols_[index + (code - first)];
      index += count_[length];
      first = (first + count_[length]) << 1;
      code <<= 1;
    }
    return std::nullopt;
  }

 private:
  std::array<unsigned, longest_code + 1> count_{};
  std::vector<unsigned> symbols_;
};

/// Length and distance symbols: the bits that follow grow by one for every `group` symbols.
struct Extended {
  unsigned base, extra;
};
Extended length_of(unsigned symbol) {  // 0 … 28
  if (symbol == 28) return {258, 0};
  if (symbol < 8) return {3 + symbol, 0};
  const unsigned extra = symbol / 4 - 1;
  return {3 + ((4 + symbol % 4) << extra), extra};
}
Extended distance_of(unsigned symbol) {  // 0 … 29
  if (symbol < 4) return {1 + symbol, 0};
  const unsigned extra = symbol / 2 - 1;
  return {1 + ((2 + symbol % 2) << extra), extra};
}

class Inflater {
 public:
  Inflater(std::string_view packed, std::size_t most) : bits_(packed), most_(most) {}

  std::optional<std::string> run() {
    bool last = false;
    while (!last && out_.size() < most_) {
      last = bits_.take(1) != 0;
      const unsigned kind = bits_.take(2);
      bool ok = false;
      if (kind == 0) ok = stored();
      if (kind == 1) ok = fixed_codes();
      if (kind == 2) ok = described_codes();
      if (!ok || bits_.failed()) return std::nullopt;
    }
    out_.resize(std::min(out_.size(), most_));
    return std::move(out_);
  }

 private:
  bool stored() {
    bits_.to_byte();
    const unsigned size = bits_.take(16), inverse = bits_.take(16);
    if ((size ^ inverse) != 0xffffu) return false;
    for (unsigned i = 0; i < size && !bits_.failed() && out_.size() < most_; ++i)
      out_.push_back(static_cast<char>(bits_.take(8)));
    return true;
  }

  bool fixed_codes() {
    std::array<unsigned char, 288> literals{};
    for (unsigned i = 0; i < literals.size(); ++i)
      literals[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
    std::array<unsigned char, 30> distances{};
    distances.fill(5);
    return symbols(Code(literals), Code(distances));
  }

  bool described_codes() {
    const unsigned literals = 257 + bits_.take(5), distances = 1 + bits_.take(5),
                   described = 4 + bits_.take(4);
    if (literals > 286 || distances > 30) return false;
    static constexpr std::array<unsigned char, 19> order = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                            11, 4,  12, 3, 13, 2, 14, 1, 15};
    std::array<unsigned char, 19> own{};
    for (unsigned i = 0; i < described; ++i)
      own[order[i]] = static_cast<unsigned char>(bits_.take(3));
    const Code code(own);
    std::vector<unsigned char> lengths;
    while (lengths.size() < literals + distances) {
      const auto symbol = code.decode(bits_);
      if (!symbol) return false;
      if (*symbol < 16) {
        lengths.push_back(static_cast<unsigned char>(*symbol));
        continue;
      }
      if (*symbol == 16 && lengths.empty()) return false;
      const unsigned char value = *symbol == 16 ? lengths.back() : static_cast<unsigned char>(0);
      const unsigned times = *symbol == 16   ? 3 + bits_.take(2)
                             : *symbol == 17 ? 3 + bits_.take(3)
                                             : 11 + bits_.take(7);
      lengths.insert(lengths.end(), times, value);
    }
    if (lengths.size() != literals + distances) return false;
    const std::span<const unsigned char> all(lengths);
    return symbols(Code(all.first(literals)), Code(all.subspan(literals)));
  }

  bool symbols(const Code& literals, const Code& distances) {
    while (out_.size() < most_) {
      const auto symbol = literals.decode(bits_);
      if (!symbol || bits_.failed()) return false;
      if (*symbol == 256) return true;
      if (*symbol < 256) {
        out_.push_back(static_cast<char>(*symbol));
        continue;
      }
      if (*symbol > 285) return false;
      const Extended length = length_of(*symbol - 257);
      const std::size_t count = length.base + bits_.take(length.extra);
      const auto far = distances.decode(bits_);
      if (!far || *far > 29) return false;
      const Extended distance = distance_of(*far);
      const std::size_t back = distance.base + bits_.take(distance.extra);
      if (back > out_.size()) return false;
      for (std::size_t i = 0; i < count; ++i) out_.push_back(out_[out_.size() - back]);
    }
    return true;
  }

  Bits bits_;
  std::size_t most_;
  std::string out_;
};

}  // namespace

std::optional<std::vector<ZipEntry>> zip_entries(std::string_view archive) {
  constexpr std::size_t end_bytes = 22, entry_bytes = 46, local_bytes = 30;
  const std::size_t end = archive.rfind(std::string_view("PK\5\6", 4));
  if (end == std::string_view::npos || archive.size() - end < end_bytes) return std::nullopt;
  const std::uint64_t count = little(archive, end + 10, 2);
  std::uint64_t at = little(archive, end + 16, 4);
  std::vector<ZipEntry> out;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (at > archive.size() || archive.size() - at < entry_bytes) return std::nullopt;
    if (archive.substr(at, 4) != std::string_view("PK\1\2", 4)) return std::nullopt;
    const std::uint64_t name = little(archive, at + 28, 2), extra = little(archive, at + 30, 2),
                        comment = little(archive, at + 32, 2), local = little(archive, at + 42, 4);
    if (archive.size() - at < entry_bytes + name) return std::nullopt;
    if (local > archive.size() || archive.size() - local < local_bytes) return std::nullopt;
    ZipEntry entry;
    entry.name = std::string(archive.substr(at + entry_bytes, name));
    entry.method = static_cast<std::uint16_t>(little(archive, at + 10, 2));
    entry.packed = little(archive, at + 20, 4);
    entry.unpacked = little(archive, at + 24, 4);
    entry.data =
        local + local_bytes + little(archive, local + 26, 2) + little(archive, local + 28, 2);
    if (entry.data > archive.size()) return std::nullopt;
    out.push_back(std::move(entry));
    at += entry_bytes + name + extra + comment;
  }
  return out;
}

std::optional<std::string> unpack_start(std::string_view archive, const ZipEntry& entry,
                                        std::size_t most) {
  const std::string_view packed = archive.substr(entry.data, entry.packed);
  if (entry.method == 0) return std::string(packed.substr(0, most));
  if (entry.method == 8) return Inflater(packed, most).run();
  return std::nullopt;
}

}  // namespace aircut::geometry
