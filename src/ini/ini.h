// ini: set-up files as LinuxCNC reads them. What its own reader does with odd lines is the
// contract:
//
//   [SECTION] anything      the first section of a name counts, later ones are never looked at
//   KEY = value             the key ends at a blank or `=`, the value starts behind the first `=`
//   # ; at the line's start comment; behind a value they belong to the value
//   value … \               goes on with the next line, up to 20 times
//   #INCLUDE file           the file's lines stand in its place; included files include nothing
//   longer than 255 bytes   what is beyond counts as a line of its own
//
// Names keep their case. A key may stand several times; a reader asks for the n-th.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/base.h"

namespace aircut::ini {

struct Entry {
  std::string key;
  std::string value;  ///< without blanks around it; empty: the control takes it as absent
  SourceSpan key_span;
  SourceSpan span;  ///< of the value, of its first line when it is continued
};

struct Section {
  std::string name;
  SourceSpan span;
  std::vector<Entry> entries;
};

class IniFile {
 public:
  explicit IniFile(std::vector<Section> sections) : sections_(std::move(sections)) {}

  /// The sections that count, each name once, in the order of the file.
  const std::vector<Section>& sections() const { return sections_; }
  const Section* section(std::string_view name) const;
  /// The `n`-th entry of that key, from 1; null when it is missing or empty.
  const Entry* find(std::string_view section, std::string_view key, int n = 1) const;
  /// All of them up to the first that is empty, as a control that counts upwards finds them.
  std::vector<const Entry*> all(std::string_view section, std::string_view key) const;

 private:
  std::vector<Section> sections_;
};

/// Reads a set-up file. `include` opens the files of `#INCLUDE` by the name as written; kinds
/// `ini_line`, `ini_section` (warnings: lines that the control does not read as they look) and
/// `ini_include`, `encoding` (errors).
IniFile read_ini(const SourceText& text, const SourceReader& include, Diagnostics& out);

/// A number as the control takes it: an exponent is allowed, nothing behind it is.
std::optional<double> number_of(const std::string& text);

/// Kinds of messages of this library, for `explain` and the docs.
const std::vector<KindText>& kinds();

}  // namespace aircut::ini
