#include <algorithm>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>

#include "urdf/urdf.h"

namespace aircut::urdf {
namespace {

constexpr double mm = 1000;  // per metre
constexpr double farthest_mm = 1e6;
constexpr std::size_t most_parts = 1000;

class Reader {
 public:
  Reader(const SourceText& text, Diagnostics& out) : text_(text), out_(out) {
    for (std::size_t at = 0; at < text.content().size(); ++at)
      if (text.content()[at] == '\n') line_ends_.push_back(at);
  }

  std::optional<Robot> read() {
    pugi::xml_document document;
    const auto parsed = document.load_buffer(text_.content().data(), text_.content().size(),
                                             pugi::parse_default, pugi::encoding_utf8);
    if (!parsed) {
      fail(place(static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)), 1),
           std::string("this is no XML: ") + parsed.description());
      return std::nullopt;
    }
    const pugi::xml_node top = document.child("robot");
    if (!top) {
      fail(place(0, 1), "the file has no <robot>; a URDF file is XML with <robot name=\"…\">");
      return std::nullopt;
    }
    Robot robot;
    robot.name = top.attribute("name").value();
    robot.span = span_of(top);
    for (const pugi::xml_node node : top.children()) {
      if (node.type() != pugi::node_element) continue;
      const std::string_view name = node.name();
      if (robot.links.size() + robot.joints.size() >= most_parts) {
        fail(span_of(node), "the robot has more than 1000 links and joints");
        break;
      }
      if (name == "link")
        robot.links.push_back(link(node));
      else if (name == "joint")
        joint(node, robot);
      else if (name != "material" && name != "transmission" && name != "gazebo" && name != "sensor")
        out_.warning("urdf_not_modelled", span_of(node),
                     "<" + printable(name) + "> is not understood here");
    }
    return robot;
  }

