// What is said about an input: a stable kind, a place, what is wrong and what would be right.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/source.h"

namespace aircut {

enum class Severity { info, warning, error };

std::string_view to_string(Severity severity);

struct Note {
  std::string label;  ///< "help", "note", "joints", …: stands before the colon
  std::string text;
};

struct Diagnostic {
  Severity severity = Severity::error;
  std::string kind;     ///< stable word, e.g. `arc_error`; listed in the library's table of kinds
  std::string message;  ///< one sentence: what is wrong; then what would be right
  SourceSpan span = {};
  std::vector<Note> notes = {};
  std::string remark = {};  ///< stands after the underline
};

/// An error without a place in a text.
Diagnostic make_error(std::string kind, std::string message);
/// An error at a place.
Diagnostic make_error(std::string kind, const SourceSpan& span, std::string message);

class Diagnostics {
 public:
  void add(Diagnostic diagnostic);
  void error(std::string kind, const SourceSpan& span, std::string message);
  void warning(std::string kind, const SourceSpan& span, std::string message);

  const std::vector<Diagnostic>& list() const { return list_; }
  std::size_t errors() const { return errors_; }

 private:
  std::vector<Diagnostic> list_;
  std::size_t errors_ = 0;
};

/// A row of a library's table of kinds: `explain` and the documentation are made from it.
struct KindText {
  const char* kind;
  const char* title;  ///< one line
  const char* text;   ///< what it means, an example, the remedy
};

struct TextStyle {
  bool color = false;  ///< ANSI colours
};

/// The place as compilers show it: ` --> file:line:column`, the line before, the line, an
/// underline. `remark` stands after the underline. Control characters of the text are shown as
/// `^[`.
std::string excerpt(const SourceSpan& span, const std::string& remark, TextStyle style);

/// The whole message as people read it, ending with a line end: heading, excerpt, notes.
std::string format_human(const Diagnostic& diagnostic, TextStyle style);
/// `file:line:column: error: message [kind]`
std::string format_gcc(const Diagnostic& diagnostic);

}  // namespace aircut
