// Idea: while the run goes on, only moments are kept (a few numbers each), never pictures or all of
// the path. The evenly spaced ones are thinned by doubling their spacing, so memory is bounded and
// no second run is needed. Pictures are drawn at the end.

#include "report/frames.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <set>

namespace aircut::report {

namespace {

constexpr double degrees = 180 / M_PI;
constexpr std::size_t most_moments = 4096;  // before thinning
constexpr std::size_t most_path_points = 60'000;
constexpr std::size_t most_frames = 10'000;  // of one run
constexpr std::size_t most_finding_frames = 50;
constexpr std::size_t most_sheet_cells = 24;

Snapshot snapshot_at(const sim::Step& step, double t) {
  Snapshot shot;
  shot.t = t;
  shot.tool = step.scene.loaded_tool();
  shot.span = step.span();
  shot.kind = step.segment.kind;
  if (const auto state = step.motion.state_at(t)) {
    shot.joints = state->q;
    shot.feed = state->path_speed;
  }
  return shot;
}

struct PathPoint {
  Vec3 p;  // M coordinates, mm
  double t = 0;
  plan::MotionKind kind = plan::MotionKind::idle;
};

// The tool path as a polyline of bounded size: when it is full, every second point goes and the
// spacing doubles.
class PathRecorder {
 public:
  void add(const sim::Step& step) {
    const plan::Segment& segment = step.segment;
    if (std::holds_alternative<plan::Hold>(segment.path) || segment.duration() <= 0) return;
    const double length = plan::length(segment.path);
    const plan::MotionKind kind = std::holds_alternative<canon::Rapid>(segment.command.action)
                                      ? plan::MotionKind::rapid
                                      : segment.kind;
    int pieces = 1;
    if (const auto* arc = std::get_if<plan::Arc>(&segment.path)) {
      constexpr double widest_chord = 6 / degrees;  // rad
      pieces = std::clamp(static_cast<int>(std::ceil(std::abs(arc->angle) / widest_chord)), 2, 720);
    } else if (std::holds_alternative<plan::Blend>(segment.path)) {
      pieces = 6;
    }
    for (int i = points_.empty() ? 0 : 1; i <= pieces; ++i) {
      const double t = segment.t_start + segment.duration() * i / pieces;
      const AxisValues tip = plan::evaluate(segment.path, std::min(length, length * i / pieces)).p;
      push({Vec3(tip[Axis::x], tip[Axis::y], tip[Axis::z]), t, kind});
    }
  }

  // Runs of one kind, split at time `now` into done and to come.
  std::vector<render::DrawLine> lines(const Pose& X_WM, double now) const {
    std::vector<render::DrawLine> out;
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const render::LineKind kind =
          points_[i].t <= now ? render::LineKind::done : line_kind(points_[i].kind);
      if (out.empty() || out.back().kind != kind) out.push_back({kind, {X_WM * points_[i - 1].p}});
      out.back().points.push_back(X_WM * points_[i].p);
    }
    return out;
  }

  // Of the feed moves; of all moves when there are none.
  Box3 box(const Pose& X_WM) const {
    Box3 feed, all;
    for (const PathPoint& point : points_) {
      all.extend(X_WM * point.p);
      if (point.kind != plan::MotionKind::rapid) feed.extend(X_WM * point.p);
    }
    return feed.isEmpty() ? all : feed;
  }

 private:
  static render::LineKind line_kind(plan::MotionKind kind) {
    if (kind == plan::MotionKind::rapid) return render::LineKind::rapid;
    if (kind == plan::MotionKind::arc) return render::LineKind::arc;
    return render::LineKind::feed;
  }

  void push(const PathPoint& point) {
    if (!points_.empty() && points_.back().kind == point.kind &&
        (points_.back().p - point.p).norm() < spacing_)
      return;
    points_.push_back(point);
    if (points_.size() < most_path_points) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
    points_.resize(kept);
    spacing_ = std::max(0.02, spacing_ * 2);
  }

  std::vector<PathPoint> points_;
  double spacing_ = 0.01;  // mm
};

Diagnostic usage(const std::string& message) { return make_error("usage", message); }

Expected<void> make_folder(const std::string& path) {
  if (::mkdir(path.c_str(), 0755) == 0 || errno == EEXIST) return {};
  return unexpected(make_error(
      "output_failed", "can't make the folder '" + printable(path) + "': " + std::strerror(errno)));
}

std::string file_name_part(std::string_view text) {
  std::string out;
  for (const char c : text)
    out += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '-';
  return out;
}

std::string padded_time(double t) {
  std::string text = fixed(t, 3);
  return std::string(text.size() < 9 ? 9 - text.size() : 0, '0') + text;
}

}  // namespace

