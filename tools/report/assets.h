#pragma once

#include <string_view>

// The parts of report.html that stand in files of their own; tools/report/embed_assets.cmake
// turns those into the source that defines these, named after the files.
namespace hoof::tools::assets {

extern const std::string_view page_css;
extern const std::string_view page_js;
extern const std::string_view save_js;
extern const std::string_view three_bundle_min_js;
extern const std::string_view view_js;
extern const std::string_view uPlot_iife_min_js;
extern const std::string_view uPlot_min_css;

}  // namespace hoof::tools::assets
