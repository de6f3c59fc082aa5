#include "base/diagnostic.h"

#include <algorithm>

#include "base/text.h"

namespace aircut {

std::string_view to_string(Severity severity) {
  switch (severity) {
    case Severity::info:
      return "info";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "error";
}

Diagnostic make_error(std::string kind, std::string message) {
  return {Severity::error, std::move(kind), std::move(message)};
}

Diagnostic make_error(std::string kind, const SourceSpan& span, std::string message) {
  return {Severity::error, std::move(kind), std::move(message), span};
}

void Diagnostics::add(Diagnostic diagnostic) {
  if (diagnostic.severity == Severity::error) ++errors_;
  list_.push_back(std::move(diagnostic));
}

void Diagnostics::error(std::string kind, const SourceSpan& span, std::string message) {
  add({Severity::error, std::move(kind), std::move(message), span});
}

void Diagnostics::warning(std::string kind, const SourceSpan& span, std::string message) {
  add({Severity::warning, std::move(kind), std::move(message), span});
}

namespace {

const char* paint(TextStyle style, const char* code) { return style.color ? code : ""; }

const char* severity_paint(Severity severity, TextStyle style) {
  switch (severity) {
    case Severity::info:
      return paint(style, "\x1b[1;36m");
    case Severity::warning:
      return paint(style, "\x1b[1;33m");
    case Severity::error:
      return paint(style, "\x1b[1;31m");
  }
  return "";
}

// A window of a long line around a place, so that one message stays on a screen.
struct Window {
  std::string text;
  std::size_t before = 0;  // characters of `text` in front of the place
};

constexpr std::size_t widest = 160;

Window cut_around(std::string_view line, std::size_t at) {
  if (line.size() <= widest)
    return {printable(line), count_characters(printable(line.substr(0, at)))};
  const std::size_t first = at > widest / 3 ? at - widest / 3 : 0;
  const std::string head = first > 0 ? "…" : "";
  const std::string tail = first + widest < line.size() ? "…" : "";
  return {head + printable(line.substr(first, widest)) + tail,
          count_characters(head + printable(line.substr(first, at - first)))};
}

std::string_view line_before(const SourceSpan& span) {
  const std::string_view line = span.line_text();
  std::size_t start = static_cast<std::size_t>(line.data() - span.text->content().data());
  if (start == 0) return {};
  --start;
  if (start > 0 && span.text->content()[start] == '\n' && span.text->content()[start - 1] == '\r')
    --start;
  return SourceSpan{.text = span.text, .begin = start}.line_text();
}

}  // namespace

std::string excerpt(const SourceSpan& span, const std::string& remark, TextStyle style) {
  if (!span) return {};
  const std::string number = std::to_string(span.line);
  const std::string margin(number.size(), ' ');
  const char* blue = paint(style, "\x1b[1;34m");
  const char* off = paint(style, "\x1b[0m");

  std::string out = margin + blue + "--> " + off + span.place();
  if (span.calls) {
    out += "   (called from ";
    std::size_t depth = 0;
    constexpr std::size_t deepest_shown = 8;
    for (const CallFrame* frame = span.calls.get(); frame; frame = frame->site.calls.get()) {
      if (depth > 0) out += ", ";
      if (depth++ == deepest_shown) {
        out += "…";
        break;
      }
      out += printable(frame->site.text ? frame->site.text->name() : "?") + ":" +
             std::to_string(frame->site.line) + ", " + printable(frame->text());
    }
    out += ")";
  }
  out += "\n" + margin + blue + " |" + off + "\n";

  const auto row = [&](const std::string& label, const std::string& text) {
    out += blue + label + " |" + off + (text.empty() ? "" : " ") + text + "\n";
  };
  if (span.line > 1) {
    const std::string previous = std::to_string(span.line - 1);
    row(std::string(number.size() - previous.size(), ' ') + previous,
        cut_around(line_before(span), 0).text);
  }
  const std::string_view line = span.line_text();
  const std::size_t start = static_cast<std::size_t>(line.data() - span.text->content().data());
  const std::size_t at = std::min<std::size_t>(span.begin - start, line.size());
  const Window window = cut_around(line, at);
  row(number, window.text);
  std::size_t width = count_characters(printable(line.substr(at, span.length)));
  width = std::clamp<std::size_t>(width, 1, widest);
  row(margin, std::string(window.before, ' ') + severity_paint(Severity::error, style) +
                  std::string(width, '^') + (remark.empty() ? "" : " " + remark) + off);
  return out;
}

std::string format_human(const Diagnostic& d, TextStyle style) {
  const char* off = paint(style, "\x1b[0m");
  std::string out = std::string(severity_paint(d.severity, style)) +
                    std::string(to_string(d.severity)) + "[" + d.kind + "]" + off +
                    paint(style, "\x1b[1m") + ": " + printable(d.message) + off + "\n";
  out += excerpt(d.span, d.remark, style);
  const std::string margin(d.span ? std::to_string(d.span.line).size() : 1, ' ');
  for (const Note& note : d.notes)
    out += margin + " = " + note.label + ": " + printable(note.text) + "\n";
  return out;
}

std::string format_gcc(const Diagnostic& d) {
  std::string out = d.span ? d.span.place() : std::string("aircut");
  return out + ": " + std::string(to_string(d.severity)) + ": " + printable(d.message) + " [" +
         d.kind + "]";
}

}  // namespace aircut
