// Idea: while the run goes on, only moments are kept (a few numbers each), never pictures or all of
// the path. The evenly spaced ones are thinned by doubling their spacing, so memory is bounded and
// no second run is needed. Pictures are drawn at the end.

#include "report/frames.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <set>

#include "report/path_recorder.h"
#include "report/video.h"

namespace aircut::report {

namespace {

constexpr double degrees = 180 / M_PI;
constexpr std::size_t most_moments = 4096;   // before thinning
constexpr std::size_t most_frames = 10'000;  // of one run
constexpr std::size_t most_finding_frames = 50;
constexpr std::size_t most_sheet_cells = 24;

Snapshot snapshot_at(const sim::Step& step, double t) {
  Snapshot shot;
  shot.t = t;
  shot.tool = step.scene.loaded_tool(step.all ? step.channel : 0);
  if (step.all) shot.tools = step.scene.loaded_tools();
  shot.span = step.span();
  shot.kind = step.segment.kind;
  if (const auto state = step.motion.state_at(t)) {
    shot.joints = state->q;
    shot.feed = state->path_speed;
    shot.tip = Vec3(state->tip[Axis::x], state->tip[Axis::y], state->tip[Axis::z]);
  }
  return shot;
}

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

// Tools that follow one another differ clearly.
machine::Color tool_color(int number) {
  static constexpr std::array<machine::Color, 10> colors = {{{92, 158, 214},
                                                             {240, 160, 70},
                                                             {120, 186, 110},
                                                             {214, 104, 104},
                                                             {160, 134, 200},
                                                             {90, 190, 190},
                                                             {226, 150, 190},
                                                             {176, 176, 90},
                                                             {150, 120, 96},
                                                             {130, 146, 166}}};
  return colors[static_cast<std::size_t>(std::max(number - 1, 0)) % colors.size()];
}

}  // namespace

Expected<void> video_ready() {
  const auto found = find_ffmpeg();
  if (!found) return unexpected(found.error());
  return {};
}

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
  /// A picture to be drawn.
  struct Job {
    std::string name;
    Snapshot shot;
    std::string sheet_text;  ///< empty: not on the sheet
    const sim::Finding* finding = nullptr;
  };
  std::vector<Job> jobs_of(std::vector<sim::Finding>& findings) const;
  Expected<render::Image> draw(const Job& job, render::Renderer& renderer);

  Impl(std::shared_ptr<const machine::Machine> machine, const tool::ToolTable& tools,
       FrameOptions o, std::vector<sim::Seat> seats)
      : scene(std::move(machine), tools, std::move(seats)), options(std::move(o)) {}

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

  // The stock as it is at time t, in place of the raw one.
  Expected<void> put_stock(render::Scene& drawn, double t) {
    if (!stock) return {};
    for (std::size_t i = 0, k = 0; i < scene.bodies().size(); ++i) {
      const machine::Body& body = scene.bodies()[i].body;
      if (!body.mesh) continue;
      if (body.role == machine::Role::stock) {
        if (options.stock_by_tool) return put_stock_by_tool(drawn, k, t);
        auto mesh = stock->at(t);
        if (!mesh) return unexpected(mesh.error());
        drawn.bodies[k].mesh = std::move(*mesh);
      }
      ++k;
    }
    return {};
  }

  Expected<void> put_stock_by_tool(render::Scene& drawn, std::size_t body, double t) {
    const auto pieces = stock->by_tool(t);
    if (!pieces) return unexpected(pieces.error());
    // The raw surface stays in the stock's place: bodies are found by their numbers.
    drawn.bodies[body].mesh = std::make_shared<TriangleMesh>();
    for (const auto& piece : *pieces) {
      if (piece.tool == 0) {
        drawn.bodies[body].mesh = piece.mesh;
        continue;
      }
      render::DrawBody one = drawn.bodies[body];
      one.mesh = piece.mesh;
      one.color = tool_color(piece.tool);
      drawn.bodies.push_back(std::move(one));
      drawn.legend.push_back({"T" + std::to_string(piece.tool), tool_color(piece.tool)});
    }
    return {};
  }

