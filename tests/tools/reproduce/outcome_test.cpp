#include "tools/reproduce/outcome.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/config/settings.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
namespace fs = std::filesystem;

namespace {

/// Bells of 60 ms about their times, in 10 ms steps.
Outcome with_peaks(const std::vector<std::pair<double, double>>& time_and_height) {
  Outcome o;
  for (int i = 0; i < 100; ++i) {
    const double t = (i + 0.5) * ForceTrace::kStep_s;
    double fx = 0;
    for (const auto& [at_s, height] : time_and_height) {
      fx += height * std::exp(-std::pow((t - at_s) / 0.06, 2));
    }
    o.trace.fx_N.push_back(fx), o.trace.fz_N.push_back(2 * fx);
  }
  find_timing(o);
  return o;
}

}  // namespace

TEST_CASE("timing of a stance: the main peak, and a small one before it") {
  const Outcome two = with_peaks({{0.205, 40}, {0.605, 100}});
  CHECK(two.fx_peak_s == Approx(0.605));
  CHECK(two.early_s == Approx(0.205));
  CHECK(two.early_ratio == Approx(0.40).margin(0.01));
  // Of several the greatest counts; one after the main peak is none.
  const Outcome three = with_peaks({{0.105, 20}, {0.305, 50}, {0.605, 100}, {0.855, 60}});
  CHECK(three.early_s == Approx(0.305));
  CHECK(three.early_ratio == Approx(0.50).margin(0.01));
  for (const Outcome& none : {with_peaks({{0.605, 100}}), with_peaks({{0.305, 100}, {0.755, 60}}),
                              with_peaks({{0.205, 4}, {0.605, 100}}),      // stands out by 4 %
                              with_peaks({{0.545, 40}, {0.605, 100}})}) {  // a shoulder
    CHECK(none.early_ratio == 0);
    CHECK(none.early_s == 0);
  }
  Outcome pushed_back;
  pushed_back.trace.fx_N = {-3, -2, -1, -2};
  find_timing(pushed_back);
  CHECK(pushed_back.early_ratio == 0);
}

TEST_CASE("an outcome is read from a run's folder: time counts from first contact") {
  const hoof::tests::ScratchFolder scratch;
  write_file(scratch.path() / "result.json",
             "{\"fx_peak_N\": 8, \"fz_at_fx_peak_N\": 16, \"traction_coefficient\": 0.5,"
             " \"resolution\": {\"claims_refused\": [\"effect of the spines: x is 1, needs 2\"]}}");
  std::string csv = "time_s,phase_name,fx_N,fz_N\n";
  for (int i = 1; i <= 100; ++i) {
    const bool touching = i >= 31;  // at 31 ms
    const double fx = touching ? (i >= 61 && i <= 70 ? 8 : 2) : 0;
    csv += std::to_string(i * 1e-3) + ",loaded," + std::to_string(fx) + "," +
           (touching ? "16" : "0") + "\n";
  }
  write_file(scratch.path() / "samples.csv", csv);
  const Outcome o = read_outcome(true, scratch.path());
  CHECK(o.coefficient == 0.5);
  CHECK(o.trace.fx_N == std::vector<double>{2, 2, 2, 8, 2, 2, 2});
  CHECK(o.trace.fz_N == std::vector<double>(7, 16));
  CHECK(o.fx_peak_s == Approx(0.035));
  CHECK(o.refused.size() == 1);
  write_file(scratch.path() / "result.json",
             "{\"max_depth_m\": 0.0125, \"max_sole_depth_m\": 0.003}");
  CHECK(read_outcome(false, scratch.path()).sinkage_mm == Approx(12.5));
  CHECK(read_outcome(false, scratch.path()).sole_sinkage_mm == Approx(3));
  CHECK(std::isnan(read_outcome(false, scratch.path()).support_area_ratio));  // of a run without
  write_file(
      scratch.path() / "result.json",
      "{\"max_depth_m\": 0.0125, \"max_sole_depth_m\": 0.003, \"fields\": {\"greatest_depth\": {"
      "\"high_pressure_share_ratio\": 0.3, \"support_area_over_plan_ratio\": 0.6,"
      " \"gap_over_foot_stress_ratio\": null}}}");
  const Outcome standing = read_outcome(false, scratch.path());
  CHECK(standing.high_pressure_share == 0.3);
  CHECK(standing.support_area_ratio == 0.6);
  CHECK(std::isnan(standing.gap_stress_ratio));  // closed toes have no gap
  CHECK_THROWS_AS(read_outcome(true, scratch.path()), UserError);
}

TEST_CASE("grains of a bed are told for the paper's box and the paper's size of grains") {
  const hoof::tests::ScratchFolder scratch;
  const auto of = [&](const char* bed, double grains) {
    const std::vector<std::string> chosen = {std::string("use.bed=") + bed};
    write_file(scratch.path() / "settings.toml",
               hoof::sim::Settings::load_experiment("sinkage", chosen).to_toml());
    write_file(scratch.path() / "result.json",
               "{\"max_depth_m\": 0.0125, \"max_sole_depth_m\": 0.003, \"ground\": {\"grains\": " +
                   std::to_string(grains) + "}}");
    return read_outcome(false, scratch.path()).grains_in_papers_box;
  };
  // By volumes; grains of 1.5 times the size are 1.5 cubed fewer. Rounded twice to whole grains.
  const double ratio = 530.0 * 420 * 120 / (320.0 * 220 * 100);
  CHECK(of("bench", 238941) == Approx(238941 * ratio).epsilon(2e-5));
  CHECK(of("medium", 70798) == Approx(70798 * 3.375 * ratio).epsilon(2e-5));
  CHECK(of("paper", 912550) == Approx(912550).epsilon(2e-5));
  CHECK(std::isnan(of("bench", 0)));
  fs::remove(scratch.path() / "settings.toml");
  CHECK(std::isnan(read_outcome(false, scratch.path()).grains_in_papers_box));
}
