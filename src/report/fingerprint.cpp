// A fingerprint must survive lines that are put in above a message and renumbered blocks, so it is
// a hash of what the message is about and not of where it stands: kind, file, the block without its
// N word, the word underlined, the bodies or the joint. Programs repeat themselves, so it is a
// count of equal ones that matters, not one alone.

#include "report/accept.h"
#include "report/paths.h"

namespace aircut::report {

namespace {

// The block's text without blanks and N word.
std::string block_text(const SourceSpan& span) {
  std::string out;
  for (const char c : span.line_text())
    if (c != ' ' && c != '\t') out += c;
  if (!out.empty() && (out[0] == 'N' || out[0] == 'n'))
    out.erase(0, std::min(out.find_first_not_of("0123456789.", 1), out.size()));
  return out;
}

}  // namespace

std::string fingerprint_of(const Diagnostic& message, const std::string& program,
                           const sim::Finding* finding, const std::string& folder) {
  const SourceSpan& span = message.span;
  std::string about = message.kind + '\0';
  about += uri_of(span ? span.text->name() : program, folder) + '\0';
  if (span) about += block_text(span) + '\0' + std::string(span.covered()) + '\0';
  if (finding) about += finding->body_a + '\0' + finding->body_b + '\0' + finding->joint + '\0';
  return sha256(about).substr(0, 32);
}

}  // namespace aircut::report
