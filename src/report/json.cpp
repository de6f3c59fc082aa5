// result.json, schema 1.

#include "report/json_items.h"

namespace aircut::report {

Json document(const RunReport& report) {
  Json findings = Json::array();
  each_finding(report, [&](Json row) { findings.push_back(std::move(row)); });

  Json out = first_items(report);
  out.update(verdict_items(report));
  out.update(head_items(report));
  out["summary"] = summary_item(report);
  out["unchecked"] = unchecked_items(report);
  out["findings"] = std::move(findings);
  out["accepted"] = accepted_items(report);
  out.update(tail_items(report));
  return out;
}

std::string to_json(const RunReport& report) { return json_text(document(report), 2); }

}  // namespace aircut::report
