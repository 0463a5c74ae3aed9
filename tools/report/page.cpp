#include "tools/report/page.h"

#include <cmath>

#include "tools/report/assets.h"
#include "tools/report/display_unit.h"
#include "tools/report/html.h"

namespace hoof::tools {
namespace {

constexpr int kPlotDigits = 6;  // a plot of 2,000 pixels shows four; two more for zooming

std::string script(std::string_view text, std::string_view attributes = "") {
  return "<script" + std::string(attributes) + ">" + std::string(text) + "</script>\n";
}

}  // namespace

std::string make_page(const std::string& title, const std::string& body,
                      std::string_view samples_json) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      // An icon of no bytes keeps browsers from asking for favicon.ico.
      "<link rel=\"icon\" href=\"data:,\">\n";
  html += element("title", "hoof: " + title) + "\n<style>\n";
  html += assets::uPlot_min_css;
  html += assets::page_css;
  html += "</style>\n</head>\n<body>\n" + element("h1", title) + "\n" + body;
  html += script(json_for_script(samples_json), " type=\"application/json\" id=\"samples\"");
  html += script(assets::uPlot_iife_min_js) + script(assets::page_js) + script(assets::save_js);
  return html + "</body>\n</html>\n";
}

std::string json_numbers(const std::vector<double>& values, double factor) {
  std::string json = "[";
  for (const double value : values) {
    if (json.size() > 1) json += ',';
    json += std::isfinite(value) ? format_significant(factor * value, kPlotDigits) : "null";
  }
  return json + "]";
}

}  // namespace hoof::tools
