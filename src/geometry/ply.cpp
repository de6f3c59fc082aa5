// PLY: a text header that lists elements with their properties, then the elements' values one after
// the other, as text or as binary numbers of either byte order. Of all this only `vertex` x y z and
// the list `vertex_indices` (or `vertex_index`) of `face` are kept; the rest is stepped over.
#include "geometry/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/polygon.h"

namespace aircut::geometry {
namespace {

using Problem = tl::unexpected<std::string>;
template <class T>
using Result = tl::expected<T, std::string>;

Problem problem(std::string text) { return Problem(std::move(text)); }

enum class Form { text, little, big };

struct NumberType {
  std::size_t size = 0;  ///< bytes
  bool is_float = false, is_signed = false;
};

std::optional<NumberType> number_type(std::string_view name) {
  struct Row {
    std::string_view name;
    NumberType type;
  };
  static constexpr Row rows[] = {
      {"char", {1, false, true}},    {"int8", {1, false, true}},    {"uchar", {1, false, false}},
      {"uint8", {1, false, false}},  {"short", {2, false, true}},   {"int16", {2, false, true}},
      {"ushort", {2, false, false}}, {"uint16", {2, false, false}}, {"int", {4, false, true}},
      {"int32", {4, false, true}},   {"uint", {4, false, false}},   {"uint32", {4, false, false}},
      {"float", {4, true, true}},    {"float32", {4, true, true}},  {"double", {8, true, true}},
      {"float64", {8, true, true}}};
  for (const Row& row : rows)
    if (row.name == name) return row.type;
  return std::nullopt;
}

struct Property {
  std::string name;
  NumberType type;
  std::optional<NumberType> count;  ///< of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Form form = Form::text;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes up to the first value
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> out;
  std::size_t at = 0;
  while (true) {
    at = line.find_first_not_of(" \t\r", at);
    if (at == std::string_view::npos) return out;
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    out.push_back(line.substr(at, end - at));
    at = end;
  }
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;
  return printable(text.substr(0, longest));
}

Result<void> add_property(Header& header, const std::vector<std::string_view>& words) {
  if (header.elements.empty()) return problem("has a property before the first element");
  Property property;
  std::optional<NumberType> type;
  if (words.size() == 5 && words[1] == "list") {
    property.count = number_type(words[2]);
    if (!property.count || property.count->is_float)
      return problem(fmt::format("has a list counted in '{}'", shown(words[2])));
    type = number_type(words[3]);
  } else if (words.size() == 3) {
    type = number_type(words[1]);
  }
  if (!type) return problem("has a property of unknown type");
  property.type = *type;
  property.name = std::string(words.back());
  header.elements.back().properties.push_back(std::move(property));
  return {};
}

Result<void> add_line(Header& header, std::string_view line) {
  const auto words = words_of(line);
  if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return {};
  if (words[0] == "property") return add_property(header, words);
  if (words[0] == "format" && words.size() == 3) {
    if (words[1] == "ascii")
      header.form = Form::text;
    else if (words[1] == "binary_little_endian")
      header.form = Form::little;
    else if (words[1] == "binary_big_endian")
      header.form = Form::big;
    else
      return problem(fmt::format("has the unknown form '{}'", shown(words[1])));
    return {};
  }
  if (words[0] == "element" && words.size() == 3) {
    Element element{std::string(words[1]), 0, {}};
    const auto [end, error] =
        std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
    if (error != std::errc() || end != words[2].data() + words[2].size())
      return problem(fmt::format("has '{}' where a count of elements should be", shown(words[2])));
    header.elements.push_back(std::move(element));
    return {};
  }
  return problem(fmt::format("has the header line '{}', which PLY doesn't know", shown(line)));
}

Result<Header> read_header(std::string_view bytes) {
  Header header;
  std::size_t at = 0;
  for (bool first = true;; first = false) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos)
      return problem(first ? "is no PLY file" : "is truncated: its header has no 'end_header'");
    std::string_view line = bytes.substr(at, end - at);
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    at = end + 1;
    if (first && line != "ply") return problem("is no PLY file: its first line is not 'ply'");
    if (first) continue;
    if (line == "end_header") break;
    if (auto ok = add_line(header, line); !ok) return problem(ok.error());
  }
  header.size = at;
  return header;
}

/// Values one after the other, whatever the form.
class Values {
 public:
  Values(std::string_view bytes, Form form) : bytes_(bytes), form_(form) {}

