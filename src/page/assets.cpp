#include "page/assets.h"

extern "C" {
extern const char aircut_page_html[], aircut_page_html_end[];
extern const char aircut_page_style[], aircut_page_style_end[];
extern const char aircut_page_bundle[], aircut_page_bundle_end[];
extern const char aircut_page_script[], aircut_page_script_end[];
}

namespace aircut::page {

std::string_view asset_page() { return {aircut_page_html, aircut_page_html_end}; }
std::string_view asset_style() { return {aircut_page_style, aircut_page_style_end}; }
std::string_view asset_bundle() { return {aircut_page_bundle, aircut_page_bundle_end}; }
std::string_view asset_script() { return {aircut_page_script, aircut_page_script_end}; }

}  // namespace aircut::page
