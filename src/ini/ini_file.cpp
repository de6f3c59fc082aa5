// The control reads a set-up file anew for each key: it runs through the raw lines up to the first
// `[SECTION]`, then through joined lines (those that end with `\` and the next) up to one that
// begins with `[`. So a `[B]` in a continued line ends no section, but begins one. Reading once
// gives the same when both views are kept: starts of sections from raw lines, entries from joined
// ones.
#include <algorithm>
#include <cmath>
#include <set>

#include "ini/ini.h"

namespace aircut::ini {
namespace {

constexpr std::size_t max_line = 255;       // bytes; the rest is a line of its own
constexpr std::size_t max_extensions = 20;  // lines that one line goes on with

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool ends_key(char c) { return is_blank(c) || c == '='; }

struct RawLine {
  SourceSpan span;
  std::string_view text() const { return span.covered(); }
};

/// Where what counts begins: behind blanks; `npos` in blank lines and comments.
std::size_t first_of(std::string_view line) {
  const std::size_t at = line.find_first_not_of(" \t\r");
  if (at == std::string_view::npos || line[at] == '#' || line[at] == ';')
    return std::string_view::npos;
  return at;
}

SourceSpan part_of(const SourceSpan& line, std::size_t begin, std::size_t length) {
  SourceSpan part = line;
  part.begin += begin;
  part.length = static_cast<std::uint32_t>(length);
  return part;
}

class Reader {
 public:
  Reader(const SourceReader& include, Diagnostics& out) : include_(include), out_(out) {}

  IniFile read(const SourceText& text) {
    // Without a line `#INCLUDE` at the margin, indented ones are comments.
    const std::string_view content = text.content();
    includes_ =
        content.starts_with("#INCLUDE") || content.find("\n#INCLUDE") != std::string_view::npos;
    if (readable(text)) split(text, includes_);
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const std::size_t at = first_of(lines_[i].text());
      if (at != std::string_view::npos && lines_[i].text()[at] == '[') begin_section(i, at);
    }
    return IniFile(std::move(sections_));
  }

 private:
  bool readable(const SourceText& text) {
    const std::string_view content = text.content();
    SourceSpan at{&text, 0, 0, 1};
    if (content.starts_with("\xef\xbb\xbf"))
      out_.warning("ini_line", at,
                   "the file begins with a byte order mark, which hides its first line from the "
                   "control; save it as UTF-8 without one");
    if (content.starts_with("\xff\xfe") || content.starts_with("\xfe\xff")) {
      out_.error("encoding", at, "the text is UTF-16; save it as UTF-8 or plain text");
      return false;
    }
    const std::size_t nul = content.find('\0');
    if (nul == std::string_view::npos) return true;
    at.line = static_cast<std::uint32_t>(
        1 + std::count(content.begin(), content.begin() + static_cast<long>(nul), '\n'));
    at.begin = nul;
    at.length = 1;
    out_.error("encoding", at, "this is not a text: it holds a zero byte");
    return false;
  }

  // Lines of at most 255 bytes, with those of included files in between.
  void split(const SourceText& text, bool includes) {
    const std::string_view content = text.content();
    std::uint32_t number = 0;
    for (std::size_t at = 0; at < content.size();) {
      const std::size_t end = std::min(content.find('\n', at), content.size());
      ++number;
      if (const std::size_t cr = content.substr(at, end - at).find('\r');
          cr != std::string_view::npos && at + cr + 1 < end) {
        out_.error("encoding", SourceSpan{&text, at + cr, 1, number},
                   "a carriage return stands inside a line; the control stops reading here. Save "
                   "the file with Unix line ends");
        return;
      }
      const SourceSpan whole{&text, at, static_cast<std::uint32_t>(end - at), number};
      if (!includes || !include_line(whole)) pieces(whole);
      at = end + 1;
    }
  }

  void pieces(SourceSpan rest) {
    while (rest.length > max_line) {
      lines_.push_back({part_of(rest, 0, max_line)});
      rest = part_of(rest, max_line, rest.length - max_line);
      out_.warning("ini_line", rest,
                   "the line is longer than 255 bytes; the control reads the rest as a line of its "
                   "own. Break it with a '\\' at the end of the line");
    }
    lines_.push_back({rest});
  }

  bool include_line(const SourceSpan& line) {
    constexpr std::string_view word = "#INCLUDE";
    const std::string_view text = line.covered();
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    if (!text.substr(begin).starts_with(word)) return false;
    const std::size_t behind = begin + word.size();
    if (behind < text.size() && !is_blank(text[behind])) return false;
    std::size_t from = behind, to = text.size();
    while (from < to && is_blank(text[from])) ++from;
    while (to > from && is_blank(text[to - 1])) --to;
    const SourceSpan place = part_of(line, from, to - from);
    const std::string name(text.substr(from, to - from));
    if (name.empty()) {
      out_.error("ini_include", line, "#INCLUDE needs the name of a file");
      return true;
    }
    if (!include_) {
      out_.error("ini_include", place, "files can't be included here");
      return true;
    }
    const auto text_of_file = include_(name);
    if (!text_of_file) {
      Diagnostic d = text_of_file.error();
      if (d.kind != "path_refused") d.kind = "ini_include";
      d.span = place;
      out_.add(std::move(d));
      return true;
    }
    if (readable(**text_of_file)) split(**text_of_file, false);
    return true;
  }

