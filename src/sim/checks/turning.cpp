#include "sim/checks/turning.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <numbers>

#include "sim/checks/cut_tape.h"
#include "sim/checks/pairs.h"
#include "tool/insert.h"

namespace aircut::sim {

namespace {

constexpr double off_centre = 1e-3;  // mm: height of a tool over the spindle's axis
constexpr double finer = 5;          // than the lattice of a milled stock: a section is cheap
constexpr double facets = 0.02;      // mm, of part.stl

bool takes(const stock::TurningTouch& touch) { return takes_material(touch.depth, touch.volume); }

// The outline of a solid of revolution from its side, as convex sections that join.
std::vector<stock::TurningSection> sections_of(const Profile& profile, double axis_r,
                                               double axis_z) {
  const auto disc = [&](double r, double z) {
    return stock::TurningSection::Disc{z * axis_r - r * axis_z, z * axis_z + r * axis_r, 0};
  };
  std::vector<stock::TurningSection> out;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const ProfilePoint &a = profile[i], &b = profile[i + 1];
    if (b.z <= a.z) continue;
    out.push_back({{disc(a.r, a.z), disc(-a.r, a.z), disc(b.r, b.z), disc(-b.r, b.z)}});
  }
  return out;
}

std::string what_happens(Kind kind, const std::string& cutter) {
  if (kind == Kind::rapid_cut) return cutter + " goes through stock during a rapid";
  if (kind == Kind::spindle_stopped_cut)
    return cutter + " is fed into stock while the spindle stands";
  return "the program moves into stock with no tool in the turret";
}

std::string remedy_of(Kind kind) {
  if (kind == Kind::rapid_cut)
    return "retract to a clear radius and height first; if they look right, check work offset and "
           "tool offsets";
  if (kind == Kind::spindle_stopped_cut)
    return "start the spindle (S, M3) before the tool reaches the stock";
  return "load a tool (T, M6) first";
}

Diagnostic disk_error(const char* what) {
  return make_error("output_failed",
                    std::string(what) + " for the pictures of the stock: " + std::strerror(errno));
}

}  // namespace

bool turns_the_work(const machine::Machine& machine) {
  return !machine.kinematics().axes().has(Axis::y) && machine.kinematics().axes().has(Axis::x);
}

// ---- pictures ----------------------------------------------------------------------------------

class TurningTape {
 public:
  struct Record {
    double t0 = 0, t1 = 0;  ///< of the program
    double at[4] = {};
    std::uint64_t section = 0;
  };

  TurningTape()
      : file_(std::tmpfile(), [](std::FILE* file) {
          if (file) std::fclose(file);
        }) {}
  bool good() const { return file_ != nullptr; }

  bool add(const stock::TurningMove& move, double t0, double t1) {
    const auto [known, fresh] = known_.try_emplace(move.section, sections_.size());
    if (fresh) sections_.push_back(*move.section);
    const Record record{t0, t1, {move.r0, move.z0, move.r1, move.z1}, known->second};
    return std::fwrite(&record, sizeof record, 1, file_.get()) == 1;
  }
  /// The tool changes: its sections are no longer there.
  void forget() { known_.clear(); }

  std::shared_ptr<std::FILE> file() const { return file_; }
  const std::vector<stock::TurningSection>& sections() const { return sections_; }

 private:
  std::shared_ptr<std::FILE> file_;
  std::vector<stock::TurningSection> sections_;
  std::map<const stock::TurningSection*, std::size_t> known_;
};

namespace {

class TurningPlayer final : public StockHistory {
 public:
  TurningPlayer(std::shared_ptr<std::FILE> file, std::vector<stock::TurningSection> sections,
                stock::TurnedStock stock)
      : file_(std::move(file)), sections_(std::move(sections)), stock_(std::move(stock)) {
    more_ = read();
  }

