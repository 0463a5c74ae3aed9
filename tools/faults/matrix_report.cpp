#include "tools/faults/matrix_report.h"

#include <algorithm>
#include <cstdio>
#include <functional>

#include "hil_bridge/reaction.h"
#include "tools/report/html.h"

namespace hoof::tools {
namespace {

using firmware::control::Mode;

std::string milliseconds(const std::optional<double>& time_s) {
  if (!time_s) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", *time_s * 1e3);
  return text;
}

std::string mode_of(const MatrixCell& cell) {
  return bridge::mode_name(int(cell.mode));
}

std::string bits_of(const MatrixCell& cell) {
  if (cell.faults != 0) return bridge::fault_bit_names(cell.faults);
  if (!cell.gaps.empty()) return "not found";
  return cell.changed == 0 ? "no effect" : "harmless";
}

std::string recovery_of(const MatrixCell& cell) {
  if (cell.moves) return "yes";
  return cell.reset ? "reset only" : "-";
}

std::string short_text(const MatrixCell& cell) {
  std::string text = bits_of(cell);
  if (cell.trip_s) text += " after " + milliseconds(cell.trip_s) + " ms";
  if (cell.safe_s) text += ", safe " + milliseconds(cell.safe_s) + " ms";
  if (cell.surge_s > 0) text += ", surge " + milliseconds(cell.surge_s) + " ms";
  if (cell.moves) text += ", reset";
  return text;
}

std::vector<std::string> in_order(const std::vector<MatrixCell>& cells,
                                  const std::function<std::string(const MatrixCell&)>& key) {
  std::vector<std::string> keys;
  for (const MatrixCell& cell : cells) {
    if (std::find(keys.begin(), keys.end(), key(cell)) == keys.end()) keys.push_back(key(cell));
  }
  return keys;
}

const MatrixCell* find(const std::vector<MatrixCell>& cells, const std::string& fault,
                       const std::string& mode) {
  for (const MatrixCell& cell : cells) {
    if (cell.fault == fault && mode_of(cell) == mode) return &cell;
  }
  return nullptr;
}

std::size_t missed(const std::vector<MatrixCell>& cells) {
  return std::size_t(std::count_if(cells.begin(), cells.end(),
                                   [](const MatrixCell& c) { return !c.misses.empty(); }));
}

std::size_t gaps(const std::vector<MatrixCell>& cells) {
  return std::size_t(std::count_if(cells.begin(), cells.end(),
                                   [](const MatrixCell& c) { return !c.gaps.empty(); }));
}

std::string fault_name(const MatrixCell& cell) {
  return cell.fault;
}

}  // namespace

std::string cell_line(const MatrixCell& cell) {
  char text[256];
  std::snprintf(text, sizeof text, "%-13s  %-35s  %5s  %5s  %5s  %-10s  %s", mode_of(cell).c_str(),
                cell.fault.c_str(), milliseconds(cell.trip_s).c_str(),
                milliseconds(cell.safe_s).c_str(), milliseconds(cell.surge_s).c_str(),
                recovery_of(cell).c_str(), bits_of(cell).c_str());
  std::string line = text;
  if (!cell.gaps.empty()) line += "   KNOWN GAP: " + cell.gaps;
  if (!cell.misses.empty()) line += "   MISSED: " + cell.misses;
  return line;
}

std::string matrix_junit(const std::vector<MatrixCell>& cells) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"faults\" tests=\"" +
      std::to_string(cells.size()) + "\" failures=\"" + std::to_string(missed(cells)) + "\">\n";
  for (const std::string& mode : in_order(cells, mode_of)) {
    std::string body;
    std::size_t tests = 0, failures = 0, skipped = 0;
    for (const MatrixCell& cell : cells) {
      if (mode_of(cell) != mode) continue;
      ++tests;
      body += "    <testcase classname=\"faults." + mode + "\" name=\"" + html_escape(cell.fault) +
              "\" time=\"0\">";
      if (!cell.misses.empty()) {
        ++failures;
        body += "<failure type=\"reaction\" message=\"" + html_escape(cell.misses) + "\"/>";
      }
      if (!cell.gaps.empty()) {
        ++skipped;
        body += "<skipped message=\"known gap: " + html_escape(cell.gaps) + "\"/>";
      }
      body += "<system-out>" + html_escape(cell_line(cell)) + "</system-out></testcase>\n";
    }
    xml += "  <testsuite name=\"" + mode + "\" tests=\"" + std::to_string(tests) +
           "\" failures=\"" + std::to_string(failures) + "\" skipped=\"" + std::to_string(skipped) +
           "\">\n" + body + "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

namespace {

constexpr const char* kHtmlHead =
    "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
    "<meta name=\"color-scheme\" content=\"light\">"
    "<link rel=\"icon\" href=\"data:,\"><title>hoof: faults in every mode</title>\n<style>"
    "body{font:14px/1.4 system-ui,\"DejaVu Sans\",sans-serif;margin:1.5rem;color:#1b1f24}"
    "table{border-collapse:collapse}th,td{border:1px solid #d3d9df;padding:.25rem .5rem;"
    "text-align:left;vertical-align:top;font-size:.85rem}thead th{position:sticky;top:0;"
    "background:#f5f7f9}tbody th{font-weight:500;min-width:13rem}"
    "td b{font-weight:600}td small{color:#59636e;display:block}"
    ".stopped{background:#eef3ff}.missed{background:#c33;color:#fff}.missed small{color:#fff}"
    "p{max-width:60rem}</style></head><body>\n";

std::string html_cell(const MatrixCell* cell) {
  if (cell == nullptr) return "<td></td>";
  const char* kind = !cell->misses.empty() ? " class=\"missed\""
                     : !cell->gaps.empty() ? " class=\"gap\""
                     : cell->faults != 0   ? " class=\"stopped\""
                                           : "";
  std::string html = "<td" + std::string(kind) + "><b>" + html_escape(bits_of(*cell)) + "</b>";
  std::string times;
  const auto add = [&times](const std::string& text) {
    times += (times.empty() ? "" : ", ") + text;
  };
  if (cell->trip_s) add("told after " + milliseconds(cell->trip_s) + " ms");
  if (cell->safe_s) add("safe after " + milliseconds(cell->safe_s) + " ms");
  if (cell->surge_s > 0) add("surge " + milliseconds(cell->surge_s) + " ms");
  if (cell->moves) add("reset");
  if (!times.empty()) html += "<small>" + html_escape(times) + "</small>";
  if (!cell->misses.empty()) html += "<small>Missed: " + html_escape(cell->misses) + "</small>";
  if (!cell->gaps.empty()) html += "<small>Known gap: " + html_escape(cell->gaps) + "</small>";
  return html + "</td>";
}

std::string why_of(const std::vector<MatrixCell>& cells, const std::string& fault) {
  for (const MatrixCell& cell : cells) {
    if (cell.fault == fault) return cell.why;
  }
  return "";
}

}  // namespace

std::string matrix_html(const std::vector<MatrixCell>& cells) {
  std::string html = kHtmlHead;
  html += "<h1>Faults in every mode</h1>\n<p>" + std::to_string(cells.size()) + " cells, <b>" +
          std::to_string(missed(cells)) + " missed</b>, " + std::to_string(gaps(cells)) +
          " known gaps. Times are simulated, from the begin of the fault. Told: the firmware has "
          "latched its first fault bit. Safe: from then on every drive was off or only braked. "
          "Surge: a drive pushed along its motion by a quarter of its ceiling more than it ever "
          "does without the fault. Reset: the order led to mode off without a fault, and the foot "
          "moved again. Harmless: no fault bit, and the foot went on.</p>\n"
          "<table><thead><tr><th>fault</th>";
  const std::vector<std::string> modes = in_order(cells, mode_of);
  for (const std::string& mode : modes) html += "<th>" + mode + "</th>";
  html += "</tr></thead>\n<tbody>\n";
  for (const std::string& fault : in_order(cells, fault_name)) {
    html += "<tr><th>" + html_escape(fault);
    const std::string why = why_of(cells, fault);
    if (!why.empty()) html += "<br><small>" + html_escape(why) + "</small>";
    html += "</th>";
    for (const std::string& mode : modes) html += html_cell(find(cells, fault, mode));
    html += "</tr>\n";
  }
  return html + "</tbody></table></body></html>\n";
}

std::string matrix_markdown(const std::vector<MatrixCell>& cells) {
  const std::vector<std::string> modes = in_order(cells, mode_of);
  std::string text = "| fault |", rule = "| --- |";
  for (const std::string& mode : modes) text += " " + mode + " |", rule += " --- |";
  text += "\n" + rule + "\n";
  for (const std::string& fault : in_order(cells, fault_name)) {
    text += "| " + fault + " |";
    for (const std::string& mode : modes) {
      const MatrixCell* cell = find(cells, fault, mode);
      text +=
          " " + (cell == nullptr ? "" : short_text(*cell)) +
          (cell != nullptr && !cell->misses.empty() ? " **MISSED: " + cell->misses + "**" : "") +
          " |";
    }
    text += "\n";
  }
  return text;
}

}  // namespace hoof::tools
