// The joint log as CSV (docs/joint-log.md).
//
// Sample k is at t = k T, computed from the whole number k, so that no error adds up. A segment
// gives the samples of [t_start, t_end); the last sample, at rest, is the first at or after the end
// of the program. The header tells the number of samples and the end time, which are known only
// then: rows go to an unlinked file in the same folder and are copied behind the header at the end.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "log/log.h"

namespace aircut::log {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr std::size_t flush_size = std::size_t{1} << 20;

// Bits of the column `flags`.
enum Flag : unsigned {
  in_blend = 1,
  merged_line = 2,
  feed_limited = 4,
  velocity_limited = 8,
  acceleration_limited = 16,
  jerk_limited = 32,
  locked_to_spindle = 64,
  warning = 128,
  other_tip = 256,
  probe_tripped = 512,
};

unsigned flags_of(const plan::Segment& segment) {
  unsigned flags = 0;
  if (segment.kind == plan::MotionKind::blend) flags |= in_blend;
  if (segment.merged) flags |= merged_line;
  if (segment.failure) flags |= warning;
  switch (segment.limited_by.by) {
    case plan::LimitedBy::none:
      return flags;
    case plan::LimitedBy::feed:
      return flags | feed_limited;
    case plan::LimitedBy::velocity:
      return flags | velocity_limited;
    case plan::LimitedBy::acceleration:
      return flags | acceleration_limited;
    case plan::LimitedBy::jerk:
      return flags | jerk_limited;
  }
  return flags;
}

// In the spindle once the segment is done.
int tool_after(const plan::Segment& segment) {
  if (const auto* change = std::get_if<canon::ChangeTool>(&segment.command.action))
    return change->number;
  if (const auto* number = std::get_if<canon::SetToolNumber>(&segment.command.action))
    return number->number;
  return segment.tool;
}

// How far a synchronised axis is behind the spindle, mm; nothing where it is not synchronised.
std::optional<double> sync_error(const plan::Segment& segment, double t, double s) {
  if (!segment.sync) return std::nullopt;
  return segment.sync->pitch * std::abs(plan::spindle_turns(segment, t)) - s;
}

// True when F counts degrees: the block moves rotary axes alone. The segment may be a small part of
// the block.
bool counts_degrees(const plan::Segment& segment) {
  const auto* line = std::get_if<plan::Line>(&segment.path);
  if (!line) return false;
  const AxisValues way = line->end - line->start;
  for (const Axis axis : all_axes)
    if (!is_rotary(axis) && std::abs(way[axis]) > 1e-7 * (segment.u1 - segment.u0)) return false;
  return true;
}

// Rows until they are copied behind the header. The file has no name, so a crash leaves nothing.
class Spool {
 public:
  Spool() = default;
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;
  ~Spool() {
    if (file_) std::fclose(file_);
  }
  bool open(const std::string& beside) {
    const std::string name = beside + ".rows." + std::to_string(::getpid());
    const int fd = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd < 0) return false;
    ::unlink(name.c_str());
    file_ = ::fdopen(fd, "w+b");
    return file_ != nullptr;
  }
  bool write(const std::string& bytes) {
    return std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size();
  }
  bool copy_to(OutputFile& out) {
    if (std::fflush(file_) != 0) return false;
    std::rewind(file_);
    std::string buffer(flush_size, '\0');
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), file_))
      out.write(std::string_view(buffer.data(), n));
    return std::ferror(file_) == 0;
  }

 private:
  std::FILE* file_ = nullptr;
};

}  // namespace

namespace {

// Differences over the last four rows.
class PeakWatch {
 public:
  void row(const std::vector<double>& q, double period, double t, std::uint64_t line) {
    if (last_[0].empty()) last_.fill(q);
    std::rotate(last_.begin(), last_.begin() + 1, last_.end());
    last_[3] = q;
    peaks_.resize(q.size());
    for (std::size_t j = 0; j < q.size(); ++j) {
      const double a = last_[0][j], b = last_[1][j], c = last_[2][j], d = last_[3][j];
      note(peaks_[j].of[0], (d - c) / period, t, line);
      note(peaks_[j].of[1], (d - 2 * c + b) / (period * period), t, line);
      note(peaks_[j].of[2], (d - 3 * c + 3 * b - a) / (period * period * period), t, line);
    }
  }
  const std::vector<double>& now() const { return last_[3]; }
  const std::vector<JointPeak>& peaks() const { return peaks_; }

