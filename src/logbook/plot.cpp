// A log as a picture. Time runs to the right, the same in all panels: where each joint is; the feed
// commanded and reached; how much of its speed, acceleration and jerk limit each joint uses; below,
// the kind of motion and what held the speed. Numbers of program lines stand on top.
//
// A column of pixels may stand for thousands of rows: of each it keeps the first, least, largest
// and last value, so that no peak is lost and memory does not grow with the log.
#include <algorithm>
#include <cmath>
#include <limits>

#include "logbook/canvas.h"
#include "logbook/logbook.h"
#include "logbook/scale.h"

namespace aircut::logbook {
namespace {

constexpr double left = 96, right = 150, top = 78, gap = 26, joint_height = 74, panel_height = 120;
constexpr Colour red{0.8, 0.1, 0.1};
struct Sort {
  const char* name;
  Colour colour;
};
constexpr std::array<Sort, 9> motions = {{{"idle", {0.93, 0.93, 0.93}},
                                          {"rapid", {0.95, 0.75, 0.30}},
                                          {"feed", {0.35, 0.65, 0.90}},
                                          {"arc", {0.15, 0.45, 0.75}},
                                          {"tool change", {0.55, 0.55, 0.55}},
                                          {"probe", {0.80, 0.47, 0.65}},
                                          {"dwell", {0.75, 0.75, 0.75}},
                                          {"thread", {0.0, 0.62, 0.45}},
                                          {"blend", {0.55, 0.80, 0.95}}}};
constexpr std::array<Sort, 5> causes = {{{"nothing", {0.93, 0.93, 0.93}},
                                         {"feed", {0.35, 0.65, 0.90}},
                                         {"joint speed", {0.0, 0.62, 0.45}},
                                         {"acceleration", {0.95, 0.75, 0.30}},
                                         {"jerk", {0.84, 0.37, 0.0}}}};

std::size_t cause_of(unsigned flags) {
  for (std::size_t i = 0; i < 4; ++i)
    if ((flags & (4U << i)) != 0) return i + 1;
  return 0;
}

// A value over the columns.
class Trace {
 public:
  explicit Trace(std::size_t columns) : columns_(columns) {}
  void add(std::size_t column, double value) {
    Column& c = columns_[column];
    if (!c.used) c = {value, value, value, value, true};
    c.low = std::min(c.low, value);
    c.high = std::max(c.high, value);
    c.last = value;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  template <class Y>
  std::vector<Spot> spots(Y y) const {
    std::vector<Spot> out;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const Column& c = columns_[i];
      if (!c.used) continue;
      const double x = left + static_cast<double>(i) + 0.5;
      for (const double value : {c.first, c.low, c.high, c.last}) out.push_back({x, y(value)});
    }
    return out;
  }
  double low = std::numeric_limits<double>::infinity(), high = -low;

 private:
  struct Column {
    double first = 0, low = 0, high = 0, last = 0;
    bool used = false;
  };
  std::vector<Column> columns_;
};

// Which of a few sorts fills most of each column.
template <std::size_t N>
struct Band {
  explicit Band(std::size_t columns) : counts(columns) {}
  void add(std::size_t column, std::size_t sort) {
    ++counts[column][std::min(sort, N - 1)];
    seen[std::min(sort, N - 1)] = true;
  }
  std::vector<std::array<std::uint32_t, N>> counts;
  std::array<bool, N> seen{};
};

class Plot {
 public:
  Plot(const Header& header, const PlotOptions& options);
  Expected<void> read(Reader& reader);
  Expected<std::string> draw();

 private:
  struct Panel {
    double y, height, low, high;
    double at(double value) const { return y + height * (high - value) / (high - low); }
  };
  std::size_t column_of(double t) const {
    const double f = (t - from_) / (to_ - from_) * static_cast<double>(columns_);
    return static_cast<std::size_t>(std::clamp(f, 0.0, static_cast<double>(columns_ - 1)));
  }
  void shares(const Row& row, std::size_t column);
  void title(Canvas& canvas);
  void lines_on_top(Canvas& canvas);
  Panel panel(Canvas& canvas, double y, double height, double low, double high,
              const std::string& name, const std::string& unit);
  void joint_panels(Canvas& canvas, double& y);
  void feed_panel(Canvas& canvas, double& y);
  void share_panel(Canvas& canvas, double& y, const std::vector<Trace>& traces,
                   const std::string& name, double Joint::*limit);
  template <std::size_t N>
  void band(Canvas& canvas, double& y, const Band<N>& band, const std::array<Sort, N>& sorts,
            const std::string& name);
  void time_axis(Canvas& canvas, double y);

