// Writing 3MF: a zip archive of three XML files. Only what the core specification asks for: one
// object with vertices and triangles, in mm.
//
// Each entry is a local header, its deflated bytes, and a row of the directory at the end. The time
// in the headers is the earliest that zip knows, so that the same mesh gives the same bytes.
#include <fmt/format.h>

#include <iterator>

#include "base/deflate.h"
#include "report/report.h"

namespace aircut::report {

namespace {

constexpr const char* content_types =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" "
    "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";
constexpr const char* relations =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

std::string model_of(const TriangleMesh& mesh) {
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
      "<metadata name=\"Application\">aircut</metadata>\n"
      "<resources><object id=\"1\" type=\"model\"><mesh><vertices>\n";
  // Single precision, as in STL, in the shortest digits that read back to it.
  const auto to = std::back_inserter(out);
  for (const Vec3& v : mesh.vertices)
    fmt::format_to(to, "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", static_cast<float>(v.x()),
                   static_cast<float>(v.y()), static_cast<float>(v.z()));
  out += "</vertices><triangles>\n";
  for (const auto& t : mesh.triangles)
    fmt::format_to(to, "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", t[0], t[1], t[2]);
  out +=
      "</triangles></mesh></object></resources>\n<build><item objectid=\"1\"/></build></model>\n";
  return out;
}

class Zip {
 public:
  void add(const std::string& name, const std::string& bytes) {
    const std::string packed = deflated(bytes);
    const std::uint32_t sum = crc32_of(bytes);
    const std::size_t offset = out_.size();
    std::string head;  // what the local header and the directory have in common
    put(head, 20, 2);  // version 2.0: deflate
    put(head, 0, 2);
    put(head, 8, 2);       // deflated
    put(head, 0, 2);       // 0:00
    put(head, 0x0021, 2);  // 1 January 1980
    put(head, sum, 4);
    put(head, packed.size(), 4);
    put(head, bytes.size(), 4);
    put(head, name.size(), 2);
    put(head, 0, 2);
    out_ += "PK\x03\x04" + head + name + packed;
    directory_ += "PK\x01\x02";
    put(directory_, 20, 2);
    directory_ += head;
    put(directory_, 0, 2);  // comment
    put(directory_, 0, 2);  // disk
    put(directory_, 0, 2);  // attributes
    put(directory_, 0, 4);
    put(directory_, offset, 4);
    directory_ += name;
    ++count_;
  }

  std::string finish() {
    const std::size_t offset = out_.size();
    out_ += directory_ + "PK\x05\x06";
    put(out_, 0, 4);
    put(out_, count_, 2);
    put(out_, count_, 2);
    put(out_, directory_.size(), 4);
    put(out_, offset, 4);
    put(out_, 0, 2);
    return std::move(out_);
  }

 private:
  static void put(std::string& out, std::size_t value, int bytes) {
    for (int byte = 0; byte < bytes; ++byte) out += static_cast<char>(value >> (8 * byte) & 255);
  }
  std::string out_, directory_;
  std::size_t count_ = 0;
};

}  // namespace

std::string three_mf_bytes(const TriangleMesh& mesh) {
  Zip zip;
  zip.add("[Content_Types].xml", content_types);
  zip.add("_rels/.rels", relations);
  zip.add("3D/3dmodel.model", model_of(mesh));
  return zip.finish();
}

}  // namespace aircut::report
