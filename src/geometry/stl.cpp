// STL, both forms.
//
// Binary: 80 bytes of header, a 32-bit count, then 50 bytes per triangle (normal, three corners as
// 32-bit floats, two spare bytes), all little-endian. Text: `solid … facet normal … outer loop
// vertex x y z (three times) endloop endfacet … endsolid`. Many binary files begin with `solid`
// too, so the length decides first: if it fits the count exactly, the file is binary. Normals are
// not used; the order of the corners says which side is outside.
#include "geometry/stl.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

namespace aircut::geometry {
namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t triangle_bytes = 50;

using Result = tl::expected<TriangleMesh, std::string>;

std::uint32_t little_u32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

std::string too_many(std::size_t count, std::size_t limit) {
  return fmt::format("has {} triangles, more than the limit of {}", count, limit);
}

void add_triangle(TriangleMesh& mesh) {
  const auto end = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.triangles.push_back({end - 3, end - 2, end - 1});
}

Result read_binary(std::string_view bytes, std::size_t max_triangles) {
  const std::size_t count = little_u32(bytes, 80);
  if (count > max_triangles) return unexpected(too_many(count, max_triangles));
  TriangleMesh mesh;
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t corners = header_bytes + triangle_bytes * i + 12;
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 p;
      for (std::size_t c = 0; c < 3; ++c)
        p[static_cast<int>(c)] =
            static_cast<double>(std::bit_cast<float>(little_u32(bytes, corners + 12 * k + 4 * c)));
      mesh.vertices.push_back(p);
    }
    add_triangle(mesh);
  }
  return mesh;
}

/// Words between white space, with the line they stand in.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) {
      if (text_[at_] == '\n') ++line_;
      ++at_;
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  std::size_t line() const { return line_; }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

bool same_word(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i] >= 'A' && word[i] <= 'Z' ? static_cast<char>(word[i] + 32) : word[i];
    if (c != lower[i]) return false;
  }
  return true;
}

std::optional<double> coordinate(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::string shown(std::string_view word) {
  if (word.empty()) return "the end of the file";
  constexpr std::size_t longest = 40;
  return fmt::format("'{}'", printable(word.substr(0, longest)));
}

class TextReader {
 public:
  TextReader(std::string_view text, std::size_t max_triangles)
      : words_(text), max_triangles_(max_triangles) {}

  Result read() {
    while (true) {
      const std::string_view word = words_.next();
      if (word.empty()) {
        if (in_solid_) return unexpected(expected_instead("'facet' or 'endsolid'", word));
        return std::move(mesh_);
      }
      if (same_word(word, "solid") && !in_solid_) {
        in_solid_ = true;
        words_.skip_line();  // the name
      } else if (same_word(word, "endsolid") && in_solid_) {
        in_solid_ = false;
        words_.skip_line();
      } else if (same_word(word, "facet") && in_solid_) {
        if (auto ok = facet(); !ok) return unexpected(ok.error());
      } else {
        return unexpected(expected_instead(in_solid_ ? "'facet' or 'endsolid'" : "'solid'", word));
      }
    }
  }

 private:
  tl::expected<void, std::string> facet() {
    if (mesh_.triangles.size() == max_triangles_)
      return unexpected(too_many(max_triangles_ + 1, max_triangles_));
    if (auto ok = word("normal"); !ok) return ok;
    for (int i = 0; i < 3; ++i) words_.next();  // often wrong or `nan`; not used
    if (auto ok = word("outer"); !ok) return ok;
    if (auto ok = word("loop"); !ok) return ok;
    for (int k = 0; k < 3; ++k)
      if (auto ok = vertex(); !ok) return ok;
    if (auto ok = word("endloop"); !ok) return ok;
    if (auto ok = word("endfacet"); !ok) return ok;
    add_triangle(mesh_);
    return {};
  }

  tl::expected<void, std::string> vertex() {
    if (auto ok = word("vertex"); !ok) return ok;
    Vec3 p;
    for (int c = 0; c < 3; ++c) {
      const std::string_view text = words_.next();
      const auto value = coordinate(text);
      if (!value) return unexpected(expected_instead("a coordinate", text));
      p[c] = *value;
    }
    mesh_.vertices.push_back(p);
    return {};
  }

  tl::expected<void, std::string> word(std::string_view wanted) {
    const std::string_view text = words_.next();
    if (same_word(text, wanted)) return {};
    return unexpected(expected_instead(fmt::format("'{}'", wanted), text));
  }

  std::string expected_instead(std::string_view wanted, std::string_view found) const {
    return fmt::format("is not a valid text STL: line {} should have {} where {} is", words_.line(),
                       wanted, shown(found));
  }

  Words words_;
  std::size_t max_triangles_;
  TriangleMesh mesh_;
  bool in_solid_ = false;
};

bool begins_with_solid(std::string_view bytes) { return same_word(bytes.substr(0, 5), "solid"); }

void put_u32(std::string& out, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xffu));
}

void put_point(std::string& out, const Vec3& p) {
  for (int c = 0; c < 3; ++c) put_u32(out, std::bit_cast<std::uint32_t>(static_cast<float>(p[c])));
}

}  // namespace

Result read_stl(std::string_view bytes, std::size_t max_triangles) {
  if (bytes.size() >= header_bytes) {
    const std::size_t count = little_u32(bytes, 80);
    if (header_bytes + triangle_bytes * count == bytes.size())
      return read_binary(bytes, max_triangles);
  }
  if (begins_with_solid(bytes)) return TextReader(bytes, max_triangles).read();
  if (bytes.size() < header_bytes)
    return unexpected(
        fmt::format("is no STL file: it has {} bytes and does not begin with 'solid'; a binary STL "
                    "has at least {}",
                    bytes.size(), header_bytes));
  const std::size_t count = little_u32(bytes, 80);
  const std::size_t wanted = header_bytes + triangle_bytes * count;
  return unexpected(
      fmt::format("is {} as a binary STL: {} triangles need {} bytes, the file has {}",
                  wanted > bytes.size() ? "truncated" : "too long", count, wanted, bytes.size()));
}

}  // namespace aircut::geometry

namespace aircut {

std::string stl_bytes(const TriangleMesh& mesh) {
  std::string out = "aircut, mm";  // must not begin with "solid"
  out.resize(80, ' ');
  geometry::put_u32(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  out.reserve(geometry::header_bytes + geometry::triangle_bytes * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 n = (b - a).cross(c - a);
    geometry::put_point(out, n.norm() > 0 ? Vec3(n.normalized()) : Vec3(Vec3::Zero()));
    for (const Vec3* p : {&a, &b, &c}) geometry::put_point(out, *p);
    out.append(2, '\0');
  }
  return out;
}

}  // namespace aircut