 private:
  static void note(JointPeak::At& at, double value, double t, std::uint64_t line) {
    if (std::abs(value) > at.value) at = {std::abs(value), t, line};
  }
  std::array<std::vector<double>, 4> last_;
  std::vector<JointPeak> peaks_;
};

}  // namespace

struct CsvJointLog::Impl {
  Impl(OutputFile output, const machine::Machine& m, JointLogOptions o)
      : file(std::move(output)), machine(m), options(std::move(o)) {
    for (int j = 0; j < machine.joint_count(); ++j)
      scale.push_back(
          machine.joint(machine::JointId{j}).kind == machine::JointKind::rotary ? degrees : 1);
  }

  void step(const sim::Step& step);
  void sample(const sim::Step& step, double t);
  void row(const plan::Segment& segment, const motion::JointState& state, double t);
  void note_chord(const plan::Segment& segment, const motion::JointState& state, double t);
  void finish();
  std::string header() const;
  void flush();
  void fail(std::string message) {
    if (result) result = unexpected(make_error("output_failed", std::move(message)));
  }
  // A column often has the number of the row before: then its text is copied.
  void number(double value) {
    rows.push_back(',');
    if (column == texts.size()) texts.emplace_back();
    Text& last = texts[column++];
    if (!(last.value == value)) {
      last.text.clear();
      append_shortest(last.text, value);
      last.value = value;
    }
    rows += last.text;
  }
  void joints(const machine::JointVector& values) {
    for (Eigen::Index j = 0; j < values.size(); ++j)
      number(values[j] * scale[static_cast<std::size_t>(j)]);
  }

  OutputFile file;
  const machine::Machine& machine;
  JointLogOptions options;
  std::vector<double> scale;  ///< file unit per internal unit, by joint
  Spool spool;
  std::string rows;
  struct Text {
    double value = std::numeric_limits<double>::quiet_NaN();
    std::string text;
  };
  std::vector<Text> texts;  ///< of the last row, by number()
  std::size_t column = 0;
  std::uint64_t next = 0;     ///< number of the next sample
  std::uint64_t written = 0;  ///< rows
  double revolutions = 0;     ///< of the spindle at the end of the steps so far
  double end_time = 0;
  const machine::Kinematics* last_kinematics = nullptr;  ///< of the last row
  AxisValues last_offset;
  std::optional<AxisValues> start_pose;
  bool stepped = false;
  plan::Segment rest;  ///< of the last step, without its path and time law
  motion::JointState rest_state;
  Expected<void> result = {};
  PeakWatch watch;
  ChordError chord;
};

void CsvJointLog::Impl::step(const sim::Step& step) {
  const plan::Segment& segment = step.segment;
  const double t0 = segment.t_start, t1 = segment.t_end();
  stepped = true;
  for (; static_cast<double>(next) * options.period < t1; ++next)
    if (next % static_cast<std::uint64_t>(options.every) == 0)
      sample(step, std::max(static_cast<double>(next) * options.period, t0));
  end_time = t1;
  revolutions += plan::spindle_turns(segment, t1 - t0);
  rest = plan::Segment{};
  rest.command.span = segment.command.span;
  rest.command.block = segment.command.block;
  rest.tool = tool_after(segment);
  rest.tool_offset = segment.tool_offset;
  rest.kinematics = segment.kinematics;
  rest.spindle_rpm = segment.spindle_rpm;
  rest.failure = segment.failure;
  rest.t_start = t1;
  if (const auto q = step.motion.at(t1)) {
    rest_state = {};
    rest_state.q = *q;
    rest_state.v = rest_state.a = machine::JointVector::Zero(q->size());
    rest_state.tip = step.motion.tip_at(t1);
  } else {
    fail("the joints at t = " + shortest(t1) + " s can't be computed: " + q.error().reason);
  }
}

void CsvJointLog::Impl::sample(const sim::Step& step, double t) {
  const auto state = step.motion.state_at(t);
  if (!state)
    return fail("the joints at t = " + shortest(t) +
                " s can't be computed: " + state.error().reason);
  row(step.segment, *state, static_cast<double>(next) * options.period);
}

