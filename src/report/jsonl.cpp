// The items of result.json, one per line, told apart by `item`: head, input, unchecked, finding,
// accepted, summary.

#include "report/json_items.h"

namespace aircut::report {

namespace {

std::string line(const char* item, const Json& content) {
  Json row = {{"item", item}};
  row.update(content);
  return json_text(row, -1);
}

}  // namespace

std::string jsonl_head(const RunReport& report) {
  Json head = first_items(report);
  head.update(head_items(report));
  return line("head", head);
}

std::string jsonl_messages(const RunReport& report, bool with_inputs) {
  std::string out;
  const Json head = head_items(report);
  if (with_inputs)
    for (const Json& input : head["inputs"]) out += line("input", input);
  for (const Json& what : unchecked_items(report)) out += line("unchecked", {{"text", what}});
  each_finding(report, [&](const Json& row) { out += line("finding", row); });
  for (const Json& row : accepted_items(report)) out += line("accepted", row);
  return out;
}

std::string jsonl_summary(const RunReport& report) {
  Json summary = verdict_items(report);
  summary.update(summary_item(report));
  summary.update(tail_items(report));
  return line("summary", summary);
}

std::string to_jsonl(const RunReport& report) {
  return jsonl_head(report) + jsonl_messages(report, false) + jsonl_summary(report);
}

}  // namespace aircut::report