  Expected<render::Scene> picture(const Snapshot& shot) {
    if (!scene.seats().empty())
      scene.load_tools(shot.tools);
    else if (scene.loaded_tool() != shot.tool)
      scene.load_tool(shot.tool);
    render::Scene out;
    out.bodies = draw_bodies(scene, shot.joints);
    if (auto put = put_stock(out, shot.t); !put) return unexpected(put.error());
    options.view.select(out.bodies);
    if (options.path == FrameOptions::Path::kind) out.lines = path.lines(X_WM(shot.joints), shot.t);
    if (options.path == FrameOptions::Path::time) {
      out.lines = path.lines_by_time(X_WM(shot.joints));
      const auto rows = path.legend_of_times();
      out.legend.insert(out.legend.end(), rows.begin(), rows.end());
    }
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
    if (!scene.seats().empty()) {  // the motion is one channel's: it is left out
      std::string tools;
      for (std::size_t i = 0; i < scene.seats().size(); ++i)
        tools += (i > 0 ? "   " : "") + scene.seats()[i].channel + " T" +
                 std::to_string(scene.loaded_tool(i));
      out.caption.right.push_back(tools);
      return out;
    }
    std::string tool = "no tool";
    if (shot.tool > 0) tool = "T" + std::to_string(shot.tool);
    if (const tool::Tool* loaded = scene.tool(); loaded && !loaded->name.empty())
      tool += "  " + printable(loaded->name);
    out.caption.right.push_back(tool + "   " + std::string(plan::to_string(shot.kind)) + "   " +
                                fixed(shot.feed * 60, 0) + " mm/min");
    return out;
  }

  // What `work` looks at: the feed moves, the stock (without one, the fixtures), and room for the
  // tool above them.
  Box3 work_box(const Snapshot& shot, const render::Scene& drawn) const {
    constexpr double room_for_tool = 90;  // mm
    Box3 box = path.box(X_WM(shot.joints));
    if (!box.isEmpty()) box.extend(Vec3(box.max() + Vec3(0, 0, room_for_tool)));
    const auto& bodies = scene.bodies();
    for (std::size_t i = 0, k = 0; i < bodies.size(); ++i) {
      if (!bodies[i].body.mesh || options.view.hides(bodies[i].body.name)) continue;
      const render::DrawBody& body = drawn.bodies[k++];
      const machine::Role role = bodies[i].body.role;
      if (role == machine::Role::part || role == machine::Role::stock ||
          (role == machine::Role::fixture && !scene.machine().stock()))
        box.extend(bounds(*body.mesh).transformed(body.X_WB));
    }
    return box;
  }

  Expected<render::Camera> camera_for(const Snapshot& shot, const render::Scene& drawn) const {
    const double aspect = static_cast<double>(options.size.width) / options.size.height;
    if (options.view.camera == "tool") {
      constexpr double around = 70;  // mm to each side of the tip, and twice as much above it
      const Vec3 tip = X_WM(shot.joints) * shot.tip;
      return render::camera_by_name(
          "iso", Box3(Vec3(tip.array() - around), Vec3(tip + around * Vec3(1, 1, 2))), aspect);
    }
    if (options.view.camera != "work") return options.view.fitted_camera(drawn.bodies, aspect);
    const Box3 box = work_box(shot, drawn);
    if (box.isEmpty()) return View{}.fitted_camera(drawn.bodies, aspect);
    return render::camera_by_name("iso", box, aspect);
  }

  sim::Scene scene;
  FrameOptions options;
  PathRecorder path;
  std::unique_ptr<sim::StockHistory> stock;
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
                       const tool::ToolTable& tools, FrameOptions options,
                       std::vector<sim::Seat> seats)
    : impl_(std::make_unique<Impl>(std::move(machine), tools, std::move(options),
                                   std::move(seats))) {}
