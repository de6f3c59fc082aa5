// REMAP lines. The order of the tests and what is only a warning follow the control: options by
// any beginning of their name, text behind '#' cut off, a code once.
#include <algorithm>
#include <array>
#include <cctype>

#include "interp/code_table.h"
#include "linuxcnc/linuxcnc.h"

namespace aircut::linuxcnc {
namespace {

constexpr const char* kind = "ini_remap";

struct Part {
  std::string text;
  std::size_t at = 0;  // in the value
};

std::vector<Part> parts_of(const std::string& value) {
  std::vector<Part> parts;
  const std::size_t end = std::min(value.find('#'), value.size());
  for (std::size_t i = 0; i < end;) {
    const std::size_t from = value.find_first_not_of(" \t", i);
    if (from >= end) break;
    i = std::min(value.find_first_of(" \t", from), end);
    parts.push_back({value.substr(from, i - from), from});
  }
  return parts;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 6 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Codes that the control does not know itself, and those that it lets go all the same.
bool is_remappable(char letter, int code) {
  static constexpr std::array m = {0, 1, 6, 60, 61};
  static constexpr std::array g = {280, 281, 300, 301};
  const interp::CodeTable table;
  if (letter == 'M')
    return code < 1000 && (code >= 100 || !table.find('M', code) ||
                           std::find(m.begin(), m.end(), code) != m.end());
  return code > 0 && code < 1000 &&
         (!table.find_g(code) || std::find(g.begin(), g.end(), code) != g.end());
}

class RemapLine {
 public:
  RemapLine(const std::string& value, const SourceSpan& span, Diagnostics& out)
      : value_(value), span_(span), out_(out) {
    remap_.span = span;
  }

  std::optional<interp::Remap> read() {
    const std::vector<Part> parts = parts_of(value_);
    if (parts.empty()) {
      error(span_, "REMAP needs a code, such as M400, and ngc=NAME");
      return std::nullopt;
    }
    for (std::size_t i = 1; i < parts.size(); ++i) option(parts[i]);
    const SourceSpan code = place(parts.front());
    if (good_ && remap_.ngc.empty() && !python_body_)
      error(code, "the remap of " + printable(parts.front().text) +
                      " says not what to call; add ngc=NAME");
    if (!good_ || !read_code(parts.front(), code)) return std::nullopt;
    return remap_;
  }

 private:
  SourceSpan place(const Part& part) const {
    SourceSpan span = span_;
    if (part.at + part.text.size() > span_.length) return span;  // on a later line
    span.begin += part.at;
    span.length = static_cast<std::uint32_t>(part.text.size());
    return span;
  }
  void error(const SourceSpan& span, std::string message) {
    out_.error(kind, span, std::move(message));
    good_ = false;
  }

  void option(const Part& part) {
    const std::size_t equals = part.text.find('=');
    const std::string name = lower(part.text.substr(0, equals));
    const std::string value =
        equals == std::string::npos ? std::string() : part.text.substr(equals + 1);
    const SourceSpan span = place(part);
    if (value.empty())
      return error(span, "'" + printable(part.text) + "' lacks its value; write NAME=value");
    const auto is = [&](std::string_view word) { return word.starts_with(name); };
    if (is("modalgroup")) {
      remap_.modal_group = is_number(value) ? std::stoi(value) : 0;
      group_given_ = true;
    } else if (is("argspec")) {
      argspec(value, span);
    } else if (is("prolog") || is("epilog")) {
      python(part.text);
    } else if (is("ngc")) {
      if (python_body_) return error(span, "a remap calls either ngc= or python=, not both");
      remap_.ngc = lower(value);
    } else if (is("python")) {
      if (!remap_.ngc.empty()) return error(span, "a remap calls either ngc= or python=, not both");
      python_body_ = true;
      python(part.text);
    } else {
      const std::array<std::string, 6> known = {"modalgroup", "argspec", "prolog",
                                                "epilog",     "ngc",     "python"};
      out_.warning("ini_ignored", span,
                   "the control takes no notice of '" + printable(part.text) + "'." +
                       did_you_mean(name, known));
    }
  }

  void argspec(const std::string& value, const SourceSpan& span) {
    const std::size_t bad =
        value.find_first_not_of("ABCDEFGHIJKLMNPQRSTUVWXYZabcdefghijklmnpqrstuvwxyz>^@");
    // A lone '-' is the old way to say: none.
    if (bad != std::string::npos)
      return error(span, "argspec takes the letters of words, and > ^ @; '" +
                             printable(value.substr(bad, 1)) + "' is none of them");
    remap_.argspec = value;
  }

  void python(const std::string& text) {
    remap_.python += (remap_.python.empty() ? "" : " ") + text;
  }

  bool read_code(const Part& part, const SourceSpan& span) {
    const char letter =
        static_cast<char>(std::toupper(static_cast<unsigned char>(part.text.front())));
    const std::string rest = part.text.substr(1);
    remap_.letter = letter;
    remap_.name = letter + rest;
    if (letter == 'T' || letter == 'S' || letter == 'F') {
      if (rest.empty() && !group_given_) return true;
      error(span, rest.empty()
                      ? "T, S and F have no modal group; leave modalgroup= out"
                      : "only the letter alone can be remapped: " + std::string(1, letter));
      return false;
    }
    if (letter == 'M') return read_m(rest, span);
    if (letter == 'G') return read_g(rest, span);
    out_.warning("ini_ignored", span,
                 "only G, M, T, S and F can be remapped; the control takes no notice of this line");
    return false;
  }

  bool read_m(const std::string& rest, const SourceSpan& span) {
    if (!is_number(rest)) {
      error(span, "an M code is a whole number, such as M400");
      return false;
    }
    remap_.code = std::stoi(rest);
    if (!group_given_) remap_.modal_group = 10;
    if (remap_.modal_group < 4 || remap_.modal_group > 10) {
      error(span, "M codes belong to a modal group from 4 to 10; give modalgroup=10");
      return false;
    }
    return is_free(is_remappable('M', remap_.code), span);
  }

  bool read_g(const std::string& rest, const SourceSpan& span) {
    const std::size_t point = rest.find('.');
    const std::string whole = rest.substr(0, point);
    const std::string tenth = point == std::string::npos ? "0" : rest.substr(point + 1);
    if (!is_number(whole) || !is_number(tenth) || tenth.size() != 1) {
      error(span, "a G code is a number with one decimal at most, such as G88.1");
      return false;
    }
    remap_.code = 10 * std::stoi(whole) + std::stoi(tenth);
    if (!group_given_) remap_.modal_group = 1;
    if (remap_.modal_group != 1) {
      error(span, "a G code can be remapped in modal group 1 only; give modalgroup=1");
      return false;
    }
    return is_free(is_remappable('G', remap_.code), span);
  }

  bool is_free(bool free, const SourceSpan& span) {
    if (!free)
      out_.warning("ini_ignored", span,
                   remap_.name +
                       " is a code of the control that can't be remapped; it keeps its "
                       "meaning");
    return free;
  }

  const std::string& value_;
  const SourceSpan& span_;
  Diagnostics& out_;
  interp::Remap remap_;
  bool group_given_ = false, python_body_ = false, good_ = true;
};

}  // namespace

std::optional<interp::Remap> read_remap(const std::string& value, const SourceSpan& span,
                                        Diagnostics& out) {
  return RemapLine(value, span, out).read();
}

}  // namespace aircut::linuxcnc
