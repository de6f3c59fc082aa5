// The text of a joint log (docs/joint-log.md): lines `# key=value`, a line with the columns' names,
// rows of numbers. Every complaint has its place in the file.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "logbook/columns.h"

namespace aircut::logbook {
namespace {

constexpr std::size_t longest_line = 100'000;
constexpr std::size_t most_joints = 64;
constexpr const char* hint = "; a joint log is what `aircut run --log` writes";

// A whole plain number as the writer writes it.
bool read_number(std::string_view text, double& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(out);
}

}  // namespace

std::vector<std::string> split_list(std::string_view text) {
  std::vector<std::string> out;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    out.emplace_back(text.substr(begin, end - begin));
    if (end == text.size()) return out;
    begin = end + 1;
  }
}

std::vector<Column> columns_of(const std::vector<Joint>& joints) {
  std::vector<Column> out = {{"t", "s", "", false},
                             {"line", "", "", true},
                             {"block", "", "", true},
                             {"motion", "", "", true},
                             {"feed_cmd", "mm/s or deg/s", "", false},
                             {"feed_act", "mm/s or deg/s", "", false},
                             {"s", "mm or deg", "", false}};
  for (const auto& [letter, per] : {std::pair("q", ""), {"v", "/s"}, {"a", "/s^2"}})
    for (std::size_t j = 0; j < joints.size(); ++j)
      out.push_back({letter + std::to_string(j), joints[j].unit + per, "joint", false});
  for (const char* axis : {"x", "y", "z", "a", "b", "c", "u", "v", "w"})
    out.push_back({axis, *axis >= 'a' && *axis <= 'c' ? "deg" : "mm", "machine", false});
  out.push_back({"tool", "", "", true});
  out.push_back({"spindle_rpm", "1/min", "", false});
  out.push_back({"spindle_rev", "1", "", false});
  out.push_back({"sync_error", "mm", "", false});
  out.push_back({"flags", "", "", true});
  return out;
}

std::vector<Joint> joints_of(std::string_view list) {
  std::vector<Joint> out;
  for (const std::string& item : split_list(list)) {
    const std::size_t colon = item.rfind(':');
    const std::string unit = colon == std::string::npos ? "" : item.substr(colon + 1);
    out.push_back({item.substr(0, colon), unit == "mm" || unit == "deg" ? unit : "", 0, 0, 0});
  }
  return out;
}

Diagnostic Reader::wrong(std::size_t begin, std::size_t length, const std::string& message) const {
  SourceSpan span;
  span.text = text_;
  span.begin = begin_ + begin;
  span.length = static_cast<std::uint32_t>(std::min<std::size_t>(length, 200));
  span.line = line_number_;
  return make_error("input", span, message);
}

Diagnostic Reader::wrong_key(const std::string& key, const std::string& message) const {
  const auto place = places_.find(key);
  if (place == places_.end()) return wrong(0, 0, "the header above has no '" + key + "'");
  SourceSpan span;
  span.text = text_;
  span.begin = place->second.first + 2;
  span.length = static_cast<std::uint32_t>(key.size());
  span.line = place->second.second;
  return make_error("input", span, message);
}

bool Reader::next_line() {
  const std::string_view all = text_->content();
  if (at_ >= all.size()) return false;
  const std::size_t end = std::min(all.find('\n', at_), all.size());
  begin_ = at_;
  line_ = all.substr(begin_, end - begin_);
  at_ = end + 1;
  reading_.at(begin_, end);
  ++line_number_;
  return true;
}

Expected<Reader> Reader::open(const SourceText& text) {
  Reader out(text);
  if (auto done = out.read_header(); !done) return unexpected(done.error());
  return out;
}

Expected<void> Reader::read_header() {
  while (next_line()) {
    if (line_.size() > longest_line)
      return unexpected(wrong(0, 20, std::string("a line of more than 100000 characters") + hint));
    if (!line_.starts_with("# ")) break;
    const std::size_t equals = line_.find('=');
    if (equals == std::string_view::npos)
      return unexpected(wrong(0, line_.size(), "a header line is `# key=value`"));
    const std::string key(line_.substr(2, equals - 2));
    if (header_.keys.empty() && (key != "format" || line_.substr(equals + 1) != "aircut-joints-1"))
      return unexpected(
          wrong(0, line_.size(),
                std::string("the first line must be `# format=aircut-joints-1`") + hint));
    if (!header_.keys.emplace(key, line_.substr(equals + 1)).second)
      return unexpected(wrong(2, key.size(), "the key '" + printable(key) + "' is there twice"));
    header_.order.push_back(key);
    places_[key] = {begin_, line_number_};
    line_ = {};
  }
  if (header_.keys.empty()) {
    if (line_number_ == 0)
      return unexpected(make_error("input", "'" + printable(text_->name()) + "' is empty" + hint));
    return unexpected(
        wrong(0, 20, std::string("the first line must be `# format=aircut-joints-1`") + hint));
  }
  if (line_.empty())
    return unexpected(wrong(0, 0, "the line with the names of the columns is missing"));
  if (auto done = read_keys(); !done) return done;
  for (Column& column : columns_of(header_.joints))
    header_.columns.push_back(std::move(column.name));
  std::size_t column = 0, begin = 0;
  for (const std::string& name : split_list(line_)) {
    if (column >= header_.columns.size() || name != header_.columns[column])
      return unexpected(wrong(begin, name.size(),
                              column < header_.columns.size()
                                  ? "the column here must be '" + header_.columns[column] + "'"
                                  : "there are more columns than a log with " +
                                        std::to_string(header_.joints.size()) + " joints has"));
    begin += name.size() + 1;
    ++column;
  }
  if (column < header_.columns.size())
    return unexpected(
        wrong(line_.size(), 0, "the column '" + header_.columns[column] + "' is missing"));
  return {};
}

