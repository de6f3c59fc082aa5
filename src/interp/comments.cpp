// Comments that do something: MSG, DEBUG, PRINT, LOG…, PROBE…, ABORT.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "interp/dialect.h"
#include "interp/impl.h"

namespace aircut::interp {
namespace {

using Kind = canon::Message::Kind;
using LogKind = canon::LogFile::Kind;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

// The text behind `word` when the comment starts with it (in any case, behind blanks).
std::optional<std::string_view> behind(std::string_view text, std::string_view word) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return std::nullopt;
  text.remove_prefix(first);
  if (text.size() < word.size()) return std::nullopt;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (lower(text[i]) != word[i]) return std::nullopt;
  return text.substr(word.size());
}

// The control writes numbers into 30 bytes, one of which ends the text; what is nearly 0 it takes
// for 0, and -0.4 without decimals is -0.
std::string format(double value, int decimals) {
  if (std::fabs(value) < 1e-4) value = 0;
  std::string text = fixed(value, decimals);
  if (value < 0 && !text.starts_with('-')) text.insert(0, "-");
  return text.size() < 30 ? text : "######";
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// A `#` at `at`: appends the value and advances, or stays.
bool expand_parameter(std::string_view text, std::size_t& at, int decimals, Parameters& parameters,
                      std::string& out) {
  std::size_t end = at + 1;
  std::optional<Fault> fault;
  if (end < text.size() && text[end] == '<') {
    const std::size_t close = text.find('>', end);
    if (close == std::string_view::npos) return false;
    std::string name;
    for (const char c : text.substr(end + 1, close - end - 1))
      if (c != ' ' && c != '\t') name += lower(c);
    // A name of the program that is not known yet has no value; predefined ones always have.
    const std::optional<std::int32_t> id =
        name.starts_with("_") ? parameters.intern(name) : parameters.known(name);
    const auto value = id ? parameters.read_named(*id, {}, fault) : std::nullopt;
    out += value ? format(*value, decimals) : "######";
    at = close + 1;
    return true;
  }
  int n = 0;
  while (end < text.size() && text[end] >= '0' && text[end] <= '9' && n < 100'000)
    n = n * 10 + (text[end++] - '0');
  if (end == text.size() && end == at + 1) {  // a # at the end is nothing at all
    at = end;
    return true;
  }
  if (end == at + 1) return false;
  auto value = n == 0 ? 0.0 : parameters.read(n, {}, fault);
  // The current point, which a word can't read while radius compensation is on.
  const int axis = n - number::current_position;
  if (!value && axis >= 0 && axis < 9)
    value =
        parameters.read_named(parameters.intern(std::string("_") + "xyzabcuvw"[axis]), {}, fault);
  out += value ? format(*value, decimals) : "######";
  at = end;
  return true;
}

// `%d`, `%f`, `%.Nf` set the decimals of what follows.
bool read_format(std::string_view text, std::size_t& at, int& decimals) {
  const std::string_view rest = text.substr(at);
  if (rest.size() >= 2 && rest[1] == 'd') {
    decimals = 0;
    at += 2;
    return true;
  }
  if (rest.size() >= 2 && rest[1] == 'f') {
    decimals = 4;
    at += 2;
    return true;
  }
  if (rest.size() >= 4 && rest[1] == '.' && rest[2] >= '0' && rest[2] <= '9' && rest[3] == 'f') {
    decimals = rest[2] - '0';
    at += 4;
    return true;
  }
  if (rest.size() >= 2 && rest[1] == '.') {  // the control prints the rest without the %
    ++at;
    return true;
  }
  return false;
}

}  // namespace

std::string expand_message(std::string_view text, Parameters& parameters) {
  std::string out;
  int decimals = 6;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '#' && expand_parameter(text, at, decimals, parameters, out)) continue;
    if (text[at] == '%' && read_format(text, at, decimals)) continue;
    out += text[at++];
  }
  return out;
}

void comment_action(std::string_view text, Place place, BlockRun& run) {
  if (!run.session.table.dialect().active_comments)
    return run.emit(canon::Message{Kind::comment, std::string(trimmed(text))});
  const auto expanded = [&](std::string_view what) {
    return expand_message(what, run.session.parameters);
  };
  if (const auto rest = behind(text, "msg,"))
    return run.emit_now(canon::Message{Kind::message, std::string(*rest)});
  if (const auto rest = behind(text, "debug,")) {
    if (run.parameter(number::debug_enabled) > 0)
      run.emit_now(canon::Message{Kind::debug, expanded(*rest)});
    return;
  }
  if (const auto rest = behind(text, "print,"))
    return run.emit_now(canon::Message{Kind::print, expanded(*rest)});
  if (const auto rest = behind(text, "abort,"))
    return run.error("alarm", place, "the program stopped itself: " + printable(expanded(*rest)));
  if (const auto rest = behind(text, "logopen,"))
    return run.emit_now(canon::LogFile{LogKind::open, std::string(*rest)});
  if (const auto rest = behind(text, "logappend,"))
    return run.emit_now(canon::LogFile{LogKind::append, std::string(*rest)});
  if (const auto rest = behind(text, "logclose"))
    return run.emit_now(canon::LogFile{LogKind::close, {}});
  if (const auto rest = behind(text, "log,"))
    return run.emit_now(canon::LogFile{LogKind::write, expanded(*rest)});
  if (const auto rest = behind(text, "probeopen"))
    return run.emit_now(canon::LogFile{LogKind::probe_open, std::string(trimmed(*rest))});
  if (const auto rest = behind(text, "probeclose"))
    return run.emit_now(canon::LogFile{LogKind::probe_close, {}});
  if (behind(text, "py,") || behind(text, "pyrun,")) {
    canon::UserCode code;
    code.code = -1;
    code.remap = "the comment (PY, …)";
    return run.emit(std::move(code));
  }
  if (text.empty()) return;
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  run.emit(canon::Message{Kind::comment, std::string(text)});
}

}  // namespace aircut::interp
