#include "tools/report/report.h"

#include <string_view>
#include <vector>

#include "tools/report/display_unit.h"
#include "tools/report/fault_section.h"
#include "tools/report/fields_section.h"
#include "tools/report/headline.h"
#include "tools/report/html.h"
#include "tools/report/page.h"
#include "tools/report/plot_groups.h"
#include "tools/report/run_data.h"
#include "tools/run/column_unit.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string title(const RunData& data) {
  static const Json::json_pointer kKind("/experiment/kind");
  if (!data.settings.contains(kKind) || !data.settings[kKind].is_string()) return "Run";
  return capitalised(data.settings[kKind].get<std::string>()) + " test";
}

std::string headline_section(const RunData& data) {
  std::string html = "<section><h2>Headline</h2><table>";
  for (const HeadlineRow& row : headline(data)) {
    html += "<tr>" + element("th", row.label, " scope=\"row\"") +
            element("td", row.value, " class=\"number\"") +
            element("td", row.unit, " class=\"unit\"") + "</tr>\n";
  }
  return html + "</table></section>\n";
}

// "spine_pitch_over_d50" -> "spine pitch / d50"
std::string ratio_label(const std::string& key) {
  std::string label = key;
  const std::size_t over = label.find("_over_");
  if (over != std::string::npos) label.replace(over, 6, " / ");
  for (char& c : label) {
    if (c == '_') c = ' ';
  }
  return label;
}

std::string resolution_section(const RunData& data) {
  std::string html = "<section><h2>Resolution</h2>";
  const auto resolution = data.result.find("resolution");
  if (resolution == data.result.end()) {
    return html + "<p class=\"note\">This run states no resolution.</p></section>\n";
  }
  html += "<table>";
  for (const auto& item : resolution->items()) {
    if (item.value().is_array()) continue;
    const bool is_ratio = item.key().find("_over_") != std::string::npos;
    const HeadlineRow row = headline_row(
        is_ratio ? ratio_label(item.key()) : column_label(item.key()), item.key(), item.value());
    html += "<tr>" + element("th", row.label, " scope=\"row\"") +
            element("td", row.value, " class=\"number\"") +
            element("td", row.unit, " class=\"unit\"") + "</tr>\n";
  }
  html += "</table>";
  const auto refused = resolution->find("claims_refused");
  if (refused != resolution->end() && refused->is_array() && !refused->empty()) {
    html += "<div class=\"refused\"><strong>What this resolution cannot carry</strong><ul>";
    for (const Json& claim : *refused) {
      html += element("li", claim.is_string() ? claim.get<std::string>() : claim.dump());
    }
    html += "</ul></div>";
  }
  return html + "</section>\n";
}

std::string json_phases(const SampleTable& samples, const std::vector<double>& time_s) {
  std::string json = "[";
  const SampleColumn* phase = samples.find("phase_name");
  if (phase == nullptr) return json + "]";
  for (std::size_t i = 0; i < phase->texts.size(); ++i) {
    if (i > 0 && phase->texts[i] == phase->texts[i - 1]) continue;
    json += (i == 0 ? "" : ",") + Json{{"time_s", time_s[i]}, {"name", phase->texts[i]}}.dump();
  }
  return json + "]";
}

std::string json_samples(const RunData& data, const std::vector<PlotGroup>& groups) {
  const SampleTable& samples = data.samples;
  const std::vector<double>& time_s = samples.find("time_s")->numbers;
  std::string json = "{\"time_s\":" + json_numbers(time_s, 1.0) + ",\"plots\":[";
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const PlotGroup& group = groups[i];
    json += i == 0 ? "{" : ",\n{";
    const std::string axis =
        group.columns.size() == 1 ? column_label(group.columns[0]->name) : group.unit.quantity;
    json += "\"axis\":" + Json(axis).dump() + ",\"unit\":" + Json(group.unit.symbol).dump() +
            ",\"series\":[";
    for (std::size_t c = 0; c < group.columns.size(); ++c) {
      const SampleColumn& column = *group.columns[c];
      json += (c == 0 ? "" : ",\n") + ("{\"label\":" + Json(column_label(column.name)).dump()) +
              ",\"values\":" + json_numbers(column.numbers, group.unit.factor) + "}";
    }
    json += "]}";
  }
  return json + "],\"phases\":" + json_phases(samples, time_s) +
         ",\"marks\":" + json_fault_marks(data.result) + "}";
}

std::string plots_section(const std::vector<PlotGroup>& groups) {
  std::string html =
      "<h2>Signals against time</h2>\n<p class=\"note\">Drag to zoom, double-click to see all; "
      "click a name in the legend to hide its line. Dashed lines begin a phase; dotted ones are of "
      "faults put in.</p>\n"
      "<noscript>The plots need JavaScript.</noscript>\n<div class=\"plots\">\n";
  for (const PlotGroup& group : groups) {
    html += "<div class=\"plot\">" + element("h3", group.title) +
            "<div class=\"canvas\"></div></div>\n";
  }
  return html + "</div>\n";
}

void append_rows(std::string& html, const std::string& key, const Json& value) {
  if (value.is_object() && !value.empty()) {
    for (const auto& item : value.items()) {
      append_rows(html, key.empty() ? item.key() : key + "." + item.key(), item.value());
    }
    return;
  }
  html += "<tr>" + element("th", key, " scope=\"row\"") +
          element("td", value.is_string() ? value.get<std::string>() : value.dump()) + "</tr>\n";
}

std::string table_of(const Json& values) {
  std::string html = "<table class=\"keys\">";
  append_rows(html, "", values);
  return html + "</table>\n";
}

std::string drawing_section(const RunData& data) {
  if (data.section_svg.empty()) return "";
  return "<h2>The foot in the sand</h2>\n<p class=\"note\">At the end of the run, cut lengthwise; "
         "the robot walks to the right.</p>\n<figure>" +
         data.section_svg + "</figure>\n";
}

std::string files_section(const RunData& data) {
  std::string html = "<h2>Raw files of this run</h2>\n<table>";
  for (const RunFile& file : data.files) {
    const std::string name = html_escape(file.name);
    html += "<tr><td><a href=\"./" + name + "\">" + name + "</a></td>" +
            element("td", std::to_string(file.size_bytes), " class=\"number\"") +
            element("td", "bytes", " class=\"unit\"") + "</tr>\n";
  }
  return html + "</table>\n";
}

std::string results_sections(const RunData& data) {
  Json result = data.result;
  const auto version = result.find("version");
  const Json version_values = version == result.end() ? Json::object() : *version;
  result.erase("version");
  std::string html = "<h2>All results</h2>\n" + table_of(result) + files_section(data) +
                     "<h2>Settings</h2>\n" + element("pre", data.settings_text) + "\n";
  if (!version_values.empty()) html += "<h2>Version</h2>\n" + table_of(version_values);
  return html;
}

}  // namespace

std::string make_report(const std::filesystem::path& run_folder) {
  const RunData data = read_run_data(run_folder);
  const std::vector<PlotGroup> groups = group_plots(data.samples);
  const std::string body = "<div class=\"columns\">" + headline_section(data) +
                           resolution_section(data) + "</div>\n" + fault_section(data.result) +
                           drawing_section(data) + fields_section(data) + plots_section(groups) +
                           results_sections(data);
  return make_page(title(data), body, json_samples(data, groups));
}

std::filesystem::path write_report(const std::filesystem::path& run_folder) {
  const std::filesystem::path path = run_folder / "report.html";
  write_file(path, make_report(run_folder));
  return path;
}

}  // namespace hoof::tools