Expected<double> Reader::number_of(const char* key) const {
  const auto found = header_.keys.find(key);
  double value = 0;
  if (found == header_.keys.end()) return unexpected(wrong_key(key, ""));
  if (!read_number(found->second, value))
    return unexpected(wrong_key(
        key, std::string("'") + key + "' is no number: '" + printable(found->second) + "'"));
  return value;
}

Expected<std::vector<double>> Reader::limits_of(const char* key) const {
  const auto found = header_.keys.find(key);
  if (found == header_.keys.end()) return unexpected(wrong_key(key, ""));
  std::vector<double> out;
  for (const std::string& item : split_list(found->second)) {
    double value = std::numeric_limits<double>::infinity();
    if (item != "inf" && (!read_number(item, value) || !(value > 0)))
      return unexpected(wrong_key(key, std::string("'") + key +
                                           "' must be numbers above 0 or `inf`, not '" +
                                           printable(item) + "'"));
    out.push_back(value);
  }
  if (out.size() != header_.joints.size())
    return unexpected(wrong_key(key, std::string("'") + key + "' has " +
                                         std::to_string(out.size()) + " values for " +
                                         std::to_string(header_.joints.size()) + " joints"));
  return out;
}

Expected<void> Reader::read_keys() {
  const auto joints = header_.keys.find("joints");
  if (joints == header_.keys.end()) return unexpected(wrong_key("joints", ""));
  header_.joints = joints_of(joints->second);
  for (std::size_t j = 0; j < header_.joints.size(); ++j)
    if (header_.joints[j].unit.empty())
      return unexpected(wrong_key("joints", "'joints' must be `name:mm` or `name:deg`, not '" +
                                                printable(split_list(joints->second)[j]) + "'"));
  if (header_.joints.size() > most_joints)
    return unexpected(wrong_key("joints", "there are more than 64 joints"));
  const auto v = limits_of("limits_v"), a = limits_of("limits_a"), j = limits_of("limits_j");
  for (const auto* list : {&v, &a, &j})
    if (!*list) return unexpected(list->error());
  for (std::size_t i = 0; i < header_.joints.size(); ++i) {
    header_.joints[i].v_max = (*v)[i];
    header_.joints[i].a_max = (*a)[i];
    header_.joints[i].j_max = (*j)[i];
  }
  const auto period = number_of("servo_period_s"), end = number_of("end_time_s");
  const auto every = number_of("every"), samples = number_of("samples");
  for (const auto* value : {&period, &end, &every, &samples})
    if (!*value) return unexpected(value->error());
  if (!(*period > 0))
    return unexpected(wrong_key("servo_period_s", "'servo_period_s' must be above 0"));
  if (!(*every >= 1 && *every < 1e9))
    return unexpected(wrong_key("every", "'every' must be at least 1"));
  if (!(*samples >= 0 && *samples < 1e18))
    return unexpected(wrong_key("samples", "'samples' must be 0 or more"));
  header_.period = *period;
  header_.end_time = *end;
  header_.every = static_cast<std::uint64_t>(*every);
  header_.samples = static_cast<std::uint64_t>(*samples);
  if (const auto factors = header_.keys.find("feed_factors"); factors != header_.keys.end()) {
    header_.feed_factors.clear();
    for (const std::string& item : split_list(factors->second)) {
      double& factor = header_.feed_factors.emplace_back();
      if (!read_number(item, factor) || !(factor > 0))
        return unexpected(
            wrong_key("feed_factors",
                      "'feed_factors' must be numbers above 0, not '" + printable(item) + "'"));
    }
  }
  return {};
}

Expected<bool> Reader::next(Row& row) {
  if (!next_line()) return false;
  const std::size_t width = header_.columns.size();
  row.joints = header_.joints.size();
  row.values.resize(width);
  std::size_t begin = 0, column = 0;
  for (;; ++column) {
    const std::size_t end = std::min(line_.find(',', begin), line_.size());
    if (column >= width)
      return unexpected(
          wrong(begin, end - begin, "the row has more than " + std::to_string(width) + " columns"));
    if (!read_number(line_.substr(begin, end - begin), row.values[column]))
      return unexpected(
          wrong(begin, end - begin, "the value of '" + header_.columns[column] + "' is no number"));
    // Line, block, kind of motion and flags are whole numbers.
    const double most = column == 3 ? 1e3 : column + 1 == width ? 1e9 : 1e15;
    const bool whole = (column >= 1 && column <= 3) || column + 1 == width;
    if (const double value = row.values[column];
        whole && !(value >= 0 && value < most && value == std::floor(value)))
      return unexpected(wrong(begin, end - begin,
                              "the value of '" + header_.columns[column] +
                                  "' must be a whole number from 0 to " + shortest(most - 1)));
    if (end == line_.size()) break;
    begin = end + 1;
  }
  if (column + 1 < width)
    return unexpected(wrong(line_.size(), 0,
                            "the row ends before the column '" + header_.columns[column + 1] +
                                "'; was the file cut off?"));
  ++rows_;
  return true;
}

}  // namespace aircut::logbook
