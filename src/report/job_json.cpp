#include "report/job_json.h"

#include <algorithm>

#include "report/json_items.h"

namespace aircut::report {

sim::Verdict verdict_of(const std::vector<JobOperation>& operations) {
  const auto any = [&](sim::Verdict verdict) {
    return std::any_of(operations.begin(), operations.end(),
                       [&](const JobOperation& o) { return o.verdict == verdict; });
  };
  if (any(sim::Verdict::fail)) return sim::Verdict::fail;
  return operations.empty() || any(sim::Verdict::unknown) ? sim::Verdict::unknown
                                                          : sim::Verdict::pass;
}

std::string to_json(const std::vector<JobOperation>& operations) {
  Json rows = Json::array();
  double cycle_time = 0;
  for (const JobOperation& o : operations) {
    cycle_time += o.cycle_time;
    Json row = {{"name", o.name},
                {"program", o.program},
                {"verdict", sim::to_string(o.verdict)},
                {"run", o.run},
                {"cycle_time_s", o.cycle_time}};
    if (!o.folder.empty()) row["folder"] = o.folder;
    if (!o.reason.empty()) row["reason"] = o.reason;
    rows.push_back(std::move(row));
  }
  const Json all = {{"schema", 1},
                    {"verdict", sim::to_string(verdict_of(operations))},
                    {"cycle_time_s", cycle_time},
                    {"operations", std::move(rows)}};
  return json_text(all, 2);
}

}  // namespace aircut::report