  Expected<std::shared_ptr<const TriangleMesh>> at(double t) override {
    for (; more_ && next_.t1 <= t; more_ = read()) cut(1);
    // What is done of the next move; it comes as a whole later.
    if (more_ && next_.t0 < t) cut((t - next_.t0) / (next_.t1 - next_.t0));
    if (std::ferror(file_.get()) != 0) return unexpected(disk_error("can't read a temporary file"));
    if (!mesh_) mesh_ = std::make_shared<TriangleMesh>(stock_.mesh(facets));
    return mesh_;
  }

 private:
  // A share of the next move, as if its speed were steady.
  void cut(double share) {
    const auto& [r0, z0, r1, z1] = next_.at;
    stock_.cut({&sections_[next_.section], r0, z0, r0 + share * (r1 - r0), z0 + share * (z1 - z0)});
    mesh_ = nullptr;
  }
  bool read() { return std::fread(&next_, sizeof next_, 1, file_.get()) == 1; }

  std::shared_ptr<std::FILE> file_;
  std::vector<stock::TurningSection> sections_;
  stock::TurnedStock stock_;
  TurningTape::Record next_;
  bool more_ = false;
  std::shared_ptr<const TriangleMesh> mesh_;
};

}  // namespace

Expected<std::unique_ptr<StockHistory>> TurningCheck::history() {
  if (!tape_ || !stock()) return nullptr;
  std::FILE* file = tape_->file().get();
  if (std::fflush(file) != 0 || std::fseek(file, 0, SEEK_SET) != 0)
    return unexpected(disk_error("can't read a temporary file"));
  auto raw = initial(stock_->pitch());
  if (!raw) return unexpected(raw.error());
  return std::make_unique<TurningPlayer>(tape_->file(), tape_->sections(), std::move(*raw));
}

// ---- set-up ------------------------------------------------------------------------------------

TurningCheck::TurningCheck(const CheckOptions& options) : options_(options) {}
TurningCheck::~TurningCheck() = default;

const stock::TurnedStock* TurningCheck::stock() const {
  return stock_ && given_up_.empty() ? &*stock_ : nullptr;
}

std::optional<TriangleMesh> TurningCheck::part() const {
  if (!stock()) return std::nullopt;
  return stock()->mesh(facets);
}

Expected<stock::TurnedStock> TurningCheck::initial(double pitch) const {
  if (raw_->saved) return stock::TurnedStock::load(raw_->saved->content(), raw_->saved->name());
  return stock::TurnedStock::make(raw_->diameter / 2, raw_->bore / 2, raw_->height, pitch);
}

std::string TurningCheck::read_frame(const machine::Machine& machine) {
  if (raw_->shape != machine::StockShape::cylinder && !raw_->saved)
    return "on a machine whose spindle turns the work the stock must be a cylinder or a tube";
  const Pose X_SM = raw_->X_LS.inverse(Eigen::Isometry) * machine.X_LM();
  const Vec3 axis = X_SM.linear() * Vec3::UnitZ(), origin = X_SM.translation();
  if (axis.z() < -1 + 1e-9)
    return "a turned stock has no model end for end ([stock] angles): it stands as it was made";
  if (raw_->link != machine.work_link() || axis.z() < 1 - 1e-9 ||
      std::hypot(origin.x(), origin.y()) > 1e-6)
    return "the stock does not stand on the axis of the spindle that turns it (X 0, Y 0)";
  turret_->across = X_SM.linear() * Vec3::UnitX();
  turret_->side = X_SM.linear() * Vec3::UnitY();
  return {};
}

// Makes the tool of this scene the one at hand.
void TurningCheck::turn_to(const Scene& scene) {
  if (turret_ && turret_->machine.get() == &scene.machine()) return;
  for (const auto& turret : turrets_)
    if (turret->machine.get() == &scene.machine()) {
      turret_ = turret.get();
      return;
    }
  turrets_.push_back(std::make_unique<Turret>());
  turret_ = turrets_.back().get();
  turret_->machine = scene.machine_ptr();
  if (auto why = read_frame(scene.machine()); !why.empty() && given_up_.empty()) give_up(why);
}