FrameMaker::~FrameMaker() = default;

void FrameMaker::on_start(const sim::Scene& scene, const machine::JointVector& joints) {
  Snapshot first;
  first.tools = scene.loaded_tools();
  first.joints = joints;
  impl_->moments.push_back(first);
  impl_->next_moment = impl_->tick;
}

void FrameMaker::on_step(const sim::Step& step) {
  impl_->path.add(step);
  if (impl_->options.spec.count) impl_->add_moments(step);
  impl_->add_named(step);
}

void FrameMaker::set_stock(std::unique_ptr<sim::StockHistory> stock) {
  impl_->stock = std::move(stock);
}

namespace {

std::string four_digits(std::size_t number) {
  std::string text = std::to_string(number);
  return std::string(text.size() < 4 ? 4 - text.size() : 0, '0') + text;
}

Snapshot snapshot_of(const sim::Finding& f) {
  Snapshot shot;
  shot.t = f.t_worst;
  shot.joints = f.joints_worst;
  shot.tool = f.tool;
  shot.tools = f.tools;
  shot.span = f.span;
  shot.kind = f.motion;
  shot.feed = f.feed_actual;
  shot.tip = Vec3(f.tip[Axis::x], f.tip[Axis::y], f.tip[Axis::z]);
  return shot;
}

}  // namespace

std::vector<FrameMaker::Impl::Job> FrameMaker::Impl::jobs_of(
    std::vector<sim::Finding>& findings) const {
  std::vector<Job> jobs;
  const auto sheet_text = [](const Snapshot& shot) {
    return "t = " + fixed(shot.t, 2) + " s" +
           (shot.span ? "   line " + std::to_string(shot.span.line) : "");
  };
  if (options.spec.count)
    for (const Snapshot& shot : evenly(*options.spec.count))
      jobs.push_back({four_digits(jobs.size() + 1), shot, sheet_text(shot), nullptr});
  for (const auto& item : named)
    jobs.push_back(
        {item.name, item.shot, options.spec.count ? "" : sheet_text(item.shot), nullptr});
  if (!options.spec.findings) return jobs;
  std::set<std::string> names;
  std::map<int, std::string> picture_of;  // by episode
  for (sim::Finding& f : findings) {
    if (f.joints_worst.size() == 0 || f.severity < Severity::warning) continue;
    if (const auto known = picture_of.find(f.episode); known != picture_of.end()) {
      f.picture = known->second;
      continue;
    }
    if (names.size() >= most_finding_frames) continue;
    const std::string line = std::to_string(f.span.line);
    const std::string stem = file_name_part(sim::to_string(f.kind)) + "-L" + line;
    std::string name = stem;
    for (int i = 2; !names.insert(name).second; ++i) name = stem + "-" + std::to_string(i);
    jobs.push_back(
        {name, snapshot_of(f), std::string(sim::to_string(f.kind)) + "   line " + line, &f});
    f.picture = picture_of[f.episode] = "frames/" + name + ".png";
  }
  return jobs;
}

Expected<render::Image> FrameMaker::Impl::draw(const Job& job, render::Renderer& renderer) {
  auto scene_then = picture(job.shot);
  if (!scene_then) return unexpected(scene_then.error());
  render::Scene& drawn = *scene_then;
  if (!job.finding) {
    const auto camera = camera_for(job.shot, drawn);
    if (!camera) return unexpected(camera.error());
    options.view.cut_open(drawn, X_WM(job.shot.joints), *camera);
    return renderer.draw(drawn, *camera);
  }
  const sim::Finding& f = *job.finding;
  drawn.caption.alarm = std::string(to_string(f.severity)) + ": " + printable(f.message);
  for (render::DrawBody& body : drawn.bodies)
    body.highlight = body.name == f.body_a || body.name == f.body_b;
  for (const Vec3& point : f.points) drawn.markers.push_back({point});
  if (!f.points.empty()) {
    constexpr double span = 260;  // mm across: a tool, its holder and what it met
    const render::Camera camera = renderer.camera_for_finding(drawn.bodies, f.points.front(), span);
    options.view.cut_open(drawn, X_WM(job.shot.joints), camera);
    return renderer.draw(drawn, camera);
  }
  // No contact: the place on the path, seen as the other frames see the work.
  drawn.markers.push_back(
      {X_WM(f.joints_worst) * Vec3(f.tip[Axis::x], f.tip[Axis::y], f.tip[Axis::z])});
  const auto camera = camera_for(job.shot, drawn);
  if (!camera) return unexpected(camera.error());
  options.view.cut_open(drawn, X_WM(job.shot.joints), *camera);
  return renderer.draw(drawn, *camera);
}