  std::optional<double> next(const NumberType& type) {
    return form_ == Form::text ? next_word() : next_binary(type);
  }

 private:
  std::optional<double> next_word() {
    at_ = std::min(bytes_.find_first_not_of(" \t\r\n", at_), bytes_.size());
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", at_), bytes_.size());
    std::string_view word = bytes_.substr(at_, end - at_);
    at_ = end;
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    double value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size()) return std::nullopt;
    return value;
  }

  std::optional<double> next_binary(const NumberType& type) {
    if (bytes_.size() - at_ < type.size) return std::nullopt;
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < type.size; ++i) {
      const std::size_t k = form_ == Form::little ? type.size - 1 - i : i;
      raw = raw << 8 | static_cast<unsigned char>(bytes_[at_ + k]);
    }
    at_ += type.size;
    if (type.is_float)
      return type.size == 4
                 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)))
                 : std::bit_cast<double>(raw);
    if (type.is_signed && (raw >> (8 * type.size - 1)) != 0)
      return static_cast<double>(raw) - std::ldexp(1.0, static_cast<int>(8 * type.size));
    return static_cast<double>(raw);
  }

  std::string_view bytes_;
  Form form_;
  std::size_t at_ = 0;
};

/// Reads the elements in the header's order.
class Reader {
 public:
  Reader(Values values, std::size_t max_triangles)
      : values_(values), max_triangles_(max_triangles) {}

  Result<TriangleMesh> read(const Header& header) {
    for (const Element& element : header.elements)
      for (std::size_t i = 0; i < element.count; ++i)
        if (auto ok = read_item(element, i); !ok) return problem(ok.error());
    // Faces may stand before the vertices they use.
    for (const auto& face : faces_) {
      for (const std::uint32_t v : face)
        if (v >= mesh_.vertices.size())
          return problem(fmt::format("has a face with vertex {}, but only {} vertices", v,
                                     mesh_.vertices.size()));
      append_polygon(mesh_, face);
    }
    return std::move(mesh_);
  }

 private:
  Result<void> read_item(const Element& element, std::size_t number) {
    const auto truncated = [&] {
      return problem(fmt::format("is truncated or broken at {} {} of {}", shown(element.name),
                                 number + 1, element.count));
    };
    // An element without values would let a large count run without end.
    if (element.properties.empty()) return problem("has an element without properties");
    Vec3 p = Vec3::Constant(std::nan(""));
    for (const Property& property : element.properties) {
      if (property.count) {
        if (auto ok = read_list(element, property); !ok)
          return ok.error().empty() ? truncated() : problem(ok.error());
        continue;
      }
      const auto value = values_.next(property.type);
      if (!value) return truncated();
      if (property.name == "x") p.x() = *value;
      if (property.name == "y") p.y() = *value;
      if (property.name == "z") p.z() = *value;
    }
    if (element.name == "vertex") mesh_.vertices.push_back(p);
    return {};
  }

  /// An empty error means that the values ended.
  Result<void> read_list(const Element& element, const Property& property) {
    const auto count = values_.next(*property.count);
    if (!count || !(*count >= 0) || *count != std::floor(*count)) return problem("");
    const bool wanted = element.name == "face" &&
                        (property.name == "vertex_indices" || property.name == "vertex_index");
    std::vector<std::uint32_t> face;
    for (double i = 0; i < *count; ++i) {
      const auto value = values_.next(property.type);
      if (!value) return problem("");
      if (!wanted) continue;
      if (!(*value >= 0) || *value > 4294967294.0 || *value != std::floor(*value))
        return problem(fmt::format("has {} as the number of a vertex", *value));
      face.push_back(static_cast<std::uint32_t>(*value));
    }
    if (face.size() < 3) return {};
    triangles_ += face.size() - 2;
    if (triangles_ > max_triangles_)
      return problem(fmt::format("has more triangles than the limit of {}", max_triangles_));
    faces_.push_back(std::move(face));
    return {};
  }

  Values values_;
  std::size_t max_triangles_;
  std::size_t triangles_ = 0;
  TriangleMesh mesh_;
  std::vector<std::vector<std::uint32_t>> faces_;
};

}  // namespace

Result<TriangleMesh> read_ply(std::string_view bytes, std::size_t max_triangles) {
  const auto header = read_header(bytes);
  if (!header) return problem(header.error());
  return Reader(Values(bytes.substr(header->size), header->form), max_triangles).read(*header);
}

}  // namespace aircut::geometry