void TurningCheck::start(const Scene& scene, const JointVector& joints, Findings& out) {
  raw_ = scene.machine().stock();
  if (!raw_) return;
  turn_to(scene);
  turret_->joints = joints;
  if (!given_up_.empty()) return;
  const double pitch = raw_->pitch.value_or(default_pitch(*raw_) / finer);
  auto made = initial(pitch);
  if (!made) return give_up(made.error().message);
  stock_ = std::move(*made);
  initial_volume_ = stock_->volume();
  tolerance_ = std::min(pitch / 10, 0.01);
  if (const auto& design = scene.machine().part()) {
    // The part is cast on the lattice that a milled stock of this size has.
    auto watch = PartWatch::make(*design, *raw_, default_pitch(*raw_), out);
    if (watch)
      watch_ = std::move(*watch);
    else
      no_part_ = watch.error().message;
  }
  if (options_.keep_cuts) {
    tape_ = std::make_unique<TurningTape>();
    if (!tape_->good()) give_up(disk_error("can't make a temporary file").message);
  }
}

void TurningCheck::scene_changed(const Step& step, const JointVector&, Findings& out) {
  if (!raw_) return;
  turn_to(step.scene);
  turret_->tool_read = false;
  tell_given_up(step, out);
}

// An insert, its nose and edges, and what holds it.
std::string TurningCheck::read_insert(const tool::Tool& tool) {
  const std::string name = "T" + std::to_string(tool.number);
  const auto insert = tool::insert_of(tool);
  if (!insert) return "tool " + name + " has " + insert.error();
  stock::TurningSection section;
  section.discs.push_back({insert->nose[0], insert->nose[1], insert->radius});
  for (const auto& [x, z] : insert->ends) section.discs.push_back({x, z, 0});
  turret_->cutters.push_back({name + "/insert", machine::Role::cutter, {std::move(section)}});
  for (const tool::Block& block : tool.blocks) {
    if (block.role == tool::PieceRole::cutter) continue;
    const auto role =
        block.role == tool::PieceRole::shank ? machine::Role::shank : machine::Role::holder;
    turret_->others.push_back({name + "/" + block.name, role, {}, {block}});
  }
  turret_->tip = -tool.offset[Axis::x] * turret_->across - tool.offset[Axis::z] * Vec3::UnitZ();
  return {};
}

std::string TurningCheck::read_tool(const Scene& scene, const Vec3& axis) {
  turret_->cutters.clear();
  turret_->others.clear();
  if (tape_) tape_->forget();
  turret_->tip = Vec3::Zero();
  turret_->reach = {};
  const tool::Tool* tool = scene.tool();
  turret_->no_tool = tool == nullptr;
  if (turret_->no_tool) {
    turret_->cutters.push_back({"spindle", machine::Role::cutter, {{{{0, 0, 0.5}}}}});
    return {};
  }
  if (tool->pieces.empty()) return read_insert(*tool);
  if (std::abs(axis.dot(turret_->side)) > 1e-6)
    return "the tool's axis is not in the plane of X and Z";
  for (const tool::Piece& piece : tool->pieces) {
    const bool cuts = piece.role == tool::PieceRole::cutter;
    const machine::Role role = cuts                                   ? machine::Role::cutter
                               : piece.role == tool::PieceRole::shank ? machine::Role::shank
                                                                      : machine::Role::holder;
    (cuts ? turret_->cutters : turret_->others)
        .push_back({"T" + std::to_string(tool->number) + "/" + piece.name, role,
                    sections_of(piece.profile, axis.dot(turret_->across), axis.z())});
    for (const ProfilePoint& p : piece.profile) {
      turret_->reach.radius = std::max(turret_->reach.radius, p.r);
      turret_->reach.height = std::max(turret_->reach.height, p.z);
    }
  }
  return {};
}

void TurningCheck::give_up(const std::string& why) {
  if (given_up_.empty()) given_up_ = why;
}