Expected<void> add_frames(FrameSpec& spec, const std::string& text) {
  const auto help = [&](const std::string& what, const std::string& hint = "") {
    return unexpected(usage(
        "--frames " + printable(text) + ": " + what +
        "; it takes every=2s, at=12.5,80, line=128, tool-change, finding or count=24." + hint));
  };
  if (text == "finding") {
    spec.findings = true;
    return {};
  }
  if (text == "tool-change") {
    spec.tool_changes = true;
    return {};
  }
  const std::size_t equals = text.find('=');
  const std::string key = text.substr(0, equals);
  const std::vector<std::string> known = {"every", "at", "line", "count", "finding", "tool-change"};
  if (std::find(known.begin(), known.end(), key) == known.end())
    return help("'" + printable(key) + "' is not known", did_you_mean(key, known));
  if (equals == std::string::npos) return help("'" + key + "' needs a value");
  std::vector<double> values;
  std::string rest = text.substr(equals + 1);
  while (true) {
    const std::size_t comma = rest.find(',');
    std::string item = rest.substr(0, comma);
    if (key == "every" && item.ends_with("s")) item.pop_back();
    const auto value = parse_number(item);
    if (!value || *value < 0) return help("'" + printable(item) + "' is not a number of 0 or more");
    values.push_back(*value);
    if (comma == std::string::npos) break;
    rest = rest.substr(comma + 1);
  }
  const auto whole = [](double v) { return v == std::floor(v) && v >= 1 && v <= 4e9; };
  if (key == "at") {
    spec.at.insert(spec.at.end(), values.begin(), values.end());
  } else if (key == "line") {
    for (const double v : values) {
      if (!whole(v)) return help("a line is a whole number from 1");
      spec.lines.push_back(static_cast<std::uint32_t>(v));
    }
  } else if (values.size() != 1) {
    return help("'" + key + "' takes one number");
  } else if (key == "every") {
    if (values[0] <= 0) return help("the time between frames must be above 0");
    spec.every = values[0];
  } else {
    if (!whole(values[0]) || values[0] > static_cast<double>(most_frames))
      return help("the count must be a whole number from 1 to " + std::to_string(most_frames));
    spec.count = static_cast<int>(values[0]);
  }
  return {};
}

std::vector<render::DrawBody> draw_bodies(const sim::Scene& scene,
                                          const machine::JointVector& joints) {
  machine::LinkPoses poses;
  machine::forward(scene.machine(), joints, poses);
  std::vector<render::DrawBody> out;
  for (const sim::SceneBody& item : scene.bodies()) {
    if (!item.body.mesh) continue;
    render::DrawBody body;
    body.name = item.body.name;
    body.mesh = item.body.mesh;
    body.X_WB = poses.X_WL[static_cast<std::size_t>(index(item.body.link))] * item.body.X_LB;
    body.color = item.body.color;
    out.push_back(std::move(body));
  }
  return out;
}

struct FrameMaker::Impl {
  Impl(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools,
       FrameOptions o)
      : scene(std::move(machine), tools), options(std::move(o)) {}

  // Evenly spaced candidates; `tick` is their spacing.
  void add_moments(const sim::Step& step) {
    while (next_moment <= step.segment.t_end()) {
      moments.push_back(snapshot_at(step, next_moment));
      next_moment += tick;
      if (moments.size() < most_moments) continue;
      std::size_t kept = 0;
      for (std::size_t i = 0; i < moments.size(); i += 2) moments[kept++] = moments[i];
      moments.resize(kept);
      tick *= 2;
      next_moment = moments.back().t + tick;
    }
  }

  void add_named(const sim::Step& step) {
    const double t0 = step.segment.t_start, t1 = step.segment.t_end();
    const auto add = [&](const std::string& name, double t) {
      if (named.size() < most_frames) named.push_back({name, snapshot_at(step, t)});
    };
    for (const double t : options.spec.at)
      if ((t >= t0 && t < t1) || (t == t0 && t1 == t0 && !told_at.contains(t)))
        if (told_at.insert(t).second) add("t" + padded_time(t), t);
    if (options.spec.every)
      while (every_next <= t1) {
        add("t" + padded_time(every_next), every_next);
        every_next = *options.spec.every * static_cast<double>(++every_count);
      }
    const bool moves = !std::holds_alternative<plan::Hold>(step.segment.path);
    for (const std::uint32_t line : options.spec.lines)
      if (moves && step.span().line == line && !step.span().calls && told_lines.insert(line).second)
        add("line-" + std::to_string(line), t1);
    if (options.spec.tool_changes && step.segment.kind == plan::MotionKind::tool_change)
      add("tool-change-" + padded_time(t1), t1);
  }

