#include "tools/reproduce/summary_page.h"

#include <cmath>
#include <cstdio>
#include <sstream>

#include "tools/report/html.h"
#include "tools/report/page.h"

namespace hoof::tools {
namespace {

std::string digits(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) >= 100 ? "%.0f" : "%.3g", value);
  return text;
}

/// What a bed cannot tell, without the numbers.
std::string in_short(const std::string& reason) {
  if (!reason.starts_with(kBedCannotTell)) return reason;
  const std::string start = kBedCannotTell;
  std::istringstream parts(reason.substr(start.size()));
  std::string all, last;
  for (std::string part; std::getline(parts, part, ';');) {
    part = part.substr(part.find_first_not_of(' '));
    part = part.substr(0, part.find(": "));
    if (part != last) all += (all.empty() ? "" : "; ") + part;
    last = part;
  }
  return start + all;
}

std::string table(const std::vector<Comparison>& rows) {
  std::string html = "<table>\n<tr>";
  for (const char* head : {"target", "paper", "accepted", "ours", "deviation", "beds", "result",
                           "standing", "note", "reason found"}) {
    html += element("th", head);
  }
  html += "</tr>\n";
  for (const Comparison& row : rows) {
    const bool band = row.low != 0 || row.high != 0;
    const std::string unit = row.unit == "1" ? "" : " " + row.unit;
    html += "<tr>" + element("td", row.name) + element("td", digits(row.paper) + unit) +
            element("td", band ? digits(row.low) + " to " + digits(row.high) : "") +
            element("td", row.ours ? digits(row.ours->mean) + unit : "") +
            element("td", row.ours ? digits(row.ours->deviation) : "") +
            element("td", row.ours ? std::to_string(row.ours->n) : "") +
            element("td", to_string(row.judgement())) + element("td", to_string(row.standing)) +
            element("td", row.note) +
            element("td", in_short(row.reason), " title=\"" + html_escape(row.reason) + "\"") +
            "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

std::string summary_page(const Campaign& campaign, const ReproduceOptions& options,
                         const std::vector<Comparison>& rows, const std::vector<Figure>& figures) {
  int inside = 0, outside = 0, missing = 0;
  for (const Comparison& row : rows) {
    if (row.standing != Standing::kPrediction) continue;
    inside += row.judgement() == Judgement::kInside ? 1 : 0;
    outside += row.judgement() == Judgement::kOutside ? 1 : 0;
    missing += row.judgement() == Judgement::kNotRun ? 1 : 0;
  }
  const Outcomes outcomes = campaign.outcomes();
  std::size_t runs = 0;
  for (const auto& [condition, beds] : outcomes) runs += beds.size();
  std::string body = element(
      "p", std::to_string(runs) + " of " + std::to_string(campaign.cells().size()) + " runs, bed " +
               options.ground.scale + ", terrain " + options.ground.terrain + ". Of the " +
               std::to_string(inside + outside + missing) + " predictions " +
               std::to_string(inside) + " are inside what is accepted, " + std::to_string(outside) +
               " outside, " + std::to_string(missing) + " not run.");
  if (options.ground.terrain != "dem") {
    body += element("p", "Not on grains: this shows the campaign, and says nothing about sand.");
  }
  body += element("p",
                  "Lines: mean over the beds with one standard deviation; dashed: the paper's "
                  "numbers, which are simulations too. A prediction is a target that nothing of "
                  "ours was set on; an input one that the geometry, which the paper does not give, "
                  "was chosen by. What a bed cannot tell stands with its numbers in summary.csv.");
  for (const auto& [foot, hash] : campaign.geometry_hashes()) {
    body += element("p", "Geometry of " + foot + ": SHA-256 " + hash);
  }
  std::string drawn;
  for (const Figure& figure : figures) drawn += "<figure>" + figure.svg + "</figure>\n";
  return make_page("The paper's experiments", body + drawn + table(rows), "{}");
}

}  // namespace hoof::tools
