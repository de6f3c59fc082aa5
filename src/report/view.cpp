#include "report/view.h"

#include <algorithm>

namespace aircut::report {

namespace {

const std::string fit = "fit=";

Diagnostic usage(const std::string& message) { return make_error("usage", message); }

// A name, or its beginning and a `*`.
bool matches(const std::string& pattern, const std::string& name) {
  if (pattern.ends_with('*')) return name.starts_with(pattern.substr(0, pattern.size() - 1));
  return name == pattern;
}

bool matches_any(const std::vector<std::string>& patterns, const std::string& name) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& p) { return matches(p, name); });
}

}  // namespace

bool View::hides(const std::string& body) const { return matches_any(hidden, body); }

void View::select(std::vector<render::DrawBody>& bodies) const {
  std::erase_if(bodies, [&](const render::DrawBody& body) { return hides(body.name); });
  for (render::DrawBody& body : bodies) body.translucent = matches_any(see_through, body.name);
}

Expected<render::Camera> View::fitted_camera(const std::vector<render::DrawBody>& bodies,
                                             double aspect) const {
  const bool some = camera.starts_with(fit);
  const std::string pattern = some ? camera.substr(fit.size()) : "*";
  Box3 box;
  for (const render::DrawBody& body : bodies)
    if (matches(pattern, body.name)) box.extend(bounds(*body.mesh).transformed(body.X_WB));
  if (some && box.isEmpty())
    return unexpected(usage("--camera " + printable(camera) + ": no such body is drawn"));
  return render::camera_by_name(some ? "iso" : camera, box, aspect);
}

void View::cut_open(render::Scene& drawn, const Pose& X_WM, const render::Camera& from) const {
  if (!section) return;
  render::Section plane{X_WM * Vec3(section->normal * section->at),
                        X_WM.linear() * section->normal};
  if (plane.normal.dot(from.eye - plane.point) < 0) plane.normal = -plane.normal;
  drawn.section = plane;
}

Expected<View::Section> section_of(const std::string& text) {
  const auto at = text.size() > 2 && text[1] == '=' ? parse_number(text.substr(2)) : std::nullopt;
  const std::size_t axis = text.empty() ? std::string::npos : std::string("XYZ").find(text[0]);
  if (!at || axis == std::string::npos)
    return unexpected(usage("--section " + printable(text) +
                            ": write X, Y or Z, = and a number in mm of the work's frame, like "
                            "Y=12.5"));
  View::Section out;
  out.normal = Vec3::Unit(static_cast<Eigen::Index>(axis));
  out.at = *at;
  return out;
}

Expected<void> check_camera(const std::string& name) {
  if (name.starts_with(fit) || name == "work" || name == "tool") return {};
  const auto camera = render::camera_by_name(name, Box3(Vec3(0, 0, 0), Vec3(1, 1, 1)), 1);
  if (!camera) return unexpected(camera.error());
  return {};
}

Expected<void> check_view(const machine::Machine& machine, const View& view) {
  std::vector<std::string> known;
  for (const machine::Body& body : machine.bodies()) known.push_back(body.name);
  const auto check = [&](const char* option, const std::string& pattern) -> Expected<void> {
    const bool of_a_tool =
        pattern.size() > 1 && pattern[0] == 'T' && pattern[1] >= '0' && pattern[1] <= '9';
    if (of_a_tool || std::any_of(known.begin(), known.end(),
                                 [&](const std::string& name) { return matches(pattern, name); }))
      return {};
    return unexpected(usage(std::string(option) + printable(pattern) +
                            ": the machine has no such body." + did_you_mean(pattern, known)));
  };
  for (const std::string& pattern : view.hidden)
    if (auto ok = check("--hide ", pattern); !ok) return ok;
  for (const std::string& pattern : view.see_through)
    if (auto ok = check("--see-through ", pattern); !ok) return ok;
  if (view.camera.starts_with(fit)) return check("--camera fit=", view.camera.substr(fit.size()));
  return {};
}

}  // namespace aircut::report
