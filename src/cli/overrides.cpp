#include "cli/overrides.h"

#include <cmath>

#include "config/config.h"

namespace aircut::cli {
namespace {

constexpr const char* kind = "overrides_invalid";

// Every key of one [[event]] but its time.
void read_event(config::Table& table, double t, std::vector<plan::OverrideEvent>& out) {
  using What = plan::OverrideEvent::What;
  const auto factor = [&](const char* key, What what, double most) {
    const auto percent = table.number(key);
    if (!percent) return;
    if (!(*percent >= 0) || *percent > most || (what == What::spindle && *percent == 0))
      return table.error(key, std::string("'") + key + "' is in percent, " +
                                  (what == What::spindle ? "above 0" : "from 0") + " to " +
                                  shortest(most));
    out.push_back({t, what, *percent / 100});
  };
  factor("feed", What::feed, 1000);
  factor("rapid", What::rapid, 100);
  factor("spindle", What::spindle, 1000);
  factor("adaptive", What::adaptive, 100);
  if (const auto hold = table.boolean("hold"))
    out.push_back({t, *hold ? What::hold : What::resume, 1});
}

}  // namespace

tl::expected<std::vector<plan::OverrideEvent>, Diagnostics> read_overrides(
    Job& job, const std::string& path) {
  Diagnostics problems;
  const auto text = job.sources.open(path);
  if (!text) {
    problems.add(text.error());
    return tl::unexpected(std::move(problems));
  }
  job.inputs.push_back({"overrides", path, sha256(**text)});
  config::Reader reader(**text, kind);
  config::Table top = reader.top();
  std::vector<plan::OverrideEvent> out;
  double last = 0;
  for (config::Table& table : top.tables("event")) {
    const double t = table.required_number("t");
    const std::size_t before = out.size();
    if (!(t >= last))
      table.error("t",
                  "'t' is in seconds from the program's start, 0 or more, and never less than "
                  "that of the event before");
    last = std::max(last, t);
    read_event(table, t, out);
    if (out.size() == before && !table.has("feed") && !table.has("rapid") &&
        !table.has("spindle") && !table.has("adaptive"))
      table.error("t", "the event needs at least one of feed, rapid, spindle, adaptive and hold");
  }
  problems = reader.finish();
  if (problems.errors() == 0)
    if (const std::string wrong = plan::wrong_overrides(out); !wrong.empty())
      problems.error(kind, top.span(), wrong);
  if (problems.errors() > 0) return tl::unexpected(std::move(problems));
  return out;
}

}  // namespace aircut::cli