Expected<std::vector<std::string>> FrameMaker::write(const std::string& folder,
                                                     std::vector<sim::Finding>& findings) {
  Impl& impl = *impl_;
  auto renderer = render::Renderer::create(impl.options.size);
  if (!renderer) return unexpected(renderer.error());
  if (auto made = make_folder(folder + "/frames"); !made) return unexpected(made.error());

  const std::vector<Impl::Job> jobs = impl.jobs_of(findings);
  std::vector<std::string> written;
  std::map<std::size_t, render::SheetCell> cells;  // by job
  std::vector<std::string> moving;                 // PNG bytes, in time
  std::vector<std::size_t> in_time(jobs.size());   // the stock is cut once, from first to last
  std::size_t sheet_cells = 0;
  std::vector<bool> in_sheet;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    in_time[i] = i;
    written.push_back("frames/" + jobs[i].name + ".png");
    in_sheet.push_back(!jobs[i].sheet_text.empty() && sheet_cells < most_sheet_cells);
    sheet_cells += in_sheet.back() ? 1 : 0;
  }
  std::stable_sort(in_time.begin(), in_time.end(),
                   [&](std::size_t a, std::size_t b) { return jobs[a].shot.t < jobs[b].shot.t; });
  for (const std::size_t i : in_time) {
    auto image = impl.draw(jobs[i], *renderer);
    if (!image) return unexpected(image.error());
    std::string png = render::png_bytes(*image);
    if (auto done = write_file(folder + "/" + written[i], png); !done)
      return unexpected(done.error());
    if ((impl.options.motion || impl.options.video) && !jobs[i].finding)
      moving.push_back(std::move(png));
    if (in_sheet[i]) cells[i] = {std::move(*image), jobs[i].sheet_text};
  }
  if (!moving.empty()) {
    constexpr double length = 8, quickest = 0.04, slowest = 0.5;  // s
    const double each = std::clamp(length / static_cast<double>(moving.size()), quickest, slowest);
    if (impl.options.motion) {
      if (auto done = write_file(folder + "/motion.png", render::apng_bytes(moving, each)); !done)
        return unexpected(done.error());
      written.push_back("motion.png");
    }
    if (impl.options.video) {
      const auto ffmpeg = find_ffmpeg();
      if (!ffmpeg) return unexpected(ffmpeg.error());
      if (auto done = write_video(*ffmpeg, folder + "/motion.mp4", moving, each); !done)
        return unexpected(done.error());
      written.push_back("motion.mp4");
    }
  }
  if (cells.empty()) return written;
  std::vector<render::SheetCell> sheet;
  for (auto& [job, cell] : cells) sheet.push_back(std::move(cell));
  const int columns = sheet.size() <= 4 ? 2 : sheet.size() <= 9 ? 3 : 4;
  const render::Image image =
      render::contact_sheet(sheet, columns, 640, printable(impl.options.program));
  if (auto done = write_file(folder + "/sheet.png", render::png_bytes(image)); !done)
    return unexpected(done.error());
  written.push_back("sheet.png");
  return written;
}

}  // namespace aircut::report
