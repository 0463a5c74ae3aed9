// report.html: what it says of verdicts made by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/diagnose/sample_verdict.h"
#include "tools/diagnose/report_page.h"
#include "tools/diagnose/report_plots.h"
#include "tools/diagnose/report_tables.h"

using namespace hoof::tools;
using namespace hoof::tests;

namespace {

constexpr RigKind kServo = RigKind::kServoPendulum;

nlohmann::json plots_of(const Verdict& verdict) {
  return nlohmann::json::parse(report_plots(verdict, kServo).json)["plots"];
}

std::size_t place_of(const std::string& page, const std::string& text) {
  const std::size_t at = page.find(text);
  INFO("looked for: " << text);
  REQUIRE(at != std::string::npos);
  return at;
}

}  // namespace

TEST_CASE("A report answers first, then says where, what, how much and what next") {
  const std::string page = report_page(sample_verdict(), sample_data_sets());
  const char* const in_order[] = {"Diagnosis of arm &lt;on the bench&gt;",
                                  "1 recording(s) fitted, 1 held out",
                                  "The model lacks cogging_torque (probability 0.90)",
                                  "The data limit what this answer is worth",
                                  "no recording turns a whole turn",
                                  "Where it shows",
                                  "|velocity| &lt; 0.2",
                                  "slow_triangle.csv: position<span class=\"role\">fitted",
                                  "fast_sine.csv: position<span class=\"role\">held out",
                                  "What it is",
                                  "Models that competed",
                                  "amplitude * sin(order * q + phase)",
                                  "What speaks for it",
                                  "What speaks against it",
                                  "How much",
                                  "nominal + backlash",
                                  "Values of the setup",
                                  "Data quality",
                                  "What next",
                                  "turn slowly through a whole turn"};
  std::size_t last = 0;
  for (const char* text : in_order) {
    const std::size_t at = place_of(page, text);
    INFO(text);
    CHECK(at > last);
    last = at;
  }
  CHECK(page.find("<on the bench>") == std::string::npos);
  CHECK(page == report_page(sample_verdict(), sample_data_sets()));
}

TEST_CASE("Plots mark the regions in their own recording, and name what is held out") {
  const auto plots = plots_of(sample_verdict());
  REQUIRE(plots.size() == 4);
  CHECK(plots[0]["regions"].size() == 2);
  CHECK(plots[0]["regions"][0]["from_s"] == 2.1);
  CHECK(plots[0]["regions"][1]["to_s"] == 5.8);
  CHECK(plots[1]["regions"].size() == 2);
  CHECK(plots[2]["regions"].empty());
  CHECK(plots[0]["unit"] == "rad");
  // A missing sample is a gap, in the signal and in the residual.
  CHECK(plots[0]["series"][0]["values"][77].is_null());
  CHECK(plots[1]["series"][1]["values"][77].is_null());
  CHECK(plots[1]["series"][0]["values"][0] == 0.0028);  // twice the noise floor
  const double signal = plots[0]["series"][0]["values"][10];
  const double before = plots[0]["series"][1]["values"][10];
  CHECK(plots[1]["series"][1]["values"][10].get<double>() == Approx(signal - before).margin(1e-5));
}

TEST_CASE("Of many recordings the most telling stand open, of both roles") {
  Verdict v = sample_verdict();
  const ChannelTrace told = v.traces[0];
  ChannelTrace nothing = told;
  nothing.after = nothing.before;
  v.traces.clear();
  // 0..3 explain nothing, 4..6 do; odd ones are held out.
  for (int i = 0; i < 7; ++i) {
    v.traces.push_back(i < 4 ? nothing : told);
    v.traces.back().recording = "run" + std::to_string(i) + ".csv";
    v.traces.back().holdout = i % 2 == 1;
  }
  v.recordings = {};
  using Indices = std::vector<std::size_t>;
  CHECK(traces_to_open(v) == Indices{4, 5, 6, 1});
  v.recordings = {"run0.csv", "run2.csv", "run3.csv"};
  CHECK(traces_to_open(v) == Indices{0, 2, 3, 5});
  const ReportPlots plots = report_plots(v, kServo);
  CHECK(plots.html.find("run3.csv") < plots.html.find("<details>"));
  CHECK(plots.html.find("run1.csv") > plots.html.find("<details>"));
  CHECK(plots.html.find("channels (3)") != std::string::npos);
  CHECK(nlohmann::json::parse(plots.json)["plots"].size() == 14);
}

TEST_CASE("A long recording is thinned without losing a peak") {
  std::vector<double> x(100000, 0.0), y(100000, 1.0);
  x[12345] = 5;
  y[77777] = -3;
  y[10] = NAN;
  const auto kept = thinned({&x, &y}, 2000);
  CHECK(kept.size() <= 2000);
  CHECK(std::find(kept.begin(), kept.end(), 12345u) != kept.end());
  CHECK(std::find(kept.begin(), kept.end(), 77777u) != kept.end());
  CHECK(std::is_sorted(kept.begin(), kept.end()));
  CHECK(thinned({&x, &y}, 100000).size() == 100000);
  CHECK(thinned({&x}, 100001).size() == 100000);
}

TEST_CASE("Each kind of verdict has its report") {
  const std::string none = report_page(sample_verdict_none(), sample_data_sets());
  place_of(none, "nothing is missing (probability 0.97)");
  place_of(none, "Nowhere in particular");
  place_of(none, "Nothing to say against the data.");
  CHECK(none.find("The data limit") == std::string::npos);
  CHECK(none.find("<details>") == std::string::npos);
  const std::string either = report_page(sample_verdict_not_separable(), sample_data_sets());
  place_of(either, "supply_sag (0.50) or thermal_derating (0.48)");
  place_of(either, "20 to open");
  place_of(either, "Experiment: hold one load for 60 s on a regulated supply.");
  const std::string unknown = report_page(sample_verdict_unknown(), sample_data_sets());
  place_of(unknown, "A stand-in for what is not in the list");
  place_of(unknown, "accounts for 60 % of the residual");
}

TEST_CASE("Errors that diverged are said and do not break the page") {
  Verdict v = sample_verdict();
  v.before.holdout["position_rmse"] = INFINITY;
  v.ablation[0].holdout["position_rmse"] = INFINITY;
  const std::string page = report_page(v, sample_data_sets());
  place_of(page, "position diverged -&gt; 0.0044 rad");
  CHECK(page.find(">inf<") == std::string::npos);
}

TEST_CASE("Evidence in words follows the bounds of Kass and Raftery") {
  CHECK(evidence_words(0.9) == "not worth more than a bare mention");
  CHECK(evidence_words(1.1) == "positive evidence for it");
  CHECK(evidence_words(-1.1) == "positive evidence against it");
  CHECK(evidence_words(3.1) == "strong evidence for it");
  CHECK(evidence_words(-5.1) == "very strong evidence against it");
  CHECK(evidence_words(NAN) == "not worth more than a bare mention");
}
