// One line per message: as compilers write them, and as GitHub's workflow commands.

#include "report/messages.h"

namespace aircut::report {

std::string to_gcc(const RunReport& report) {
  std::string out;
  for (const std::string& what : unchecked_besides_findings(report))
    out += "aircut: warning: not checked: " + printable(what) + " [not_checked]\n";
  for (const Message& message : messages(report, Take::rows)) {
    const Diagnostic& d = message.text;
    if (d.span || message.program.empty())
      out += harmless(format_gcc(d)) + "\n";
    else
      out += printable(message.program) + ": " + std::string(to_string(d.severity)) + ": " +
             printable(d.message) + " [" + d.kind + "]\n";
  }
  return out;
}

namespace {

// Workflow commands: `%`, CR and LF are escaped; in properties also `:` and `,`. Control characters
// are shown, not sent: a line end in a text must not begin a command of its own.
std::string data(std::string_view text, bool property) {
  constexpr const char* digits = "0123456789ABCDEF";
  std::string out;
  for (const char c : printable(text)) {
    if (c == '%' || (property && (c == ':' || c == ','))) {
      const auto byte = static_cast<unsigned char>(c);
      out += {'%', digits[byte >> 4], digits[byte & 15]};
    } else {
      out += c;
    }
  }
  return out;
}

const char* command(Severity severity) {
  switch (severity) {
    case Severity::error:
      return "::error ";
    case Severity::warning:
      return "::warning ";
    case Severity::info:
      return "::notice ";
  }
  return "::error ";
}

}  // namespace

std::string to_github(const RunReport& report) {
  std::string out;
  for (const std::string& what : unchecked_besides_findings(report))
    out += "::warning title=not_checked::not checked: " + data(what, false) + "\n";
  for (const Message& message : messages(report, Take::rows)) {
    const Diagnostic& d = message.text;
    out += command(d.severity);
    if (d.span)
      out += "file=" + data(d.span.text->name(), true) + ",line=" + std::to_string(d.span.line) +
             ",col=" + std::to_string(d.span.column()) + ",";
    else if (!message.program.empty())
      out += "file=" + data(message.program, true) + ",";
    out += "title=" + data(d.kind, true) + "::" + data(d.message, false) + "\n";
  }
  return out;
}

}  // namespace aircut::report
