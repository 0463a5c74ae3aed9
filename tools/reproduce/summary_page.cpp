#include "tools/reproduce/summary_page.h"

#include <cmath>
#include <cstdio>
#include <functional>

#include "tools/report/html.h"
#include "tools/report/page.h"
#include "tools/reproduce/paper.h"
#include "tools/run/csv_writer.h"
#include "tools/study/line_plot.h"
#include "tools/study/statistics.h"

namespace hoof::tools {
namespace {

std::string digits(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) >= 100 ? "%.0f" : "%.3g", value);
  return text;
}

struct Curve {
  std::string label;
  std::vector<std::pair<double, std::string>> places;  // x, and the condition there
};

using Value = std::function<double(const Outcome&)>;
using Stated = std::function<double(const std::string& condition)>;

/// Ours as a line with one deviation over the beds at each place, the paper's dashed.
std::string figure(const std::string& title, const std::string& x_label, const std::string& y_label,
                   const Outcomes& outcomes, const std::vector<Curve>& curves, const Value& value,
                   const Stated& stated) {
  std::vector<PlotLine> lines;
  int colour = 0;
  for (const Curve& curve : curves) {
    PlotLine ours{curve.label + ", ours", {}, colour}, paper{curve.label + ", paper", {}, colour};
    paper.dashed = true;
    for (const auto& [x, condition] : curve.places) {
      if (std::isfinite(stated(condition))) paper.points.emplace_back(x, stated(condition));
      const auto found = outcomes.find(condition);
      if (found == outcomes.end()) continue;
      std::vector<double> values;
      for (const auto& [bed, outcome] : found->second) values.push_back(value(outcome));
      const Sample sample = sample_of(values);
      if (sample.n == 0) continue;
      ours.points.emplace_back(x, sample.mean);
      ours.half_range.push_back(std::isfinite(sample.deviation) ? sample.deviation : 0);
    }
    if (!ours.points.empty()) lines.push_back(ours);
    if (!paper.points.empty()) lines.push_back(paper);
    ++colour;
  }
  return "<figure>" + draw_lines(title, x_label, y_label, lines) + "</figure>\n";
}

double paper_coefficient(const std::string& condition) {
  const double stated = paper_traction(condition).coefficient;
  return stated > 0 ? stated : NAN;
}

std::string figures(const Outcomes& outcomes) {
  std::string html;
  const auto mm = [](const Outcome& o) { return o.sinkage_mm; };
  const auto coefficient = [](const Outcome& o) { return o.coefficient; };
  for (const std::string speed : {"0.1", "0.4"}) {
    std::vector<Curve> curves;
    for (const auto& [foot, label] : {std::pair<std::string, std::string>{"bionic-toe0", "spined"},
                                      {"bionic-plain-toe0", "plain"},
                                      {"traditional", "traditional"}}) {
      Curve curve{label, {}};
      for (const int load : {10, 20, 30, 40, 50, 60}) {
        curve.places.emplace_back(
            load, "sinkage-" + foot + "-" + std::to_string(load) + "kg-" + speed + "m_s");
      }
      curves.push_back(curve);
    }
    html += figure("Sinkage against load, " + speed + " m/s, toes closed", "load, kg",
                   "sinkage, mm", outcomes, curves, mm, paper_sinkage_mm);
  }
  std::vector<Curve> curves;
  for (const int load : {10, 60}) {
    for (const std::string speed : {"0.1", "0.4"}) {
      Curve curve{std::to_string(load) + " kg, " + speed + " m/s", {}};
      for (const int toe : {0, 10, 20, 30, 40}) {
        curve.places.emplace_back(toe, "sinkage-bionic-toe" + std::to_string(toe) + "-" +
                                           std::to_string(load) + "kg-" + speed + "m_s");
      }
      curves.push_back(curve);
    }
  }
  html += figure("Sinkage against opening, spined foot", "opening of each toe, degrees",
                 "sinkage, mm", outcomes, curves, mm, paper_sinkage_mm);
  curves.clear();
  for (const std::string step : {"0.45Hz", "1.12Hz"}) {
    Curve curve{step, {}};
    for (const int toe : {0, 10, 20, 30, 40}) {
      curve.places.emplace_back(toe, "traction-bionic-toe" + std::to_string(toe) + "-" + step);
    }
    curves.push_back(curve);
  }
  html +=
      figure("Traction coefficient against opening, spined foot", "opening of each toe, degrees",
             "Fx at its peak over Fz then", outcomes, curves, coefficient, paper_coefficient);
  return html;
}

std::string table(const std::vector<Comparison>& rows) {
  std::string html = "<table>\n<tr>";
  for (const char* head :
       {"target", "paper", "accepted", "ours", "deviation", "beds", "result", "standing", "note"}) {
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
            element("td", row.note) + "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

std::string summary_page(const Campaign& campaign, const ReproduceOptions& options,
                         const std::vector<Comparison>& rows) {
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
               options.scale + ", terrain " + options.terrain + ". Of the " +
               std::to_string(inside + outside + missing) + " predictions " +
               std::to_string(inside) + " are inside what is accepted, " + std::to_string(outside) +
               " outside, " + std::to_string(missing) + " not run.");
  if (options.terrain != "dem") {
    body += element("p", "Not on grains: this shows the campaign, and says nothing about sand.");
  }
  body += element("p",
                  "Lines: mean over the beds with one standard deviation; dashed: the paper's "
                  "numbers, which are simulations too. A prediction is a target that nothing of "
                  "ours was set on; an input one that the geometry, which the paper does not give, "
                  "was chosen by.");
  for (const auto& [foot, hash] : campaign.geometry_hashes()) {
    body += element("p", "Geometry of " + foot + ": SHA-256 " + hash);
  }
  return make_page("The paper's experiments", body + figures(outcomes) + table(rows), "{}");
}

}  // namespace hoof::tools
