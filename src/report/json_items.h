// The items of result.json and of its form with one item per line. Lengths mm, angles degrees, time
// s, feeds mm/min; keys carry the unit, or `unit` stands beside the number.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "report/report.h"

namespace aircut::report {

using Json = nlohmann::ordered_json;

Json first_items(const RunReport& report);    ///< schema, aircut
Json verdict_items(const RunReport& report);  ///< verdict, cause, interrupted
Json head_items(const RunReport& report);     ///< inputs, machine, checks, settings
Json unchecked_items(const RunReport& report);
/// Diagnostics, then findings; each as an object.
void each_finding(const RunReport& report, const std::function<void(Json)>& tell);
Json summary_item(const RunReport& report);
Json accepted_items(const RunReport& report);
Json tail_items(
    const RunReport& report);  ///< waivers, programs, timing, extents, collision, outputs

Json along_item(const AccuracyAlong& along);  ///< of `accuracy`

/// All of result.json.
Json document(const RunReport& report);

/// The text, ending with a line end. It is safe inside a page's <script> too: `<` is escaped.
/// `indent` -1: on one line.
std::string json_text(const Json& json, int indent);

}  // namespace aircut::report