void CsvJointLog::Impl::row(const plan::Segment& segment, const motion::JointState& state,
                            double t) {
  const double feed_scale = counts_degrees(segment) ? degrees : 1;
  unsigned flags = flags_of(segment);
  // The tip is where another length or another kinematics has it: the joints have not jumped.
  if (written > 0 &&
      (segment.kinematics != last_kinematics || !(segment.tool_offset == last_offset)))
    flags |= other_tip;
  last_kinematics = segment.kinematics;
  last_offset = segment.tool_offset;
  column = 0;
  append_shortest(rows, t);
  rows += ',';
  rows += std::to_string(segment.command.span.line);
  rows += ',';
  rows += std::to_string(segment.command.block);
  rows += ',';
  rows += std::to_string(static_cast<int>(segment.kind));
  number(segment.feed * feed_scale);
  number(state.path_speed * feed_scale);
  number(state.s * feed_scale);
  joints(state.q);
  if (options.every == 1) {
    std::vector<double> q(scale.size());
    for (std::size_t j = 0; j < q.size(); ++j)
      q[j] = state.q[static_cast<Eigen::Index>(j)] * scale[j];
    watch.row(q, options.period, t, segment.command.span.line);
  }
  if (options.every == 1) note_chord(segment, state, t);
  if (segment.trip && state.s >= *segment.trip) flags |= probe_tripped;
  joints(state.v);
  joints(state.a);
  // What the joints really reach, not what was asked for.
  auto pose =
      plan::kinematics_of(segment, machine.kinematics()).forward(state.q, segment.tool_offset);
  if (!pose) flags |= warning;
  const AxisValues& tip = pose ? *pose : state.tip;
  for (const Axis axis : all_axes) number(tip[axis] * (is_rotary(axis) ? degrees : 1));
  rows += ',';
  rows += std::to_string(segment.tool);
  const double since = std::max(t - segment.t_start, 0.0);
  const auto error = sync_error(segment, since, state.s);
  constexpr double locked = 1e-4;  // mm
  if (error && std::abs(*error) < locked) flags |= locked_to_spindle;
  number(plan::spindle_rpm(segment, since));
  number(revolutions + plan::spindle_turns(segment, since));
  number(error.value_or(0));
  rows += ',';
  rows += std::to_string(flags);
  rows += '\n';
  ++written;
  if (rows.size() > flush_size) flush();
}

// Between rows the tip leaves the chord of the joints by T²/8 times the acceleration that is left
// with steady joints: with its second difference over half a period to either side, by half of
// that.
void CsvJointLog::Impl::note_chord(const plan::Segment& segment, const motion::JointState& state,
                                   double t) {
  const machine::Kinematics& kinematics = plan::kinematics_of(segment, machine.kinematics());
  if (kinematics.type() == "identity" || state.v.isZero(0)) return;
  const machine::JointVector half = options.period / 2 * state.v;
  const auto tip = [&](const machine::JointVector& q) {
    return kinematics.forward(q, segment.tool_offset);
  };
  const auto before = tip(state.q - half), here = tip(state.q), after = tip(state.q + half);
  if (!before || !here || !after) return;
  const AxisValues bend = *before - *here + (*after - *here);
  const double value = std::hypot(bend[Axis::x], bend[Axis::y], bend[Axis::z]) / 2;
  if (value > chord.value) chord = {value, t, segment.command.span.line};
}

void CsvJointLog::Impl::flush() {
  if (!spool.write(rows)) fail("the joint log's rows could not be written; is the disk full?");
  rows.clear();
}

