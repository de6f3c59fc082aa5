// The items of result.json, one per line, told apart by `item`: head, unchecked, finding, summary.

#include "report/json_items.h"

namespace aircut::report {

std::string to_jsonl(const RunReport& report) {
  std::string out;
  const auto line = [&](const char* item, const Json& content) {
    Json row = {{"item", item}};
    row.update(content);
    out += json_text(row, -1);
  };
  Json head = first_items(report);
  head.update(head_items(report));
  line("head", head);
  for (const Json& what : unchecked_items(report)) line("unchecked", {{"text", what}});
  each_finding(report, [&](const Json& row) { line("finding", row); });
  Json summary = verdict_items(report);
  summary.update(summary_item(report));
  summary.update(tail_items(report));
  line("summary", summary);
  return out;
}

}  // namespace aircut::report
