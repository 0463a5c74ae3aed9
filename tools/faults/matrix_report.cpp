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
  return cell.faults == 0 ? "harmless" : bridge::fault_bit_names(cell.faults);
}

std::string recovery_of(const MatrixCell& cell) {
  if (cell.moves) return "yes";
  return cell.reset ? "reset only" : "-";
}

std::string short_text(const MatrixCell& cell) {
  std::string text = bits_of(cell);
  if (cell.safe_s) text += ", safe " + milliseconds(cell.safe_s) + " ms";
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

std::string fault_name(const MatrixCell& cell) {
  return cell.fault;
}

}  // namespace

std::string cell_line(const MatrixCell& cell) {
  char text[256];
  std::snprintf(text, sizeof text, "%-13s  %-35s  %5s  %5s  %-10s  %s", mode_of(cell).c_str(),
                cell.fault.c_str(), milliseconds(cell.trip_s).c_str(),
                milliseconds(cell.safe_s).c_str(), recovery_of(cell).c_str(),
                bits_of(cell).c_str());
  return text + (cell.misses.empty() ? std::string() : "   MISSED: " + cell.misses);
}

std::string matrix_junit(const std::vector<MatrixCell>& cells) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"faults\" tests=\"" +
      std::to_string(cells.size()) + "\" failures=\"" + std::to_string(missed(cells)) + "\">\n";
  for (const std::string& mode : in_order(cells, mode_of)) {
    std::string body;
    std::size_t tests = 0, failures = 0;
    for (const MatrixCell& cell : cells) {
      if (mode_of(cell) != mode) continue;
      ++tests;
      body += "    <testcase classname=\"faults." + mode + "\" name=\"" + html_escape(cell.fault) +
              "\" time=\"0\">";
      if (!cell.misses.empty()) {
        ++failures;
        body += "<failure message=\"" + html_escape(cell.misses) + "\"/>";
      }
      body += "<system-out>" + html_escape(cell_line(cell)) + "</system-out></testcase>\n";
    }
    xml += "  <testsuite name=\"" + mode + "\" tests=\"" + std::to_string(tests) +
           "\" failures=\"" + std::to_string(failures) + "\">\n" + body + "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

std::string matrix_html(const std::vector<MatrixCell>& cells) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<link rel=\"icon\" href=\"data:,\"><title>hoof: faults in every mode</title>\n<style>"
      "body{font:14px sans-serif;margin:2em}table{border-collapse:collapse}"
      "th,td{border:1px solid #999;padding:.3em .5em;text-align:left;vertical-align:top}"
      ".missed{background:#c33;color:#fff}.bit{background:#eef3ff}</style></head><body>\n"
      "<h1>Faults in every mode</h1>\n<p>" +
      std::to_string(cells.size()) + " cells, " + std::to_string(missed(cells)) +
      " missed. Times in simulated milliseconds from the begin of the fault. Safe: from then on "
      "every drive was off or damping only. Reset: the order led to mode off without a fault, and "
      "the foot moved again.</p>\n<table><tr><th>fault</th>";
  const std::vector<std::string> modes = in_order(cells, mode_of);
  for (const std::string& mode : modes) html += "<th>" + mode + "</th>";
  html += "</tr>\n";
  for (const std::string& fault : in_order(cells, fault_name)) {
    html += "<tr><th>" + html_escape(fault) + "</th>";
    for (const std::string& mode : modes) {
      const MatrixCell* cell = find(cells, fault, mode);
      if (cell == nullptr) {
        html += "<td></td>";
      } else if (!cell->misses.empty()) {
        html += "<td class=\"missed\">" +
                html_escape(short_text(*cell) + ". Missed: " + cell->misses) + "</td>";
      } else {
        html += std::string(cell->faults != 0 ? "<td class=\"bit\">" : "<td>") +
                html_escape(short_text(*cell)) + "</td>";
      }
    }
    html += "</tr>\n";
  }
  return html + "</table></body></html>\n";
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
