#include "tools/reproduce/outcome.h"

#include <algorithm>
#include <cmath>

#include "sim/config/reader.h"
#include "sim/config/settings.h"
#include "sim/terrain/bed_grading.h"
#include "sim/terrain/bed_settings.h"
#include "tools/report/sample_table.h"
#include "tools/reproduce/paper.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

/// Contact: the first sample with a push from below. Noise there is none: both are simulated.
constexpr double kTouch_N = 1;

ForceTrace read_trace(const fs::path& samples) {
  const SampleTable table = read_samples(samples);
  const SampleColumn* time = table.find("time_s");
  const SampleColumn* fx = table.find("fx_N");
  const SampleColumn* fz = table.find("fz_N");
  if (time == nullptr || fx == nullptr || fz == nullptr) {
    throw UserError(samples.string() + ": has no time_s, fx_N, fz_N");
  }
  ForceTrace trace;
  std::vector<int> counts;
  double contact_s = NAN;
  for (std::size_t i = 0; i < time->numbers.size(); ++i) {
    if (std::isnan(contact_s) && fz->numbers[i] >= kTouch_N) contact_s = time->numbers[i];
    if (std::isnan(contact_s)) continue;
    // A sample's time is a whole number of milliseconds: half of one keeps it off a bin's edge.
    const double since_s = time->numbers[i] - contact_s + 0.5e-3;
    const std::size_t bin = std::size_t(since_s / ForceTrace::kStep_s);
    if (bin >= counts.size()) {
      counts.resize(bin + 1), trace.fx_N.resize(bin + 1), trace.fz_N.resize(bin + 1);
    }
    ++counts[bin], trace.fx_N[bin] += fx->numbers[i], trace.fz_N[bin] += fz->numbers[i];
  }
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    trace.fx_N[bin] /= std::max(counts[bin], 1), trace.fz_N[bin] /= std::max(counts[bin], 1);
  }
  return trace;
}

void read_sand(const nlohmann::json& result, Outcome& o) {
  const auto none = nlohmann::json::object();
  const auto moment = result.value("fields", none).value("greatest_depth", none);
  const auto number = [&](const char* key) {  // null: the moment does not tell it
    return moment.contains(key) && moment[key].is_number() ? moment[key].get<double>()
                                                           : Outcome::kNone;
  };
  o.high_pressure_share = number("high_pressure_share_ratio");
  o.support_area_ratio = number("support_area_over_plan_ratio");
  o.gap_stress_ratio = number("gap_over_foot_stress_ratio");
}

double grains_in_papers_box(const nlohmann::json& result, const fs::path& folder) {
  const auto none = nlohmann::json::object();
  const double grains = result.value("ground", none).value("grains", 0.0);
  if (grains <= 0 || !fs::exists(folder / "settings.toml")) return Outcome::kNone;
  const auto settings = sim::Settings::load_file(folder / "settings.toml");
  sim::BedSettings bed = sim::read_bed(sim::Reader(settings).section("bed"));
  bed.overfill = 1;
  const double share = grains / double(sim::grains_to_pour(bed, 1));
  bed.box_length_m = kPaperBox_m[0], bed.box_width_m = kPaperBox_m[1];
  bed.depth_m = kPaperBox_m[2], bed.grain_scale = 1;
  return double(sim::grains_to_pour(bed, share));
}

}  // namespace

void find_timing(Outcome& o) {
  const std::vector<double>& fx = o.trace.fx_N;
  if (fx.empty()) return;
  const auto main = std::max_element(fx.begin(), fx.end());
  const auto middle_s = [&](auto at) {
    return (double(at - fx.begin()) + 0.5) * ForceTrace::kStep_s;
  };
  o.fx_peak_s = middle_s(main);
  o.early_ratio = o.early_s = 0;
  if (*main <= 0) return;
  // From the main peak back: the deepest valley so far, and the highest that stands out from it.
  double valley = *main;
  for (auto at = main; at != fx.begin();) {
    --at;
    valley = std::min(valley, *at);
    const bool crest = at == fx.begin() || *(at - 1) <= *at;
    const bool higher = *at / *main > o.early_ratio;
    if (crest && higher && *at - valley >= Outcome::kEarly * *main) {
      o.early_ratio = *at / *main, o.early_s = middle_s(at);
    }
  }
}

Outcomes read_by_sole(const Outcomes& outcomes) {
  Outcomes read = outcomes;
  for (auto& [condition, runs] : read) {
    for (auto& [bed, run] : runs) run.sinkage_mm = std::max(0.0, run.sole_sinkage_mm);
  }
  return read;
}

Outcome read_outcome(bool traction, const fs::path& folder) {
  const fs::path file = folder / "result.json";
  Outcome o;
  try {
    const auto j = nlohmann::json::parse(read_file(file));
    if (j.contains("resolution")) {
      for (const auto& claim : j["resolution"]["claims_refused"]) o.refused.push_back(claim);
    }
    if (!traction) {
      o.sinkage_mm = 1e3 * j.at("max_depth_m").get<double>();
      o.sole_sinkage_mm = 1e3 * j.at("max_sole_depth_m").get<double>();
      read_sand(j, o);
      o.grains_in_papers_box = grains_in_papers_box(j, folder);
      return o;
    }
    o.fx_peak_N = j.at("fx_peak_N"), o.fz_at_fx_peak_N = j.at("fz_at_fx_peak_N");
    const auto& coefficient = j.at("traction_coefficient");
    // Runs of before 2026-11-30 have 0 in place of null.
    const bool carried = coefficient.is_number() && o.fz_at_fx_peak_N > 0;
    o.coefficient = carried ? coefficient.get<double>() : Outcome::kNone;
  } catch (const nlohmann::json::exception& error) {
    throw UserError(file.string() + ": " + error.what());
  }
  o.trace = read_trace(folder / "samples.csv");
  find_timing(o);
  return o;
}

}  // namespace hoof::tools
