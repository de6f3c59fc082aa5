// Private: the files of web/, built into the program by assets.S.
#pragma once

#include <string_view>

namespace aircut::page {

std::string_view asset_page();    ///< page.html with marks where the rest goes in
std::string_view asset_style();   ///< page.css and the style of the charts
std::string_view asset_bundle();  ///< replay and charts; empty when npm was missing at build time
std::string_view asset_script();  ///< page.js

}  // namespace aircut::page