void TurningCheck::tell_given_up(const Step& step, Findings& out) {
  if (given_up_.empty() || told_ || !raw_) return;
  told_ = true;
  out.add(lost_stock(step, given_up_));
}

// ---- moves -------------------------------------------------------------------------------------

stock::TurningMove TurningCheck::in_plane(const stock::TurningSection& section,
                                          const StraightMove& move, double part) const {
  const Vec3 from = move.from + turret_->tip, to = from + part * (move.to - move.from);
  return {&section, from.dot(turret_->across), from.z(), to.dot(turret_->across), to.z()};
}

stock::TurningTouch TurningCheck::touch(const Solid& solid, const StraightMove& move,
                                        double part) const {
  stock::TurningTouch out;
  for (const stock::TurningSection& section : solid.sections) {
    const stock::TurningTouch here = stock_->touch(in_plane(section, move, part));
    const double volume = out.volume + here.volume;
    if (here.depth > out.depth) out = here;
    out.volume = volume;
  }
  for (const tool::Block& block : solid.blocks) {
    const stock::TurningSection section = swept(solid, block, move, part);
    const stock::TurningTouch here = stock_->touch({&section, 0, 0, 0, 0});
    const double volume = out.volume + here.volume;
    if (here.depth > out.depth) out = here;
    out.volume = volume;
  }
  return out;
}

// A corner that lies beside the half plane by y comes to the radius √(x² + y²). So a block sweeps
// radii from those of its part in the half plane to those of its far edges; the hull of both, at
// both ends of the move, holds all of it, since √(x² + y²) is convex in x.
stock::TurningSection TurningCheck::swept(const Solid& solid, const tool::Block& block,
                                          const StraightMove& move, double part) const {
  const double y = std::max(std::abs(block.y_low), std::abs(block.y_high));
  const stock::TurningSection none;
  const stock::TurningMove way = in_plane(none, move, part);
  stock::TurningSection out;
  for (const auto& [x, z] : block.outline)
    for (const auto& [r, at] : {std::pair{way.r0, way.z0}, std::pair{way.r1, way.z1}}) {
      out.discs.push_back({x + r, z + at, solid.wider});
      out.discs.push_back({std::copysign(std::hypot(x + r, y), x + r), z + at, solid.wider});
    }
  return out;
}

double TurningCheck::cut(const Step& step, const Solid& solid, const StraightMove& move) {
  double volume = 0;
  const bool insert = step.scene.tool() && step.scene.tool()->pieces.empty();
  if (listener_ && !insert) tell_axial(step, move, solid);
  // A hair below a surface is what an earlier move left there.
  const std::function<bool(double, double)> still_there = [this](double r, double z) {
    for (const auto& [low, high] : stock_->radii_at(z))
      if (r > low - 1e-3 && r < high - 1e-3) return true;
    return false;
  };
  for (const stock::TurningSection& section : solid.sections) {
    const stock::TurningMove here = in_plane(section, move);
    if (listener_ && insert) turret_->cuts.look(*stock_, here, move.s0, move.s1);
    std::optional<TurningGouge> gouge;
    if (watch_ && stock_->touch(here).depth > 0)
      gouge = deepest_in_part(here, *watch_->part(), {raw_->diameter / 2, raw_->height},
                              watch_->design().gouge, watch_->bound(), still_there);
    const double taken = stock_->cut(here);
    volume += taken;
    if (gouge && taken > 0) tell_gouge(step, solid, move, *gouge, taken);
    if (taken > 0 && tape_ && !tape_->add(here, time_at(step, move.s0), time_at(step, move.s1)))
      give_up(disk_error("can't write a temporary file").message);
  }
  if (volume > 0)
    removed_when_.over(time_at(step, move.s0), time_at(step, move.s1),
                       [&](Volume& v, double share) { v.value += volume * share; });
  return volume;
}