  std::vector<Snapshot> evenly(int count) const {
    std::vector<Snapshot> out;
    if (moments.empty()) return out;
    const double end = moments.back().t;
    for (int i = 0; i < count; ++i) {
      const double want = count == 1 ? end : end * i / (count - 1);
      const auto at = std::lower_bound(moments.begin(), moments.end(), want,
                                       [](const Snapshot& s, double t) { return s.t < t; });
      const auto before = at == moments.begin() ? at : at - 1;
      const auto nearest = at == moments.end() || want - before->t < at->t - want ? before : at;
      if (out.empty() || out.back().t < nearest->t) out.push_back(*nearest);
    }
    return out;
  }

  Pose X_WM(const machine::JointVector& joints) const {
    machine::LinkPoses poses;
    machine::forward(scene.machine(), joints, poses);
    return poses.X_WL[static_cast<std::size_t>(index(scene.machine().work_link()))] *
           scene.machine().X_LM();
  }

  render::Scene picture(const Snapshot& shot) {
    if (scene.loaded_tool() != shot.tool) scene.load_tool(shot.tool);
    render::Scene out;
    out.bodies = draw_bodies(scene, shot.joints);
    out.lines = path.lines(X_WM(shot.joints), shot.t);
    out.caption.left.push_back(printable(options.program));
    if (shot.span)
      out.caption.left.push_back("line " + std::to_string(shot.span.line) + "   " +
                                 printable(shot.span.line_text()));
    out.caption.right.push_back("t = " + fixed(shot.t, 3) + " s");
    std::string axes;
    for (int j = 0; j < shot.joints.size(); ++j) {
      const machine::Joint& joint = scene.machine().joint(machine::JointId{j});
      const double value =
          joint.kind == machine::JointKind::rotary ? shot.joints[j] * degrees : shot.joints[j];
      axes += (j > 0 ? "   " : "") + joint.name + " " + fixed(value, 3);
    }
    out.caption.right.push_back(axes);
    std::string tool = "no tool";
    if (shot.tool > 0) tool = "T" + std::to_string(shot.tool);
    if (const tool::Tool* loaded = scene.tool(); loaded && !loaded->name.empty())
      tool += "  " + printable(loaded->name);
    out.caption.right.push_back(tool + "   " + std::string(plan::to_string(shot.kind)) + "   " +
                                fixed(shot.feed * 60, 0) + " mm/min");
    return out;
  }

  // What `work` looks at: the feed moves, the fixtures, and room for the tool above them.
  Box3 work_box(const Snapshot& shot, const render::Scene& drawn) const {
    constexpr double room_for_tool = 90;  // mm
    Box3 box = path.box(X_WM(shot.joints));
    if (!box.isEmpty()) box.extend(Vec3(box.max() + Vec3(0, 0, room_for_tool)));
    const auto& bodies = scene.bodies();
    for (std::size_t i = 0, k = 0; i < bodies.size(); ++i) {
      if (!bodies[i].body.mesh) continue;
      const render::DrawBody& body = drawn.bodies[k++];
      const machine::Role role = bodies[i].body.role;
      if (role == machine::Role::fixture || role == machine::Role::part ||
          role == machine::Role::stock)
        box.extend(bounds(*body.mesh).transformed(body.X_WB));
    }
    return box;
  }

  Box3 whole_box(const render::Scene& drawn) const {
    Box3 box;
    for (const render::DrawBody& body : drawn.bodies)
      box.extend(bounds(*body.mesh).transformed(body.X_WB));
    return box;
  }

  Expected<render::Camera> camera_for(const Snapshot& shot, const render::Scene& drawn) const {
    const double aspect = static_cast<double>(options.size.width) / options.size.height;
    if (options.camera != "work")
      return render::camera_by_name(options.camera, whole_box(drawn), aspect);
    Box3 box = work_box(shot, drawn);
    if (box.isEmpty()) box = whole_box(drawn);
    return render::camera_by_name("iso", box, aspect);
  }

  sim::Scene scene;
  FrameOptions options;
  PathRecorder path;
  std::vector<Snapshot> moments;
  double tick = 1.0 / 64, next_moment = 0;
  struct Named {
    std::string name;
    Snapshot shot;
  };
  std::vector<Named> named;
  double every_next = 0;
  std::uint64_t every_count = 0;
  std::set<double> told_at;
  std::set<std::uint32_t> told_lines;
};

FrameMaker::FrameMaker(std::shared_ptr<const machine::Machine> machine,
                       const tool::ToolTable& tools, FrameOptions options)
    : impl_(std::make_unique<Impl>(std::move(machine), tools, std::move(options))) {}
FrameMaker::~FrameMaker() = default;

void FrameMaker::on_start(const sim::Scene&, const machine::JointVector& joints) {
  Snapshot first;
  first.joints = joints;
  impl_->moments.push_back(first);
  impl_->next_moment = impl_->tick;
}