std::string CsvJointLog::Impl::header() const {
  std::string out;
  const auto key = [&out](const char* name, const std::string& value) {
    out += std::string("# ") + name + "=" + printable(value) + "\n";
  };
  std::string names, v, a, j, row = "t,line,block,motion,feed_cmd,feed_act,s";
  bool jerk = false;
  for (int i = 0; i < machine.joint_count(); ++i) {
    const machine::Joint& joint = machine.joint(machine::JointId{i});
    const double unit = scale[static_cast<std::size_t>(i)];
    const char* comma = i > 0 ? "," : "";
    names += comma + joint.name + (joint.kind == machine::JointKind::rotary ? ":deg" : ":mm");
    v += comma + shortest(joint.vmax * unit);
    a += comma + shortest(joint.amax * unit);
    jerk = jerk || !std::isinf(joint.jmax);
    j += comma + (std::isinf(joint.jmax) ? "inf" : shortest(joint.jmax * unit));
  }
  for (const char* letter : {"q", "v", "a"})
    for (int i = 0; i < machine.joint_count(); ++i)
      row += std::string(",") + letter + std::to_string(i);
  row += ",x,y,z,a,b,c,u,v,w,tool,spindle_rpm,spindle_rev,sync_error,flags\n";
  std::string pose;
  const AxisValues start = start_pose.value_or(AxisValues{});
  for (const Axis axis : all_axes)
    pose += (axis == Axis::x ? "" : ",") + shortest(start[axis] * (is_rotary(axis) ? degrees : 1));
  key("format", "aircut-joints-1");
  key("program", options.program);
  key("program_sha256", options.program_sha256);
  key("machine", machine.name());
  key("machine_sha256", options.machine_sha256);
  key("kinematics", std::string(machine.kinematics().type()));
  key("servo_period_s", shortest(options.period));
  key("every", std::to_string(options.every));
  key("joints", names);
  key("linear_unit", "mm");
  key("angular_unit", "deg");
  key("limits_v", v);
  key("limits_a", a);
  key("limits_j", j);
  key("planner", jerk ? "third" : "second");
  key("default_p_mm", "0");
  key("default_q_mm", "0");
  if (!options.feed_factors.empty()) {
    std::string factors;
    for (const double factor : options.feed_factors)
      factors += (factors.empty() ? "" : ",") + shortest(factor);
    key("feed_factors", factors);
  }
  key("start_pose", pose);
  key("end_time_s", shortest(end_time));
  key("samples", std::to_string(written));
  return out + row;
}

void CsvJointLog::Impl::finish() {
  // The last sample is at rest. A multiple of the period that misses the end by rounding only
  // counts as the end.
  while (static_cast<double>(next) * options.period < end_time - 1e-9 * options.period) ++next;
  if (stepped && result) row(rest, rest_state, static_cast<double>(next) * options.period);
  // The machine stands behind the last row.
  const std::vector<double> last = watch.now();
  for (int k = 1; k <= 3 && !last.empty(); ++k)
    watch.row(last, options.period, static_cast<double>(next) * options.period,
              rest.command.span.line);
  flush();
  if (!result) return;
  file.write(header());
  if (!spool.copy_to(file)) return fail("the joint log's rows could not be read back");
  result = file.commit();
}

CsvJointLog::CsvJointLog() = default;
CsvJointLog::~CsvJointLog() = default;

Expected<std::unique_ptr<CsvJointLog>> CsvJointLog::create(const std::string& path,
                                                           const machine::Machine& machine,
                                                           JointLogOptions options) {
  if (!(options.period > 0) || options.every < 1)
    return unexpected(make_error("usage", "the log period must be above 0 and every at least 1"));
  auto file = OutputFile::create(path);
  if (!file) return unexpected(file.error());
  std::unique_ptr<CsvJointLog> out(new CsvJointLog);
  out->impl_ = std::make_unique<Impl>(std::move(*file), machine, std::move(options));
  if (!out->impl_->spool.open(path))
    return unexpected(make_error(
        "output_failed", "can't write beside '" + printable(path) + "': " + std::strerror(errno)));
  return out;
}

void CsvJointLog::on_start(const sim::Scene&, const sim::JointVector& joints) {
  if (const auto tip = impl_->machine.kinematics().forward(joints, AxisValues{}))
    impl_->start_pose = *tip;
}
void CsvJointLog::on_step(const sim::Step& step) { impl_->step(step); }
void CsvJointLog::on_finish(const sim::Summary&) { impl_->finish(); }
Expected<void> CsvJointLog::result() const { return impl_->result; }
std::optional<ChordError> CsvJointLog::chord_error() const {
  if (impl_->options.every != 1) return std::nullopt;
  return impl_->chord;
}
const std::vector<JointPeak>& CsvJointLog::peaks() const { return impl_->watch.peaks(); }

}  // namespace aircut::log