void TurningCheck::tell_gouge(const Step& step, const Solid& solid, const StraightMove& move,
                              const TurningGouge& gouge, double volume) {
  stock::Touch touch;
  touch.depth = gouge.depth;
  touch.point = gouge.r * turret_->across + gouge.z * Vec3::UnitZ();
  Finding f = cut_row(Kind::gouge_live, step, move, {solid.name, solid.role}, *raw_, touch.point,
                      [](double part) { return part >= 1; });
  watch_->describe(f, solid.name);
  f.remedy = "check the diameter, the tool's offsets and nose, and where the part stands ([part])";
  // It goes all around; the result is compared at eight places.
  for (int i = 0; i < 8; ++i) {
    touch.point =
        Eigen::AngleAxisd(i * std::numbers::pi / 4, Vec3::UnitZ()) * Vec3(gouge.r, 0, gouge.z);
    watch_->note(f, touch);
  }
  rows_.tell(std::move(f), gouge.depth, volume);
}

// A drill or a driven tool: what it takes on this move, as one stretch.
void TurningCheck::tell_axial(const Step& step, const StraightMove& move, const Solid& solid) {
  const stock::TurningTouch here = touch(solid, move);
  if (!takes(here)) return;
  Cut cut = cut_at(step);
  cut.t0 = time_at(step, move.s0);
  cut.t1 = time_at(step, move.s1);
  const auto joints = step.motion.at(0.5 * (cut.t0 + cut.t1));
  cut.joints = joints ? *joints : turret_->joints;
  const Pose X_MS = stock_at_rest(*turret_->machine, *raw_, cut.joints);
  cut.way = (move.to - move.from).norm();
  if (!(cut.way > 0) || !(cut.t1 > cut.t0)) return;
  cut.point_part = 0.5 * (move.from + move.to) + turret_->tip;
  cut.point = X_MS * cut.point_part;
  cut.feed = X_MS.linear() * (move.to - move.from) / cut.way;
  cut.axis = X_MS.linear() * move.axis;
  cut.volume = here.volume;
  cut.pitch = stock_->pitch();
  listener_->on_cut(cut);
}

std::optional<Kind> TurningCheck::forbidden(const Step& step) const {
  if (turret_->no_tool) return Kind::no_tool_cut;
  if (is_rapid(step)) return Kind::rapid_cut;
  if (step.segment.spindle_rpm == 0) return Kind::spindle_stopped_cut;
  return std::nullopt;
}

void TurningCheck::step(const Step& step, Findings& out) {
  if (!raw_) return;
  turn_to(step.scene);
  t_end_ = step.segment.t_end();
  if (const auto end = step.motion.at(step.motion.t1())) turret_->joints = *end;
  if (!given_up_.empty()) return tell_given_up(step, out);
  if (std::holds_alternative<plan::Hold>(step.segment.path)) return;
  if (std::holds_alternative<canon::Probe>(step.segment.command.action)) return;
  moves_.clear();
  rows_.clear();
  if (!straight_moves(step, *raw_, turret_->reach, tolerance_, moves_)) {
    give_up("the way of the tool over the stock can't be told");
    return tell_given_up(step, out);
  }
  if (moves_.empty()) return;
  if (!turret_->tool_read) turret_->tool_problem = read_tool(step.scene, moves_.front().axis);
  turret_->tool_read = true;
  look_at(step, out);
  rows_.hand_over(out);
}