void FrameMaker::on_step(const sim::Step& step) {
  impl_->path.add(step);
  if (impl_->options.spec.count) impl_->add_moments(step);
  impl_->add_named(step);
}

Expected<std::vector<std::string>> FrameMaker::write(const std::string& folder,
                                                     std::vector<sim::Finding>& findings) {
  Impl& impl = *impl_;
  std::vector<std::string> written;
  auto renderer = render::Renderer::create(impl.options.size);
  if (!renderer) return unexpected(renderer.error());
  if (auto made = make_folder(folder + "/frames"); !made) return unexpected(made.error());

  std::vector<render::SheetCell> cells;
  const auto save = [&](const std::string& name, const render::Image& image) -> Expected<void> {
    const std::string relative = "frames/" + name + ".png";
    if (auto done = write_file(folder + "/" + relative, render::png_bytes(image)); !done)
      return done;
    written.push_back(relative);
    return {};
  };
  const auto draw = [&](const std::string& name, const Snapshot& shot,
                        bool in_sheet) -> Expected<void> {
    const render::Scene drawn = impl.picture(shot);
    const auto camera = impl.camera_for(shot, drawn);
    if (!camera) return unexpected(camera.error());
    const render::Image image = renderer->draw(drawn, *camera);
    if (in_sheet && cells.size() < most_sheet_cells)
      cells.push_back({image, "t = " + fixed(shot.t, 2) + " s" +
                                  (shot.span ? "   line " + std::to_string(shot.span.line) : "")});
    return save(name, image);
  };

  if (impl.options.spec.count) {
    int number = 0;
    for (const Snapshot& shot : impl.evenly(*impl.options.spec.count)) {
      std::string index = std::to_string(++number);
      index.insert(0, index.size() < 4 ? 4 - index.size() : 0, '0');
      if (auto done = draw(index, shot, true); !done) return unexpected(done.error());
    }
  }
  for (const auto& item : impl.named)
    if (auto done = draw(item.name, item.shot, !impl.options.spec.count); !done)
      return unexpected(done.error());

  if (impl.options.spec.findings) {
    std::set<std::string> names;
    std::map<int, std::string> picture_of;  // by episode
    for (sim::Finding& f : findings) {
      if (f.joints_worst.size() == 0 || f.severity < Severity::warning) continue;
      if (const auto known = picture_of.find(f.episode); known != picture_of.end()) {
        f.picture = known->second;
        continue;
      }
      if (names.size() >= most_finding_frames) continue;
      std::string name =
          file_name_part(sim::to_string(f.kind)) + "-L" + std::to_string(f.span.line);
      for (int i = 2; !names.insert(name).second; ++i)
        name = file_name_part(sim::to_string(f.kind)) + "-L" + std::to_string(f.span.line) + "-" +
               std::to_string(i);
      Snapshot shot;
      shot.t = f.t_worst;
      shot.joints = f.joints_worst;
      shot.tool = f.tool;
      shot.span = f.span;
      shot.kind = f.motion;
      shot.feed = f.feed_actual;
      render::Scene drawn = impl.picture(shot);
      drawn.caption.alarm = std::string(to_string(f.severity)) + ": " + printable(f.message);
      for (render::DrawBody& body : drawn.bodies)
        body.highlight = body.name == f.body_a || body.name == f.body_b;
      for (const Vec3& point : f.points) drawn.markers.push_back({point});
      render::Camera camera;
      if (!f.points.empty()) {
        constexpr double span = 260;  // mm across: a tool, its holder and what it met
        camera = renderer->camera_for_finding(drawn.bodies, f.points.front(), span);
      } else {
        // No contact: the place on the path, seen as the other frames see the work.
        drawn.markers.push_back(
            {impl.X_WM(f.joints_worst) * Vec3(f.tip[Axis::x], f.tip[Axis::y], f.tip[Axis::z])});
        const auto work = impl.camera_for(shot, drawn);
        if (!work) return unexpected(work.error());
        camera = *work;
      }
      const render::Image image = renderer->draw(drawn, camera);
      if (auto done = save(name, image); !done) return unexpected(done.error());
      f.picture = written.back();
      picture_of[f.episode] = f.picture;
      if (cells.size() < most_sheet_cells)
        cells.push_back({image, std::string(sim::to_string(f.kind)) + "   line " +
                                    std::to_string(f.span.line)});
    }
  }
  if (!cells.empty()) {
    const int columns = cells.size() <= 4 ? 2 : cells.size() <= 9 ? 3 : 4;
    const render::Image sheet =
        render::contact_sheet(cells, columns, 640, printable(impl.options.program));
    if (auto done = write_file(folder + "/sheet.png", render::png_bytes(sheet)); !done)
      return unexpected(done.error());
    written.push_back("sheet.png");
  }
  return written;
}

}  // namespace aircut::report