  void begin_section(std::size_t start, std::size_t at) {
    const std::string_view line = lines_[start].text();
    const std::size_t close = line.find(']', at);
    if (close == std::string_view::npos) {
      out_.warning("ini_section", part_of(lines_[start].span, at, line.size() - at),
                   "the name of a section ends with ']'; the control finds nothing up to the next "
                   "section");
      return;
    }
    const std::string name(line.substr(at + 1, close - at - 1));
    const SourceSpan span = part_of(lines_[start].span, at, close + 1 - at);
    if (!names_.insert(name).second) {
      out_.warning("ini_section", span,
                   "there is a section [" + printable(name) +
                       "] before; the control looks at the first one only. Move these lines there");
      return;
    }
    sections_.push_back({name, span, {}});
    entries(start + 1, sections_.back());
  }

  /// The last line of a file that does not end with a line end goes on with nothing.
  bool at_open_end(std::size_t i) const {
    const SourceSpan& line = lines_[i].span;
    return i + 1 == lines_.size() && line.begin + line.length == line.text->content().size();
  }

  // Joined lines up to the next that begins with `[`.
  void entries(std::size_t i, Section& section) {
    while (i < lines_.size()) {
      const SourceSpan first = lines_[i].span;
      std::string joined(lines_[i].text());
      std::size_t extensions = 0;
      while (!joined.empty() && joined.back() == '\\' && !at_open_end(i)) {
        joined.pop_back();
        if (i + 1 == lines_.size()) return;  // the end of the file comes first
        if (++extensions > max_extensions) {
          out_.error("ini_line", first,
                     "the line goes on over more than 20 lines; the control stops reading here");
          return;
        }
        joined += lines_[++i].text();
      }
      ++i;
      if (!entry(joined, first, section)) return;
    }
  }

  bool entry(std::string_view line, const SourceSpan& first, Section& section) {
    const std::size_t at = first_of(line);
    if (at == std::string_view::npos) return true;
    if (line[at] == '[') return false;
    std::size_t key_end = at;
    while (key_end < line.size() && !ends_key(line[key_end])) ++key_end;
    const std::size_t equals = line.find('=', key_end);
    const SourceSpan place =
        part_of(first, at, std::min<std::size_t>(first.length, line.size()) - at);
    if (key_end == at || equals == std::string_view::npos) {
      out_.warning("ini_line", place,
                   "the control makes nothing of this line; write KEY = value, or # before a "
                   "comment");
      if (key_end == at || key_end == line.size()) return true;
    }
    Entry entry;
    entry.key = std::string(line.substr(at, key_end - at));
    entry.key_span = part_of(first, at, std::min<std::size_t>(key_end, first.length) - at);
    entry.span = entry.key_span;
    if (equals != std::string_view::npos) {
      std::size_t from = equals + 1, to = line.size();
      while (from < to && is_blank(line[from])) ++from;
      while (to > from && is_blank(line[to - 1])) --to;
      entry.value = std::string(line.substr(from, to - from));
      if (from < first.length && from < to)
        entry.span = part_of(first, from, std::min<std::size_t>(to, first.length) - from);
    }
    section.entries.push_back(std::move(entry));
    return true;
  }

  const SourceReader& include_;
  Diagnostics& out_;
  bool includes_ = false;
  std::vector<RawLine> lines_;
  std::set<std::string> names_;
  std::vector<Section> sections_;
};

}  // namespace

const Section* IniFile::section(std::string_view name) const {
  for (const Section& section : sections_)
    if (section.name == name) return &section;
  return nullptr;
}

const Entry* IniFile::find(std::string_view name, std::string_view key, int n) const {
  const Section* found = section(name);
  if (!found) return nullptr;
  for (const Entry& entry : found->entries)
    if (entry.key == key && --n == 0) return entry.value.empty() ? nullptr : &entry;
  return nullptr;
}

std::vector<const Entry*> IniFile::all(std::string_view section, std::string_view key) const {
  std::vector<const Entry*> found;
  while (const Entry* entry = find(section, key, static_cast<int>(found.size()) + 1))
    found.push_back(entry);
  return found;
}

IniFile read_ini(const SourceText& text, const SourceReader& include, Diagnostics& out) {
  return Reader(include, out).read(text);
}

std::optional<double> number_of(const std::string& text) {
  const std::size_t e = text.find_first_of("eE");
  const auto mantissa = parse_number(text.substr(0, e));
  if (!mantissa || e == std::string::npos) return mantissa;
  const auto power = parse_number(text.substr(e + 1));
  if (!power || *power != std::round(*power) || std::fabs(*power) > 300) return std::nullopt;
  return *mantissa * std::pow(10, *power);
}

const std::vector<KindText>& kinds() {
  static const std::vector<KindText> all = {
      {"ini_include", "an #INCLUDE of a set-up file that can't be followed",
       "The name is missing, or there is no such file next to the set-up file. Example: `#INCLUDE` "
       "alone."},
      {"ini_line", "a line of a set-up file that the control reads otherwise than it looks",
       "Write `KEY = value`, at most 255 bytes a line. Example: `SPINDLES 2` (no `=`)."},
      {"ini_section", "a section of a set-up file that the control does not see",
       "Only the first section of a name counts, and a name ends with `]`. Example: a second "
       "`[TRAJ]`."},
  };
  return all;
}

}  // namespace aircut::ini
