#include "report/messages.h"

#include <algorithm>
#include <map>
#include <set>

namespace aircut::report {

namespace {

std::string only_program(const RunReport& report) {
  std::string out;
  for (const Input& input : report.inputs)
    if (input.role == "program")
      out = report.channels.empty() || out.empty() ? input.path : out + " + " + input.path;
  return out;
}

// The program of each diagnostic, by index.
std::vector<std::string> owners(const RunReport& report) {
  std::vector<std::string> out(report.diagnostics.size(),
                               report.units.empty() ? only_program(report) : "");
  for (const Unit& unit : report.units)
    for (std::size_t i = unit.first; i < unit.first + unit.count && i < out.size(); ++i)
      out[i] = unit.program;
  return out;
}

struct Episode {
  std::size_t message = 0;  ///< where its message is in the list
  std::size_t rows = 0, blocks = 0;
  const sim::Finding* last = nullptr;
};

// The rest of an episode in words: it is one message, but lasts over several blocks.
void tell_rest(Diagnostic& d, const Episode& episode) {
  if (episode.blocks < 2) return;
  const std::size_t more = episode.blocks - 1;
  std::string text = "goes on in " + std::to_string(more) + " more block" + (more == 1 ? "" : "s");
  if (episode.last->span) text += ", up to line " + std::to_string(episode.last->span.line);
  d.notes.insert(d.notes.begin(),
                 {"lasts", text + ", t = " + fixed(episode.last->t_end, 3) + " s"});
}

}  // namespace

std::vector<Message> messages(const RunReport& report, Take take) {
  std::vector<Message> out;
  const std::vector<std::string> owner = owners(report);
  for (std::size_t i = 0; i < report.diagnostics.size(); ++i) {
    const Diagnostic& d = report.diagnostics[i];
    out.push_back({d, owner[i], nullptr, d.severity == Severity::error});
  }
  const std::string program = only_program(report);
  std::map<int, Episode> episodes;
  for (const sim::Finding& f : report.findings) {
    Episode& episode = episodes[f.episode];
    ++episode.rows;
    if (episode.last == nullptr || episode.last->block != f.block) ++episode.blocks;
    episode.last = &f;
    const bool open = f.makes_unknown || f.unresolved;
    if (take == Take::rows || episode.rows == 1) {
      episode.message = out.size();
      out.push_back({to_diagnostic(f, report), program, &f, open});
    }
    out[episode.message].makes_unknown = out[episode.message].makes_unknown || open;
  }
  if (take == Take::episodes)
    for (const auto& [number, episode] : episodes) tell_rest(out[episode.message].text, episode);
  return out;
}

bool fails(const Message& message, const RunReport& report) {
  return report.fail_on && message.text.severity >= *report.fail_on;
}

std::string cause_of(const RunReport& report) {
  if (report.summary.interrupted) return "interrupted";
  switch (report.summary.verdict) {
    case sim::Verdict::pass:
      return "ok";
    case sim::Verdict::fail:
      return "findings";
    case sim::Verdict::unknown:
      break;
  }
  return report.unknown_cause.empty() ? "unchecked" : report.unknown_cause;
}

std::vector<std::string> unchecked_besides_findings(const RunReport& report) {
  std::vector<std::string> out = report.summary.unchecked;
  const auto told = [](const std::string& what) {
    return what.find("interrupted") != std::string::npos;
  };
  if (report.summary.interrupted && std::none_of(out.begin(), out.end(), told))
    out.push_back("the run was interrupted; the rest was not checked");
  if (report.summary.findings_dropped > 0)
    out.push_back(std::to_string(report.summary.findings_dropped) + " more finding" +
                  (report.summary.findings_dropped == 1 ? " was" : "s were") +
                  " counted but not kept");
  return out;
}

std::vector<std::string> unchecked(const RunReport& report) {
  std::vector<std::string> out = unchecked_besides_findings(report);
  std::set<int> told;
  for (const sim::Finding& f : report.findings) {
    if (!f.makes_unknown && !f.unresolved) continue;
    if (!told.insert(f.episode).second) continue;
    out.push_back(
        (f.span ? f.span.text->name() + ":" + std::to_string(f.span.line) + ": " : std::string()) +
        f.message);
  }
  return out;
}

std::vector<Unit> units_of(const RunReport& report) {
  if (!report.units.empty()) return report.units;
  Unit unit;
  unit.program = only_program(report);
  unit.verdict = report.summary.verdict;
  unit.blocks = report.summary.blocks;
  unit.moves = report.summary.moves;
  unit.unchecked = unchecked(report);
  unit.count = report.diagnostics.size();
  return {unit};
}

}  // namespace aircut::report
