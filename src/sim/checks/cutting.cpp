#include "sim/checks/cutting.h"

#include <algorithm>
#include <cmath>

#include "sim/checks/pairs.h"
#include "tool/insert.h"

namespace aircut::sim {

namespace {

constexpr double plunge_angle = 3 * M_PI / 180;
constexpr std::size_t batch_size = 256;
constexpr double rough = 0.5;  // mm, tolerance of the moves that solids are asked with first

double volume_of(const machine::RawStock& raw) {
  switch (raw.shape) {
    case machine::StockShape::box:
      return raw.size.prod();
    case machine::StockShape::cylinder:
      return M_PI / 4 * (raw.diameter * raw.diameter - raw.bore * raw.bore) * raw.height;
    case machine::StockShape::mesh:
    case machine::StockShape::saved:
      return volume(*raw.mesh);
  }
  return 0;
}

std::string what_happens(Kind kind, const std::string& cutter) {
  switch (kind) {
    case Kind::rapid_cut:
      return cutter + " goes through stock during a rapid";
    case Kind::spindle_stopped_cut:
      return cutter + " is fed into stock while the spindle stands";
    case Kind::spindle_direction_cut:
      return cutter + " is fed into stock while the spindle turns backwards";
    case Kind::plunge_not_center_cutting:
      return cutter + " is fed straight down into stock, but it can't cut at its centre";
    default:
      return "the program moves into stock with no tool in the spindle";
  }
}

std::string remedy_of(Kind kind, bool left_hand) {
  switch (kind) {
    case Kind::rapid_cut:
      return "retract to a clear height first; if the height looks right, check work offset and "
             "length offset";
    case Kind::spindle_stopped_cut:
      return "start the spindle (S, M3) before the tool reaches the stock";
    case Kind::spindle_direction_cut:
      return left_hand ? "the tool is left-hand: use M4" : "the tool is right-hand: use M3";
    case Kind::plunge_not_center_cutting:
      return "enter by a ramp or a helix, or drill first";
    default:
      return "load a tool (T, M6) first";
  }
}

}  // namespace

const stock::Stock* CuttingCheck::stock() const {
  return stock_ && given_up_.empty() ? &*stock_ : nullptr;
}

Expected<std::shared_ptr<const collide::CollisionMesh>> CuttingCheck::surface() {
  flush();
  if (!stock()) return unexpected(make_error("stock_unknown", given_up_));
  if (!surface_ || removed_at_surface_ != removed_) {
    // Uncut, the mesh of the raw piece is exact.
    const bool raw = removed_ == 0 && raw_->mesh;
    surface_ = std::make_shared<collide::CollisionMesh>(raw ? *raw_->mesh : stock_->mesh());
    removed_at_surface_ = removed_;
  }
  return surface_;
}

void CuttingCheck::start(const Scene& scene, const JointVector& joints, Findings& out) {
  raw_ = scene.machine().stock();
  if (!raw_) return;
  joints_ = joints;
  machine_ = scene.machine_ptr();
  auto made = raw_->saved ? stock::Stock::load(raw_->saved->content(), raw_->saved->name())
                          : make_stock(*raw_, raw_->pitch.value_or(default_pitch(*raw_)));
  if (!made) return give_up(made.error().message);
  stock_ = std::move(*made);
  const double pitch = stock_->pitch();
  initial_volume_ = volume_of(*raw_);
  tolerance_ = std::min(pitch / 10, 0.01);
  auto tape = CutTape::make();
  if (!tape) return give_up(tape.error().message);
  tape_ = std::move(*tape);
  loose_.start(*stock_);
  scene_ = &scene;
  if (const auto& design = scene.machine().part()) {
    auto watch = PartWatch::make(*design, *raw_, pitch, out);
    if (watch)
      part_ = std::move(*watch);
    else
      no_part_ = watch.error().message;
  }
  read_tool(scene);
}

void CuttingCheck::read_tool(const Scene& scene) {
  cutters_.clear();
  others_.clear();
  taped_.clear();
  reach_ = cutter_reach_ = {};
  const tool::Tool* tool = scene.tool();
  no_tool_ = tool == nullptr;
  tool_number_ = scene.loaded_tool();
  tool_known_ = no_tool_ || !tool->pieces.empty();
  engagement_.read_tool(nullptr, 0, 0);
  if (no_tool_) {
    // Only whether the programmed point enters the stock: a pin, a millimetre wide.
    const auto pin = *stock::CutterProfile::flat(1, 1);
    cutters_.push_back({"spindle", machine::Role::cutter, pin, pin});
    reach_ = cutter_reach_ = {0.5, 1};
    return;
  }
  center_cutting_ = tool->center_cutting;
  left_hand_ = tool->left_hand;
  for (const tool::Piece& piece : tool->pieces) {
    auto profile = stock::CutterProfile::from_outline(piece.profile);
    if (!profile) {
      tool_known_ = false;
      continue;
    }
    const bool tip = piece.role == tool::PieceRole::cutter, cuts = tip && !tool::is_probe(*tool);
    const machine::Role role = cuts                                   ? machine::Role::cutter
                               : tip                                  ? machine::Role::probe
                               : piece.role == tool::PieceRole::shank ? machine::Role::shank
                                                                      : machine::Role::holder;
    for (Reach* reach : {&reach_, cuts ? &cutter_reach_ : &reach_}) {
      reach->radius = std::max(reach->radius, profile->radius());
      reach->height = std::max(reach->height, profile->high());
    }
    (cuts ? cutters_ : others_)
        .push_back({"T" + std::to_string(tool->number) + "/" + piece.name, role, *profile,
                    profile->grown(rough + stock_->pitch() / 2)});
  }
  engagement_.read_tool(tool, cutter_reach_.radius, stock_->pitch());
}

void CuttingCheck::scene_changed(const Step& step, const JointVector&, Findings& out) {
  if (!stock()) return;
  flush();
  look_for_loose(step.scene, out);
  tell_given_up(step, out);
  read_tool(step.scene);
}

void CuttingCheck::give_up(const std::string& why) {
  if (given_up_.empty()) given_up_ = why;
  batch_.clear();
  batch_times_.clear();
  batch_cuts_.clear();
}

void CuttingCheck::tell_given_up(const Step& step, Findings& out) {
  if (given_up_.empty() || told_) return;
  told_ = true;
  out.add(lost_stock(step, given_up_));
}

// ---- the stock ---------------------------------------------------------------------------------

stock::Piece CuttingCheck::piece(const Solid& solid, const StraightMove& move, double part) const {
  return {&solid.profile, move.from, move.from + part * (move.to - move.from), move.axis, 0};
}

bool CuttingCheck::near(const Solid& solid, const StraightMove& move) const {
  Box3 swept;
  for (const Vec3& tip : {move.from, move.to})
    for (const double z : {solid.profile.low(), solid.profile.high()})
      swept.extend(Vec3(tip + z * move.axis));
  const double r = solid.profile.radius(), margin = stock_->pitch();
  const Vec3 across = (Vec3::Ones() - move.axis.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  swept.min() -= r * across + Vec3::Constant(margin);
  swept.max() += r * across + Vec3::Constant(margin);
  return swept.intersects(stock_->box());
}

bool CuttingCheck::touches(const stock::Piece& piece) {
  const auto answer = stock_->takes(piece, 0, 0);
  if (!answer) give_up(answer.error().message);
  return answer && *answer;
}

bool CuttingCheck::takes(const stock::Piece& piece) {
  const auto answer = stock_->takes(piece, touch_depth, touch_volume);
  if (!answer) give_up(answer.error().message);
  return answer && *answer;
}

stock::Touch CuttingCheck::touch_of(const stock::Piece& piece) {
  auto touch = stock_->touch(piece);
  if (touch) return *touch;
  give_up(touch.error().message);
  return {};
}

void CuttingCheck::hold(const Step& step, const Solid& cutter, const StraightMove& move) {
  if (part_) look_at_part(step, cutter, move);
  if (engagement_.on()) {
    flush();
    if (!stock()) return;
    const auto in = stock_->engagement(piece(cutter, move));
    if (!in) return give_up(in.error().message);
    engagement_.look(step, move, *in, cutter.name);
  }
  batch_.push_back(piece(cutter, move));
  batch_.back().move = static_cast<std::uint32_t>(batch_times_.size());
  batch_times_.push_back({time_at(step, move.s0), time_at(step, move.s1)});
  if (listener_) note_cut(step, move);
  loose_.add(step, batch_.back());
  if (batch_.size() >= batch_size) flush();
}

void CuttingCheck::flush() {
  if (batch_.empty()) return;
  slices_.clear();
  const auto cut = listener_ ? stock_->cut(batch_, longest_cut, slices_) : stock_->cut(batch_);
  if (!cut) return give_up(cut.error().message);
  if (listener_) tell_cuts();
  for (const stock::Removal& removal : *cut) {
    removed_ += removal.quanta;
    const auto [from, to] = batch_times_[removal.move];
    if (removal.volume > 0)
      removed_when_.over(from, to,
                         [&](Volume& v, double share) { v.value += removal.volume * share; });
  }
  for (std::size_t i = 0; i < batch_.size(); ++i) {
    stock::Piece piece = batch_[i];
    const stock::CutterProfile*& kept = taped_[piece.cutter];
    if (!kept) kept = tape_->keep(*piece.cutter, tool_number_);
    piece.cutter = kept;
    if (auto added = tape_->add(piece, batch_times_[i][0], batch_times_[i][1]); !added)
      return give_up(added.error().message);
  }
  batch_.clear();
  batch_times_.clear();
  batch_cuts_.clear();
}

// The whole move; its slices are known when it is cut. The machine is where it is at both ends, and
// in between as far as the move has gone.
void CuttingCheck::note_cut(const Step& step, const StraightMove& move) {
  WholeCut whole;
  Cut& cut = whole.cut;
  cut = cut_at(step);
  const auto from = step.motion.at_path(move.s0), to = step.motion.at_path(move.s1);
  cut.joints = from ? *from : joints_;
  whole.joints_to = to ? *to : cut.joints;
  const Pose X_MS = stock_at_rest(*machine_, *raw_, cut.joints);
  cut.pitch = stock_->pitch();
  cut.t0 = batch_times_.back()[0];
  cut.t1 = batch_times_.back()[1];
  cut.point = X_MS * move.from;
  whole.to = stock_at_rest(*machine_, *raw_, whole.joints_to) * move.to;
  const Vec3 way = X_MS.linear() * (move.to - move.from);
  cut.way = way.norm();
  if (cut.way > 0) cut.feed = way / cut.way;
  cut.axis = X_MS.linear() * move.axis;
  batch_cuts_.push_back(std::move(whole));
}

void CuttingCheck::tell_cuts() {
  for (const stock::Slice& slice : slices_) {
    const WholeCut& whole = batch_cuts_[slice.piece];
    const stock::Piece& piece = batch_[slice.piece];
    Cut cut = whole.cut;
    const double middle = 0.5 * (slice.from + slice.to), time = cut.t1 - cut.t0;
    cut.point += middle * (whole.to - cut.point);
    cut.joints += middle * (whole.joints_to - cut.joints);
    cut.point_part = piece.start + middle * (piece.end - piece.start);
    cut.way *= slice.to - slice.from;
    cut.t1 = cut.t0 + slice.to * time;
    cut.t0 += slice.from * time;
    cut.volume = slice.in.volume;
    cut.in = slice.in;
    if (cut.t1 > cut.t0) listener_->on_cut(cut);
  }
}

void CuttingCheck::look_for_loose(const Scene& scene, Findings& out) {
  flush();
  if (!stock()) return;
  if (auto done = loose_.look(*stock_, *raw_, *tape_, scene, out); !done)
    give_up(done.error().message);
}

// ---- the rules ---------------------------------------------------------------------------------

std::optional<Kind> CuttingCheck::forbidden(const Step& step) const {
  const plan::Segment& segment = step.segment;
  if (no_tool_) return Kind::no_tool_cut;
  if (is_rapid(step)) return Kind::rapid_cut;
  const double rpm = segment.spindle_rpm;
  if (rpm == 0) return Kind::spindle_stopped_cut;
  // A tap comes back with the spindle reversed.
  const bool follows = segment.sync && segment.sync->spindle_follows;
  if (!follows && (rpm < 0) != left_hand_) return Kind::spindle_direction_cut;
  return std::nullopt;
}

void CuttingCheck::step(const Step& step, Findings& out) {
  if (raw_ && !given_up_.empty()) return tell_given_up(step, out);
  if (!stock() || std::holds_alternative<plan::Hold>(step.segment.path)) return;
  // Made to touch: where it trips was found before it was planned (probing.h).
  if (std::holds_alternative<canon::Probe>(step.segment.command.action)) return;
  t_end_ = step.segment.t_end();
  if (const auto end = step.motion.at(step.motion.t1())) joints_ = *end;
  if (!find_moves(step)) {
    give_up("the way of the tool over the stock can't be told");
    return tell_given_up(step, out);
  }
  rows_.clear();
  look_at(step, out);
  rows_.hand_over(out);
  if (loose_.due()) look_for_loose(step.scene, out);
}

// Where the tool turns, shank and holder are far from the middle of a turn and would need many
// short moves. So they are asked with a few rough ones first, and most are clear.
bool CuttingCheck::find_moves(const Step& step) {
  doubtful_.clear();
  moves_.clear();
  if (!turns(step, *raw_)) {
    for (const Solid& solid : others_) doubtful_.push_back(&solid);
    return straight_moves(step, *raw_, reach_, tolerance_, moves_);
  }
  if (!straight_moves(step, *raw_, reach_, rough, moves_)) return false;
  for (const Solid& solid : others_) {
    const Solid wide{solid.name, solid.role, solid.wide, solid.wide};
    const bool clear = std::all_of(moves_.begin(), moves_.end(), [&](const StraightMove& move) {
      return !near(wide, move) || !touches(piece(wide, move));
    });
    if (!clear) doubtful_.push_back(&solid);
  }
  moves_.clear();
  return straight_moves(step, *raw_, doubtful_.empty() ? cutter_reach_ : reach_, tolerance_,
                        moves_);
}

void CuttingCheck::look_at(const Step& step, Findings& out) {
  const std::optional<Kind> kind = forbidden(step);
  if (!tool_known_) {
    if (kind == Kind::rapid_cut || kind == Kind::spindle_stopped_cut) return;
    give_up("tool T" + std::to_string(step.scene.loaded_tool()) +
            " has no geometry that can be cut with");
    return tell_given_up(step, out);
  }
  if (!kind) look_for_air(step, moves_, out);
  for (const StraightMove& move : moves_) {
    const double rise = (move.to - move.from).dot(move.axis);
    if (rise > 0)
      for (const Solid* solid : doubtful_) ask(step, move, *solid);
    for (const Solid& cutter : cutters_) {
      const double way = (move.to - move.from).norm();
      if (kind)
        cutter_may_not(step, move, cutter, *kind);
      else if (!center_cutting_ && -rise > way * std::cos(plunge_angle))
        cutter_may_not(step, move, cutter, Kind::plunge_not_center_cutting);
      else if (near(cutter, move))
        hold(step, cutter, move);
      if (!given_up_.empty()) return tell_given_up(step, out);
    }
    if (rise <= 0)
      for (const Solid* solid : doubtful_) ask(step, move, *solid);
    if (!given_up_.empty()) return tell_given_up(step, out);
  }
}

void CuttingCheck::look_for_air(const Step& step, const std::vector<StraightMove>& moves,
                                Findings& out) {
  if (plan::length(step.segment.path) <= longest_air) return;
  flush();
  for (const StraightMove& move : moves)
    for (const Solid& cutter : cutters_) {
      if (!stock()) return;
      if (near(cutter, move) && touches(piece(cutter, move))) return;
    }
  add_air_cut(step, out);
}

void CuttingCheck::cutter_may_not(const Step& step, const StraightMove& move, const Solid& cutter,
                                  Kind kind) {
  if (!near(cutter, move)) return;
  const stock::Piece whole = piece(cutter, move);
  if (!takes(whole)) return;
  flush();
  if (!stock()) return;
  const stock::Touch touch = touch_of(whole);
  if (!stock() || !takes_material(touch.depth, touch.volume)) return;
  const auto enough = [&](const stock::Piece& part) { return takes(part); };
  Finding f = row(kind, step, move, cutter, touch.point, enough);
  f.message = what_happens(kind, "cutter `" + cutter.name + "`");
  f.remedy = remedy_of(kind, left_hand_);
  f.depth_bound = stock_->pitch() / 2;
  f.unit = "mm3";
  f.value = 0;
  rows_.tell(std::move(f), touch.depth, touch.volume);
  if (kind != Kind::no_tool_cut) {
    hold(step, cutter, move);
    flush();
  }
}

// A probe that leaves what it has touched: nowhere deeper than where it stood.
bool CuttingCheck::comes_off(const StraightMove& move, const Solid& solid) {
  if (!touching_ || solid.role != machine::Role::probe) return false;
  flush();
  if (!stock()) return false;
  const auto across = [&](const Vec3& from, const Vec3& to) {
    return touch_of({&solid.profile, from, to, move.axis, 0}).across;
  };
  const double before = across(move.from, move.from);
  if (across(move.to, move.to) <= options_.touch) touching_ = false;
  return across(move.from, move.to) <= before + stock_->pitch() / 10;
}

// Depths take the most time where a holder is deep in the stock, and a program with a wrong offset
// has it there all the time. All moves of a block are alike in this, since they make one row.
bool CuttingCheck::is_measured(const Step& step) {
  const std::uint64_t block = step.segment.command.block;
  if (measured_ > 0 && block == measured_block_) return true;
  if (measured_ >= options_.detailed) return false;
  ++measured_;
  measured_block_ = block;
  return true;
}

void CuttingCheck::ask(const Step& step, const StraightMove& move, const Solid& solid) {
  if (!stock() || !near(solid, move)) return;
  if (comes_off(move, solid)) return;
  const stock::Piece whole = piece(solid, move);
  const auto ask_now = [&](stock::HowDeep how_deep) {
    return stock_->would_cut(whole, options_.touch, how_deep);
  };
  auto answer = ask_now(stock::HowDeep::left_open);
  if (answer && answer->contact == stock::Contact::clear) return;
  if (!batch_.empty()) {
    flush();
    if (!stock()) return;
    answer = ask_now(stock::HowDeep::left_open);
  }
  if (!answer) return give_up(answer.error().message);
  if (answer->contact == stock::Contact::clear) return;
  const bool hit = answer->contact == stock::Contact::hit, measured = hit && is_measured(step);
  if (measured) answer = ask_now(stock::HowDeep::measured);
  const auto enough = [&](const stock::Piece& part) { return takes(part); };
  const Kind contact = solid.role == machine::Role::probe ? Kind::probe_contact : Kind::collision;
  Finding f = row(hit ? contact : Kind::near_miss, step, move, solid, answer->touch.point, enough);
  if (hit)
    tell_hit(f, {solid.name, solid.role},
             measured ? std::optional(answer->most - answer->least) : std::nullopt,
             "use a longer stick-out or flute length, or clear the material beside it first");
  else
    tell_doubt(f, {solid.name, solid.role}, stock_->pitch());
  rows_.tell(std::move(f), measured ? std::optional(answer->touch.depth) : std::nullopt,
             answer->touch.volume);
}

Finding CuttingCheck::row(Kind kind, const Step& step, const StraightMove& move, const Solid& solid,
                          const Vec3& point,
                          const std::function<bool(const stock::Piece&)>& enough) {
  return cut_row(kind, step, move, {solid.name, solid.role}, *raw_, point,
                 [&](double part) { return enough(piece(solid, move, part)); });
}

void CuttingCheck::look_at_part(const Step& step, const Solid& cutter, const StraightMove& move) {
  const stock::Piece whole = piece(cutter, move);
  const auto depth = part_->depth(whole);
  if (!depth) return give_up(depth.error().message);
  if (depth->depth == 0) return;
  Finding f =
      row(Kind::gouge_live, step, move, cutter, depth->point, [&](const stock::Piece& part) {
        const auto touch = part_->depth(part);
        return touch && touch->depth > 0;
      });
  part_->describe(f, cutter.name);
  f.remedy =
      "check the depth, the tool's length and radius offsets, and where the part stands ([part])";
  if (auto taken = part_->take(whole, f, *depth); !taken) return give_up(taken.error().message);
  rows_.tell(std::move(f), depth->depth, depth->volume);
}

void CuttingCheck::compare_with_part(Summary& summary, Findings& out) {
  if (!no_part_.empty()) summary.unchecked.push_back("the result against the part: " + no_part_);
  if (!part_) return;
  summary.part =
      part_->compare(*stock_, at_end(*machine_, *raw_, joints_), end_of_run(t_end_, joints_), out);
}

void CuttingCheck::finish(Summary& summary, Findings& out) {
  if (!raw_) return;
  if (stock()) flush();
  engagement_.finish(out);
  if (stock()) look_for_loose(*scene_, out);
  if (stock()) compare_with_part(summary, out);
  if (!stock()) {
    if (!told_) summary.unchecked.push_back("what the cutter takes from the stock: " + given_up_);
    return;
  }
  Summary::Stock s;
  s.pitch = stock_->pitch();
  s.sweep_bound = tolerance_;
  s.initial_volume = initial_volume_;
  s.volume = initial_volume_ - stock_->volume_of(removed_);
  s.bytes = stock_->bytes();
  s.removed = std::move(removed_when_);
  summary.stock = std::move(s);
}

}  // namespace aircut::sim