  const Header& header_;
  PlotOptions options_;
  std::size_t columns_;
  double from_, to_;
  bool has_jerk_ = false;
  std::vector<Trace> q_, v_, a_, j_;
  Trace feed_, command_;
  Band<motions.size()> motion_;
  Band<causes.size()> cause_;
  std::vector<std::uint64_t> line_;  ///< by column, 0 = none
  std::vector<std::vector<double>> last_;
};

Plot::Plot(const Header& header, const PlotOptions& options)
    : header_(header),
      options_(options),
      columns_(static_cast<std::size_t>(options.width - static_cast<int>(left + right))),
      from_(std::max(0.0, options.from)),
      to_(std::min(options.to, std::max(header.end_time, header.period))),
      feed_(columns_),
      command_(columns_),
      motion_(columns_),
      cause_(columns_),
      line_(columns_, 0) {
  for (auto* traces : {&q_, &v_, &a_, &j_}) traces->assign(header.joints.size(), Trace(columns_));
  for (const Joint& joint : header.joints)
    has_jerk_ = has_jerk_ || (!std::isinf(joint.j_max) && header.every == 1);
}

void Plot::shares(const Row& row, std::size_t column) {
  std::vector<double> q;
  for (std::size_t j = 0; j < row.joints; ++j) {
    q.push_back(row.q(j));
    v_[j].add(column, 100 * row.v(j) / header_.joints[j].v_max);
    a_[j].add(column, 100 * row.a(j) / header_.joints[j].a_max);
  }
  if (!has_jerk_) return;
  last_.push_back(std::move(q));
  if (last_.size() < 4) return;
  const double t3 = header_.period * header_.period * header_.period;
  for (std::size_t j = 0; j < row.joints; ++j)
    j_[j].add(column, 100 * (last_[3][j] - 3 * last_[2][j] + 3 * last_[1][j] - last_[0][j]) / t3 /
                          header_.joints[j].j_max);
  last_.erase(last_.begin());
}

Expected<void> Plot::read(Reader& reader) {
  for (Row row;;) {
    const auto more = reader.next(row);
    if (!more) return unexpected(more.error());
    if (!*more) return {};
    if (row.t() < from_ || row.t() > to_ + header_.period) continue;
    const std::size_t column = column_of(row.t());
    for (std::size_t j = 0; j < row.joints; ++j) q_[j].add(column, row.q(j));
    shares(row, column);
    feed_.add(column, 60 * row.feed());
    command_.add(column, 60 * row.feed_command());
    motion_.add(column, static_cast<std::size_t>(row.motion()));
    cause_.add(column, cause_of(row.flags()));
    if (line_[column] == 0) line_[column] = row.line();
  }
}

void Plot::title(Canvas& canvas) {
  const auto key = [&](const char* name) {
    const auto found = header_.keys.find(name);
    return found == header_.keys.end() ? std::string() : printable(found->second);
  };
  canvas.text(left, 24, key("program") + "  on  " + key("machine"), 16, black, Align::left, true);
  std::string text = "cycle time " + fixed(header_.end_time, 3) + " s";
  if (from_ > 0 || to_ < header_.end_time)
    text += ", shown " + fixed(from_, 3) + " to " + fixed(to_, 3) + " s";
  canvas.text(left, 43, text, 12, grey);
}

void Plot::lines_on_top(Canvas& canvas) {
  canvas.text(left - 10, top - 10, "line", 11, grey, Align::right);
  double free_from = 0;
  std::uint64_t last = 0;
  for (std::size_t i = 0; i < columns_; ++i) {
    if (line_[i] == 0 || line_[i] == last) continue;
    last = line_[i];
    const double x = left + static_cast<double>(i);
    if (x < free_from) continue;
    const std::string text = std::to_string(last);
    canvas.polyline({{x, top - 6}, {x, top - 2}}, grey, 1);
    canvas.text(x, top - 10, text, 10, grey);
    free_from = x + canvas.text_width(text, 10) + 24;
  }
}

Plot::Panel Plot::panel(Canvas& canvas, double y, double height, double low, double high,
                        const std::string& name, const std::string& unit) {
  const auto width = static_cast<double>(columns_);
  if (!(high > low)) {
    low -= 1;
    high += 1;
  }
  const Panel out{y, height, low, high};
  const double step = nice_step((high - low) / (height / 34));
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    const double at = out.at(k * step);
    canvas.polyline({{left, at}, {left + width, at}}, pale, 1);
    canvas.text(left - 8, at + 4, number(k * step, step), 10, grey, Align::right);
  }
  for (const double x : {left, left + width}) canvas.polyline({{x, y}, {x, y + height}}, grey, 1);
  canvas.text(8, y + 10, name, 12, black, Align::left, true);
  canvas.text(8, y + 24, unit, 10, grey);
  return out;
}

void Plot::joint_panels(Canvas& canvas, double& y) {
  for (std::size_t j = 0; j < q_.size(); ++j) {
    const Joint& joint = header_.joints[j];
    // A joint that stands must not be drawn as its rounding.
    constexpr double least_span = 0.02;
    const double span = q_[j].high - q_[j].low;
    const double room = std::max(0.05 * span, (least_span - span) / 2);
    const Panel p = panel(canvas, y, joint_height, q_[j].low - room, q_[j].high + room,
                          printable(joint.name), joint.unit);
    const auto color = colours[j % colours.size()];
    canvas.polyline(q_[j].spots([&](double value) { return p.at(value); }), color, 1.5);
    const double x = left + static_cast<double>(columns_) + 8;
    canvas.text(x, y + 12, "max " + number(q_[j].high, 0.001), 10, grey);
    canvas.text(x, y + joint_height - 4, "min " + number(q_[j].low, 0.001), 10, grey);
    y += joint_height + 12;
  }
  y += gap - 12;
}

void Plot::feed_panel(Canvas& canvas, double& y) {
  // The scale is that of cutting; rapids are many times as fast and are cut off.
  const bool cuts = command_.high > 0;
  const double high = std::max(cuts ? command_.high : feed_.high, 1e-3) * 1.15;
  const Panel p = panel(canvas, y, panel_height, 0, high, "feed", "mm/min");
  const auto at = [&](double value) { return p.at(value); };
  const auto width = static_cast<double>(columns_);
  constexpr Colour programmed{0.85, 0.45, 0.1};
  canvas.clip(left, y, width, panel_height);
  canvas.polyline(command_.spots(at), programmed, 1, 4);
  canvas.polyline(feed_.spots(at), colours[0], 1.3);
  canvas.clip_off();
  const double x = left + width + 8;
  canvas.text(x, y + 12, "reached", 11, colours[0]);
  canvas.text(x, y + 27, "programmed", 11, programmed);
  if (feed_.high > high) {
    canvas.text(x, y + 44, "rapids are cut off,", 10, grey);
    canvas.text(x, y + 57, "up to " + number(feed_.high, 1), 10, grey);
  }
  y += panel_height + gap;
}

void Plot::share_panel(Canvas& canvas, double& y, const std::vector<Trace>& traces,
                       const std::string& name, double Joint::*limit) {
  double most = 100;
  for (const Trace& trace : traces)
    if (trace.high >= trace.low) most = std::max({most, std::abs(trace.low), std::abs(trace.high)});
  most = std::min(most * 1.08, 1000.0);
  const Panel p = panel(canvas, y, panel_height, -most, most, name, "% of limit");
  const auto width = static_cast<double>(columns_);
  for (const double share : {-100.0, 100.0})
    canvas.polyline({{left, p.at(share)}, {left + width, p.at(share)}}, red, 1, 6);
  canvas.clip(left, y, width, panel_height);
  for (std::size_t j = 0; j < traces.size(); ++j)
    canvas.polyline(traces[j].spots([&](double value) { return p.at(value); }),
                    colours[j % colours.size()], 1.1);
  canvas.clip_off();
  for (std::size_t j = 0; j < traces.size(); ++j) {
    const double used = std::max(std::abs(traces[j].low), std::abs(traces[j].high));
    const bool limited = !std::isinf(header_.joints[j].*limit);
    const double row = panel_height / std::max(8.0, static_cast<double>(traces.size()));
    canvas.text(left + width + 8, y + 11 + row * static_cast<double>(j),
                printable(header_.joints[j].name) + "  " +
                    (limited && std::isfinite(used) ? number(used, 0.1) + " %" : "no limit"),
                11, colours[j % colours.size()]);
  }
  y += panel_height + gap;
}

template <std::size_t N>
void Plot::band(Canvas& canvas, double& y, const Band<N>& band, const std::array<Sort, N>& sorts,
                const std::string& name) {
  constexpr double height = 18;
  canvas.text(8, y + 13, name, 12, black, Align::left, true);
  std::size_t last = 0;
  for (std::size_t i = 0; i < columns_; ++i) {
    const auto& counts = band.counts[i];
    const auto most = std::max_element(counts.begin(), counts.end());
    if (*most > 0) last = static_cast<std::size_t>(most - counts.begin());
    canvas.fill(left + static_cast<double>(i), y, 1, height, sorts[last].colour);
  }
  double x = left;
  for (std::size_t s = 0; s < N; ++s) {
    if (!band.seen[s]) continue;
    canvas.fill(x, y + height + 6, 11, 11, sorts[s].colour);
    canvas.text(x + 16, y + height + 16, sorts[s].name, 11, black);
    x += 36 + canvas.text_width(sorts[s].name, 11);
  }
  y += height + 34;
}

void Plot::time_axis(Canvas& canvas, double y) {
  const auto width = static_cast<double>(columns_);
  const double step = nice_step((to_ - from_) / (width / 90));
  canvas.text(8, y + 4, "time", 12, black, Align::left, true);
  canvas.polyline({{left, y - 10}, {left + width, y - 10}}, grey, 1);
  for (double k = std::ceil(from_ / step - 1e-9); k * step <= to_ + 1e-9 * step; ++k) {
    const double x = left + width * (k * step - from_) / (to_ - from_);
    canvas.polyline({{x, y - 10}, {x, y - 5}}, grey, 1);
    canvas.text(x, y + 8, number(k * step, step) + " s", 11, grey, Align::middle);
  }
}

Expected<std::string> Plot::draw() {
  const auto joints = static_cast<double>(header_.joints.size());
  const double panels = has_jerk_ ? 4 : 3;
  const double needed =
      top + joints * (joint_height + 12) + gap + panels * (panel_height + gap) + 150;
  Canvas canvas(options_.width, static_cast<int>(needed));
  title(canvas);
  lines_on_top(canvas);
  double y = top + 4;
  joint_panels(canvas, y);
  feed_panel(canvas, y);
  share_panel(canvas, y, v_, "speed", &Joint::v_max);
  share_panel(canvas, y, a_, "accel.", &Joint::a_max);
  if (has_jerk_) share_panel(canvas, y, j_, "jerk", &Joint::j_max);
  band(canvas, y, motion_, motions, "motion");
  band(canvas, y, cause_, causes, "limited by");
  time_axis(canvas, y + 14);
  return canvas.png();
}

}  // namespace

Expected<std::string> plot(const SourceText& log, const PlotOptions& options) {
  auto reader = Reader::open(log);
  if (!reader) return unexpected(reader.error());
  if (options.width < 600 || options.width > 16384)
    return unexpected(make_error("usage", "a plot is 600 to 16384 pixels wide"));
  const Header header = reader->header();
  if (!(options.from < std::min(options.to, std::max(header.end_time, header.period))))
    return unexpected(make_error("usage", "there is no such time in the log, which ends at " +
                                              shortest(header.end_time) + " s"));
  Plot plot(header, options);
  if (auto done = plot.read(*reader); !done) return unexpected(done.error());
  if (reader->rows() == 0)
    return unexpected(make_error("input", "the log has no rows to be drawn"));
  return plot.draw();
}

}  // namespace aircut::logbook
