#include "tools/compare/compare_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/report/display_unit.h"
#include "tools/report/html.h"
#include "tools/report/page.h"
#include "tools/run/column_unit.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[300];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

std::string shown(double value, const DisplayUnit& unit) {
  return format_significant(unit.factor * value, 4) +
         (unit.symbol.empty() ? "" : " " + unit.symbol);
}

bool is_missing(const SignalComparison& c) {
  return c.verdict == SignalVerdict::kOnlyA || c.verdict == SignalVerdict::kOnlyB;
}

/// "0.1 mm or 1 %": whichever is more.
std::string allowance(const SignalComparison& c, const DisplayUnit& unit) {
  if (c.tolerance.absolute == 0 && c.tolerance.relative == 0) return "none";
  std::string text = shown(c.tolerance.absolute, unit);
  if (c.tolerance.relative > 0) text += " or " + format("%g %%", 100 * c.tolerance.relative);
  return text;
}

/// The cells of one row, the same in the terminal and on the page.
std::vector<std::string> cells(const SignalComparison& c) {
  const DisplayUnit unit = display_unit(c.name);
  if (is_missing(c)) return {c.name, to_string(c.verdict), "", "", "", "", ""};
  const bool texts = !c.value_names.empty();
  return {c.name,
          to_string(c.verdict),
          texts ? "" : shown(c.largest, unit),
          c.largest > 0 ? format("%.4f", c.largest_at_s) : "",
          texts ? "" : shown(c.rms, unit),
          texts ? "same text" : allowance(c, unit),
          c.first_outside_s ? format("%.4f", *c.first_outside_s) : ""};
}

const std::vector<std::string> kHeadings = {"signal",        "verdict",        "largest difference",
                                            "at s",          "rms difference", "allowed",
                                            "first out at s"};

/// Characters, not bytes: units hold a degree sign or a power.
std::size_t width_of(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

std::vector<std::string> summary(const Comparison& c, const ComparedNames& names) {
  std::vector<std::string> lines = {
      "A " + names.a, "B " + names.b,
      format("compared from %.4f to %.4f s of A", c.overlap_from_s, c.overlap_to_s)};
  if (c.shift_s != 0) lines.back() += format(", B moved by %+.4f s", c.shift_s);
  if (c.length_differs) {
    lines.push_back(
        format("LENGTH DIFFERS: A ends at %.4f s, B at %.4f s", c.a_ends_s, c.b_ends_s));
  }
  return lines;
}

std::string conclusion(const Comparison& c) {
  const auto out = std::count_if(c.signals.begin(), c.signals.end(), [](const auto& s) {
    return s.verdict != SignalVerdict::kSame && s.verdict != SignalVerdict::kWithin;
  });
  const auto same = std::count_if(c.signals.begin(), c.signals.end(),
                                  [](const auto& s) { return s.verdict == SignalVerdict::kSame; });
  std::string text = format("%d signals: %d the same, %d within tolerance, %d out or missing",
                            int(c.signals.size()), int(same),
                            int(c.signals.size()) - int(same) - int(out), int(out));
  const SignalComparison* first = nullptr;
  for (const SignalComparison& s : c.signals) {
    if (s.first_outside_s && (!first || *s.first_outside_s < *first->first_outside_s)) first = &s;
  }
  if (first != nullptr) {
    text += format("; first out of tolerance: %s at %.4f s", first->name.c_str(),
                   *first->first_outside_s);
  }
  return text;
}

/// Out of tolerance first, then by how much of the tolerance the largest difference is.
std::vector<const SignalComparison*> worst_first(const Comparison& comparison) {
  std::vector<const SignalComparison*> order;
  for (const SignalComparison& c : comparison.signals) order.push_back(&c);
  std::stable_sort(order.begin(), order.end(),
                   [](const SignalComparison* x, const SignalComparison* y) {
                     return int(x->verdict) > int(y->verdict);
                   });
  return order;
}

std::vector<double> shifted(const std::vector<double>& values, const std::vector<double>& by,
                            double sign) {
  std::vector<double> out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = values[i] + sign * by[i];
  return out;
}

std::string json_plot(const SignalComparison& c) {
  const DisplayUnit unit = display_unit(c.name);
  const auto line = [&](const char* label, const std::vector<double>& values, bool band) {
    return "{\"label\":" + Json(label).dump() + ",\"step\":" + (c.whole ? "true" : "false") +
           ",\"band\":" + (band ? "true" : "false") +
           ",\"values\":" + json_numbers(values, unit.factor) + "}";
  };
  std::string json = "{\"axis\":" + Json(column_label(c.name)).dump() +
                     ",\"unit\":" + Json(unit.symbol).dump() +
                     ",\"time_s\":" + json_numbers(c.time_s, 1) + ",\"series\":[" +
                     line("A", c.a, false) + ",\n" + line("B", c.b, false);
  if (!c.whole) {
    json += ",\n" + line("A + allowed", shifted(c.a, c.allowed, 1), true) + ",\n" +
            line("A - allowed", shifted(c.a, c.allowed, -1), true);
  }
  return json + "]}";
}

std::string table_html(const std::vector<const SignalComparison*>& order) {
  std::string html = "<table><tr>";
  for (const std::string& heading : kHeadings) html += element("th", heading, " scope=\"col\"");
  html += "</tr>\n";
  for (const SignalComparison* c : order) {
    const bool bad = c->verdict != SignalVerdict::kSame && c->verdict != SignalVerdict::kWithin;
    html += bad ? "<tr class=\"refused\">" : "<tr>";
    for (const std::string& cell : cells(*c)) html += element("td", cell);
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

void print_comparison(const Comparison& comparison, const ComparedNames& names, std::ostream& out) {
  for (const std::string& line : summary(comparison, names)) out << line << "\n";
  std::vector<std::vector<std::string>> rows = {kHeadings};
  for (const SignalComparison& c : comparison.signals) rows.push_back(cells(c));
  std::vector<std::size_t> widths(kHeadings.size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  out << "\n";
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i] + std::string(widths[i] - width_of(row[i]) + 2, ' ');
    }
    out << line.substr(0, line.find_last_not_of(' ') + 1) << "\n";
  }
  out << "\n" << conclusion(comparison) << "\n";
}

std::string comparison_page(const Comparison& comparison, const ComparedNames& names) {
  const auto order = worst_first(comparison);
  std::string body;
  for (const std::string& line : summary(comparison, names)) {
    body += element("p", line, " class=\"note\"");
  }
  body += element("p", conclusion(comparison)) + table_html(order) +
          "<h2>Signals against the time of A</h2>\n<p class=\"note\">The worst first; thin dotted "
          "lines are what A allows. Drag to zoom, double-click to see all.</p>\n"
          "<noscript>The plots need JavaScript.</noscript>\n<div class=\"plots\">\n";
  std::string json = "{\"time_s\":[],\"phases\":[],\"plots\":[";
  const char* between = "";
  for (const SignalComparison* c : order) {
    if (c->time_s.empty()) continue;
    body += "<div class=\"plot\">" + element("h3", c->name + ": " + to_string(c->verdict)) +
            "<div class=\"canvas\"></div></div>\n";
    json += between + json_plot(*c);
    between = ",\n";
  }
  return make_page("Two recordings compared", body + "</div>\n", json + "]}");
}

}  // namespace hoof::tools