void TurningCheck::look_at(const Step& step, Findings& out) {
  const std::optional<Kind> kind = forbidden(step);
  if (!turret_->tool_problem.empty()) {
    if (kind == Kind::rapid_cut || kind == Kind::spindle_stopped_cut) return;
    give_up(turret_->tool_problem);
    return tell_given_up(step, out);
  }
  double volume = 0;
  for (const StraightMove& move : moves_) {
    if (std::abs((move.from + turret_->tip).dot(turret_->side)) > off_centre ||
        std::abs((move.to + turret_->tip).dot(turret_->side)) > off_centre) {
      give_up("the tool is not at the height of the spindle's axis");
      return tell_given_up(step, out);
    }
    const bool rises = (move.to - move.from).dot(move.axis) > 0;
    if (rises)
      for (const Solid& solid : turret_->others) ask(step, move, solid);
    for (const Solid& solid : turret_->cutters) {
      if (step.segment.sync && !turret_->no_tool) {  // a thread is no body of revolution
        if (takes(touch(solid, move)))
          give_up("`" + solid.name + "` cuts a thread, of which there is no model");
      } else if (kind)
        cutter_may_not(step, move, solid, *kind);
      else
        volume += cut(step, solid, move);
    }
    if (!rises)
      for (const Solid& solid : turret_->others) ask(step, move, solid);
    if (!given_up_.empty()) return tell_given_up(step, out);
  }
  if (listener_) turret_->cuts.hand_over(step, *raw_, turret_->across, stock_->pitch(), *listener_);
  if (!kind && !step.segment.sync && volume == 0 && plan::length(step.segment.path) > longest_air)
    add_air_cut(step, out);
}

void TurningCheck::cutter_may_not(const Step& step, const StraightMove& move, const Solid& solid,
                                  Kind kind) {
  const stock::TurningTouch here = touch(solid, move);
  if (!takes(here)) return;
  Finding f = row(kind, step, move, solid, here);
  f.message = what_happens(kind, "cutter `" + solid.name + "`");
  f.remedy = remedy_of(kind);
  f.depth_bound = stock_->pitch() / 2;
  f.unit = "mm3";
  f.value = 0;
  rows_.tell(std::move(f), here.depth, here.volume);
  if (kind != Kind::no_tool_cut) cut(step, solid, move);
}

// Shank or holder: clear when it would be even if it were larger by half a pitch on all sides.
bool TurningCheck::ask(const Step& step, const StraightMove& move, const Solid& solid) {
  Solid wide = solid;
  for (stock::TurningSection& section : wide.sections)
    for (auto& disc : section.discs) disc.radius += stock_->pitch() / 2;
  wide.wider += stock_->pitch() / 2;
  if (touch(wide, move).depth == 0) return true;
  const stock::TurningTouch here = touch(solid, move);
  const bool hit = takes(here);
  Finding f = row(hit ? Kind::collision : Kind::near_miss, step, move, hit ? solid : wide,
                  hit ? here : touch(wide, move));
  if (hit)
    tell_hit(f, {solid.name, solid.role}, stock_->pitch() / 2,
             "use a longer stick-out, or clear the material beside it first");
  else
    tell_doubt(f, {solid.name, solid.role}, stock_->pitch());
  rows_.tell(std::move(f), here.depth, here.volume);
  return false;
}

Finding TurningCheck::row(Kind kind, const Step& step, const StraightMove& move, const Solid& solid,
                          const stock::TurningTouch& touch_) const {
  return cut_row(kind, step, move, {solid.name, solid.role}, *raw_,
                 touch_.r * turret_->across + touch_.z * Vec3::UnitZ(),
                 [&](double part) { return takes(touch(solid, move, part)); });
}

void TurningCheck::compare_with_part(Summary& summary, Findings& out) {
  if (!no_part_.empty()) summary.unchecked.push_back("the result against the part: " + no_part_);
  if (watch_)
    summary.part = watch_->compare(*stock_, at_end(*turret_->machine, *raw_, turret_->joints),
                                   end_of_run(t_end_, turret_->joints), out);
}

void TurningCheck::finish(Summary& summary, Findings& out) {
  if (!raw_) return;
  if (!stock()) {
    if (!told_) summary.unchecked.push_back("what the tools take from the stock: " + given_up_);
    return;
  }
  Summary::Stock s;
  s.pitch = stock_->pitch();
  s.sweep_bound = tolerance_;
  s.initial_volume = initial_volume_;
  s.volume = stock_->volume();
  s.bytes = stock_->bytes();
  s.removed = std::move(removed_when_);
  summary.stock = std::move(s);
  compare_with_part(summary, out);
}

}  // namespace aircut::sim