 private:
  SourceSpan place(std::size_t offset, std::size_t length) const {
    const std::string_view all = text_.content();
    offset = std::min(offset, all.size());
    const auto line = std::lower_bound(line_ends_.begin(), line_ends_.end(), offset);
    const std::size_t end = line == line_ends_.end() ? all.size() : *line;
    return {&text_, offset, static_cast<std::uint32_t>(std::min(length, end - offset)),
            static_cast<std::uint64_t>(line - line_ends_.begin()) + 1};
  }
  SourceSpan span_of(const pugi::xml_node& node) const {
    const std::ptrdiff_t offset = node.offset_debug();
    return place(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)),
                 std::string_view(node.name()).size());
  }
  void fail(const SourceSpan& span, std::string message) {
    out_.error("urdf_invalid", span, std::move(message));
  }

  // `count` numbers with blanks between them.
  std::optional<std::vector<double>> numbers(const pugi::xml_node& node, const char* attribute,
                                             std::size_t count) {
    const pugi::xml_attribute given = node.attribute(attribute);
    if (!given) return std::nullopt;
    std::vector<double> values;
    const std::string_view text = given.value();
    bool good = true;
    for (std::size_t at = 0; at < text.size() && good;) {
      at = text.find_first_not_of(" \t\r\n", at);
      if (at == text.npos) break;
      const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
      std::string_view word = text.substr(at, end - at);
      if (word.starts_with('+')) word.remove_prefix(1);
      double value = 0;
      const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      good = error == std::errc() && last == word.data() + word.size() && std::isfinite(value) &&
             std::fabs(value) <= 1e9;
      values.push_back(value);
      at = end;
    }
    if (good && values.size() == count) return values;
    fail(span_of(node), std::string(attribute) + "=\"" + printable(text) + "\" must be " +
                            (count == 1 ? "a number" : std::to_string(count) + " numbers"));
    return std::nullopt;
  }
  std::optional<double> number(const pugi::xml_node& node, const char* attribute) {
    const auto values = numbers(node, attribute, 1);
    return values ? std::optional(values->front()) : std::nullopt;
  }
  double positive(const pugi::xml_node& node, const char* attribute) {
    const auto value = number(node, attribute);
    if (value && *value > 0) return *value * mm;
    if (value || !node.attribute(attribute))
      fail(span_of(node), std::string("<") + node.name() + "> needs " + attribute + " above 0");
    return 1;
  }

  // <origin xyz="…" rpy="…">: turned about the fixed X, then Y, then Z axis, then shifted.
  Pose origin(const pugi::xml_node& parent) {
    const pugi::xml_node node = parent.child("origin");
    Pose X = Pose::Identity();
    if (const auto xyz = numbers(node, "xyz", 3))
      X.translation() = Vec3((*xyz)[0], (*xyz)[1], (*xyz)[2]) * mm;
    if (!(X.translation().cwiseAbs().maxCoeff() <= farthest_mm)) {
      fail(span_of(node), "the origin is farther than 1 km away");
      X.translation().setZero();
    }
    if (const auto rpy = numbers(node, "rpy", 3))
      X.linear() = (Eigen::AngleAxisd((*rpy)[2], Vec3::UnitZ()) *
                    Eigen::AngleAxisd((*rpy)[1], Vec3::UnitY()) *
                    Eigen::AngleAxisd((*rpy)[0], Vec3::UnitX()))
                       .toRotationMatrix();
    return X;
  }

  void solid(const pugi::xml_node& node, std::vector<Solid>& out) {
    Solid s;
    s.span = span_of(node);
    s.X_LS = origin(node);
    const pugi::xml_node geometry = node.child("geometry");
    if (const pugi::xml_node mesh = geometry.child("mesh")) {
      s.span = span_of(mesh);
      s.file = mesh.attribute("filename").value();
      if (s.file.empty()) return fail(s.span, "<mesh> needs filename=\"…\"");
      if (const auto scale = numbers(mesh, "scale", 3))
        s.scale = Vec3((*scale)[0], (*scale)[1], (*scale)[2]);
      if (s.scale.cwiseAbs().minCoeff() == 0) return fail(s.span, "scale must not be 0");
    } else if (const pugi::xml_node box = geometry.child("box")) {
      s.shape = Shape::box;
      const auto size = numbers(box, "size", 3);
      if (size) s.size = Vec3((*size)[0], (*size)[1], (*size)[2]) * mm;
      if (!size && box.attribute("size")) return;  // told
      if (!(s.size.minCoeff() > 0)) return fail(span_of(box), "<box> needs size above 0");
    } else if (const pugi::xml_node cylinder = geometry.child("cylinder")) {
      s.shape = Shape::cylinder;
      s.radius = positive(cylinder, "radius");
      s.length = positive(cylinder, "length");
    } else if (const pugi::xml_node sphere = geometry.child("sphere")) {
      s.shape = Shape::sphere;
      s.radius = positive(sphere, "radius");
    } else {
      return fail(s.span, std::string("<") + node.name() +
                              "> needs <geometry> with a mesh, box, cylinder or sphere");
    }
    out.push_back(std::move(s));
  }

  std::string name_of(const pugi::xml_node& node) {
    const std::string name = node.attribute("name").value();
    if (name.empty()) fail(span_of(node), std::string("<") + node.name() + "> needs a name");
    return name;
  }

  Link link(const pugi::xml_node& node) {
    Link l;
    l.span = span_of(node);
    l.name = name_of(node);
    for (const pugi::xml_node child : node.children()) {
      const std::string_view name = child.name();
      if (name == "visual")
        solid(child, l.visual);
      else if (name == "collision")
        solid(child, l.collision);
      else if (child.type() == pugi::node_element && name != "inertial")
        out_.warning("urdf_not_modelled", span_of(child),
                     "<" + printable(name) + "> of a link is not understood here");
    }
    return l;
  }

  void joint(const pugi::xml_node& node, Robot& robot) {
    Joint j;
    j.span = span_of(node);
    j.name = name_of(node);
    const std::string type = node.attribute("type").value();
    if (type == "revolute")
      j.type = JointType::revolute;
    else if (type == "continuous")
      j.type = JointType::continuous;
    else if (type == "prismatic")
      j.type = JointType::prismatic;
    else if (type == "floating" || type == "planar")
      fail(j.span, "joint '" + printable(j.name) + "' is " + type +
                       ": it has several freedoms at once and no drive; describe it by single "
                       "joints, or as fixed");
    else if (type != "fixed")
      fail(j.span, "joint '" + printable(j.name) + "' has the type '" + printable(type) +
                       "'; there are revolute, continuous, prismatic and fixed");
    const pugi::xml_node parent = node.child("parent"), child = node.child("child");
    j.parent = parent.attribute("link").value();
    j.child = child.attribute("link").value();
    if (j.parent.empty() || j.child.empty())
      return fail(j.span, "joint '" + printable(j.name) +
                              "' needs <parent link=\"…\"/> and <child link=\"…\"/>");
    j.parent_span = span_of(parent);
    j.child_span = span_of(child);
    j.X_PJ = origin(node);
    j.mimics = static_cast<bool>(node.child("mimic"));
    if (const auto axis = numbers(node.child("axis"), "xyz", 3))
      j.axis = Vec3((*axis)[0], (*axis)[1], (*axis)[2]);
    if (!(j.axis.norm() > 1e-9)) {
      fail(span_of(node.child("axis")),
           "the axis of joint '" + printable(j.name) + "' has no direction");
      j.axis = Vec3::UnitX();
    }
    j.axis.normalize();
    if (j.type != JointType::fixed) limits(node, j);
    robot.joints.push_back(std::move(j));
  }

  void limits(const pugi::xml_node& node, Joint& j) {
    const pugi::xml_node limit = node.child("limit");
    if (!limit)
      return fail(j.span, "joint '" + printable(j.name) +
                              "' needs <limit lower=\"…\" upper=\"…\" velocity=\"…\"/>");
    const double unit = j.type == JointType::prismatic ? mm : 1;
    j.lower = number(limit, "lower").value_or(0) * unit;
    j.upper = number(limit, "upper").value_or(0) * unit;
    j.velocity = number(limit, "velocity").value_or(0) * unit;
    if (j.type != JointType::continuous && !(j.lower <= j.upper))
      fail(span_of(limit), "lower is above upper");
    if (!(j.velocity > 0)) fail(span_of(limit), "<limit> needs velocity above 0");
  }

  const SourceText& text_;
  Diagnostics& out_;
  std::vector<std::size_t> line_ends_;
};

}  // namespace

Expected<Robot> read_robot(const SourceText& text, Diagnostics& out) {
  const std::size_t before = out.errors();
  auto robot = Reader(text, out).read();
  if (robot && out.errors() == before) return std::move(*robot);
  return unexpected(make_error("urdf_invalid", "the robot's description has errors"));
}

const std::vector<KindText>& kinds() {
  static const std::vector<KindText> all = {
      {"urdf_invalid", "a robot's description that can't be used",
       "Links form a tree of single joints (revolute, continuous, prismatic, fixed) with limits, "
       "and "
       "its meshes are there. Example: two joints with the same child."},
      {"urdf_not_modelled", "something in a robot's description that is not looked at",
       "Warning. The verdict is unknown where it could matter. Example: a joint that mimics "
       "another."},
  };
  return all;
}

}  // namespace aircut::urdf
