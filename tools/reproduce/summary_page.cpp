#include "tools/reproduce/summary_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/report/html.h"
#include "tools/report/page.h"
#include "tools/reproduce/target_chart.h"

namespace hoof::tools {
namespace {

std::string digits(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) >= 100 ? "%.0f" : "%.3g", value);
  return text;
}

/// What a bed cannot tell: without the numbers.
std::string in_short(const std::vector<std::string>& sentences) {
  std::string all, last;
  for (const std::string& sentence : sentences) {
    const std::string name = sentence.substr(0, sentence.find(": "));
    if (name != last) all += (all.empty() ? "" : "; ") + name;
    last = name;
  }
  return all;
}

/// Targets by changes: what each makes of each. @param both those read by the sole beside
std::string changes_table(const std::vector<Comparison>& rows, bool both) {
  std::vector<const Tried*> columns;
  for (const Comparison& row : rows) {
    for (const Tried& t : row.tried) {
      const bool known = std::any_of(columns.begin(), columns.end(),
                                     [&](const Tried* c) { return c->name == t.name; });
      if (t.both == both && !known) columns.push_back(&t);
    }
  }
  if (columns.empty()) return "";
  std::string html;
  if (!both) {
    html += "<dl>\n";
    for (const Tried* c : columns) {
      html += element("dt", c->name) + element("dd", c->kind + ": " + c->what) + "\n";
    }
    html += "</dl>\n";
  }
  html += "<table class=\"changes\">\n<tr>" + element("th", "target") + element("th", "accepted") +
          element("th", "ours");
  for (const Tried* c : columns) html += element("th", c->name);
  html += "</tr>\n";
  for (const Comparison& row : rows) {
    const bool band = row.low != 0 || row.high != 0;
    const bool any = std::any_of(row.tried.begin(), row.tried.end(),
                                 [&](const Tried& t) { return t.both == both; });
    if (!any || !band) continue;
    html += "<tr>" + element("td", row.name) +
            element("td", digits(row.low) + " to " + digits(row.high)) +
            element("td", row.ours ? digits(row.ours->mean) : "",
                    row.judgement() == Judgement::kInside ? " class=\"inside\"" : "");
    for (const Tried* c : columns) {
      const auto t = std::find_if(row.tried.begin(), row.tried.end(),
                                  [&](const Tried& one) { return one.name == c->name; });
      html += t == row.tried.end() ? element("td", "")
                                   : element("td", digits(t->with.mean),
                                             " title=\"without it " + digits(t->without.mean) +
                                                 ", beds: " + std::to_string(t->with.n) + "\"" +
                                                 (t->inside ? " class=\"inside\"" : ""));
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string changes(const std::vector<Comparison>& rows) {
  const std::string one = changes_table(rows, false), both = changes_table(rows, true);
  if (one.empty()) return "";
  return element("h2", "One thing changed") + one +
         element("p",
                 "Green: inside what is accepted. Each number is of the beds that were run "
                 "with the change; what the same beds give without it stands behind it, and "
                 "in changes.csv. Empty: the change is none of these runs, or was not run.") +
         (both.empty() ? "" : element("h2", "And depth counted by the sole") + both);
}

/// What a reader asks of one target: what to know, why, and what its beds cannot tell.
std::string told_of(const Comparison& row) {
  std::string text = row.note;
  for (const std::string& more :
       {row.reasons(),
        row.cannot_tell.empty() ? "" : "the bed cannot tell: " + in_short(row.cannot_tell)}) {
    if (!more.empty()) text += (text.empty() ? "" : ". ") + capitalised(more);
  }
  return capitalised(text);
}

std::string table(const std::vector<Comparison>& rows) {
  std::string html = "<table class=\"targets\">\n<tr>";
  for (const char* head :
       {"target", "paper", "accepted", "ours, mean +- deviation", "beds", "result", "standing"}) {
    html += element("th", head);
  }
  html += "</tr>\n";
  std::string not_run;
  for (const Comparison& row : rows) {
    if (row.judgement() == Judgement::kNotRun) {
      not_run += element("li", row.name) + "\n";
      continue;
    }
    const bool band = row.low != 0 || row.high != 0;
    const std::string unit = row.unit == "1" ? "" : " " + row.unit;
    std::string ours = row.ours ? digits(row.ours->mean) : "";
    if (row.ours && std::isfinite(row.ours->deviation))
      ours += " +- " + digits(row.ours->deviation);
    const std::string result = to_string(row.judgement());
    html += "<tr>" + element("td", row.name) +
            element("td", std::isfinite(row.paper) ? digits(row.paper) + unit : "") +
            element("td", band ? digits(row.low) + " to " + digits(row.high) : "") +
            element("td", ours.empty() ? "" : ours + unit) +
            element("td", std::to_string(row.ours ? row.ours->n : 0)) +
            element("td", result, " class=\"" + html_escape(result) + "\"") +
            element("td", to_string(row.standing)) + "</tr>\n";
    const std::string told = told_of(row);
    if (told.empty()) continue;
    html += "<tr class=\"told\">" +
            element("td", told,
                    " colspan=\"7\" title=\"" + html_escape(row.cannot_tell_text()) + "\"") +
            "</tr>\n";
  }
  html += "</table>\n";
  if (not_run.empty()) return html;
  return html + "<details>\n<summary>Not run</summary>\n<ul>\n" + not_run + "</ul>\n</details>\n";
}

}  // namespace

std::string summary_page(const Campaign& campaign, const ReproduceOptions& options,
                         const std::vector<Comparison>& rows, const std::vector<Figure>& figures) {
  int inside = 0, outside = 0, undefined = 0, missing = 0;
  for (const Comparison& row : rows) {
    if (row.standing != Standing::kPrediction) continue;
    inside += row.judgement() == Judgement::kInside ? 1 : 0;
    outside += row.judgement() == Judgement::kOutside ? 1 : 0;
    missing += row.judgement() == Judgement::kNotRun ? 1 : 0;
    undefined += row.judgement() == Judgement::kUndefined ? 1 : 0;
  }
  const Outcomes outcomes = campaign.outcomes();
  std::size_t runs = 0;
  for (const auto& [condition, beds] : outcomes) runs += beds.size();
  const auto asked = std::count_if(campaign.cells().begin(), campaign.cells().end(),
                                   [&](const Cell& cell) { return campaign.done(cell); });
  std::string body =
      element("p", std::to_string(runs) + " runs as the paper has them, bed " +
                       options.ground.scale + ", terrain " + options.ground.terrain + "; of the " +
                       std::to_string(campaign.cells().size()) + " that were last asked for " +
                       std::to_string(asked) + " are done. Of the " +
                       std::to_string(inside + outside + undefined + missing) + " predictions " +
                       std::to_string(inside) + " are inside what is accepted, " +
                       std::to_string(outside) + " outside, " + std::to_string(undefined) +
                       " have no value, " + std::to_string(missing) + " were not run.");
  if (options.ground.terrain != "dem") {
    body += element("p", "Not on grains: this shows the campaign, and says nothing about sand.");
  }
  body += element(
      "p",
      "A prediction is a target that nothing of ours was set on; an input one that something the "
      "paper does not give was chosen by, as its note says. The paper's numbers are simulations "
      "too. What a bed cannot tell stands with its numbers in summary.csv.");
  const std::string glance = draw_targets(rows);
  if (!glance.empty()) body += "<figure>" + glance + "</figure>\n";
  std::string drawn = element("h2", "Figures") +
                      element("p",
                              "Lines: mean over the beds with one standard deviation; dashed: the "
                              "paper's numbers.");
  for (const Figure& figure : figures) drawn += "<figure>" + figure.svg + "</figure>\n";
  std::string shapes = element("h2", "Shapes of the feet");
  for (const auto& [foot, hash] : campaign.geometry_hashes()) {
    shapes += element("p", foot + ": SHA-256 " + hash, " class=\"note\"");
  }
  return make_page("The paper's experiments",
                   body + element("h2", "Targets") + table(rows) + drawn + changes(rows) + shapes,
                   "{}");
}

}  // namespace hoof::tools
