// page: report.html, one file that opens from disk without a network: verdict, what was not
// checked, findings, tables, and a replay of the run in 3D.
//
// The page is web/page.html with its style and scripts; the run goes in as JSON and as one packed
// blob (pack.h). Its policy forbids to load anything. Text of inputs is data to the scripts, never
// markup.
#pragma once

#include <span>
#include <string>

#include "page/tracks.h"
#include "report/report.h"

namespace aircut::page {

/// How fine the stock of the replay is: cells along its longest side.
inline constexpr double stock_steps = 130;

struct PageInput {
  const report::RunReport& report;
  const Replay& replay;
  std::string folder;  ///< where the report's pictures are (sheet.png, frames/…)
  std::span<const StockStage> stock = {};  ///< none: the stock stays as it was
};

/// The whole page.
std::string page_html(const PageInput& input);

}  // namespace aircut::page
