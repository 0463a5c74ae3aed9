#include "tools/reproduce/cost.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "tools/run/progress_line.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

/// Where nothing is done yet: of `demo`, `medium` and sinkage on `bench` what finished runs took;
/// else their steps by the grains. Of `medium` and `bench` traction is that in the campaigns'
/// longer box. See README.md of this folder.
struct Speed {
  const char* terrain;
  const char* bed;               // "": any
  double sinkage_s, traction_s;  // core seconds of a run; traction at kTraction_Hz
  double steps_per_ms;           // of the preset; 0: no grains
};
constexpr double kTraction_Hz = 0.45;
constexpr Speed kSpeeds[] = {{"rigid", "", 0.3, 0.6, 0},        {"rft", "", 1, 3, 0},
                             {"dem", "demo", 13, 60, 80},       {"dem", "medium", 120, 1120, 200},
                             {"dem", "bench", 1000, 6800, 360}, {"dem", "paper", 4000, 19000, 360}};
constexpr double kSinkage_bytes = 0.75e6, kTraction_bytes = 3.2e6;

double size_of(const fs::path& folder) {
  double bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) bytes += double(entry.file_size(error));
  }
  return bytes;
}

/// The last of such a setting, as the last one counts.
std::string setting(const PlannedRun& run, const std::string& key) {
  std::string value;
  for (const std::string& line : run.settings) {
    if (line.starts_with(key + "=")) value = line.substr(key.size() + 1);
  }
  return value;
}

double number(const PlannedRun& run, const std::string& key, double otherwise) {
  const std::string value = setting(run, key);
  return value.empty() ? otherwise : std::stod(value);
}

/// From the narrowest to the widest that it has in common with others.
std::array<std::string, 3> keys(const PlannedRun& run) {
  const std::string pace = run.kind + " " + setting(run, "experiment.speed_m_s") + " " +
                           setting(run, "experiment.frequency_Hz");
  return {run.id.substr(0, run.id.rfind("-bed")), pace, run.kind};
}

}  // namespace

void CostModel::Mean::add(const Cost& cost) {
  core_s += cost.core_s, disk_bytes += cost.disk_bytes;
  ++n;
}

CostModel::CostModel(const RunStore& store, const std::vector<PlannedRun>& all) {
  for (const PlannedRun& run : all) {
    const RunTime time = store.run_time(run.id);
    if (time.run_s <= 0) continue;
    const Cost cost{time.run_s * time.threads, size_of(store.place(run.id))};
    for (const std::string& key : keys(run)) means_[key].add(cost);
    ++known_;
  }
}

Cost CostModel::of(const PlannedRun& run) const {
  for (const std::string& key : keys(run)) {
    const auto found = means_.find(key);
    if (found != means_.end()) return found->second.cost();
  }
  const std::string terrain = setting(run, "experiment.terrain"), bed = setting(run, "use.bed");
  for (const Speed& speed : kSpeeds) {
    const std::string of = speed.bed;
    if (terrain != speed.terrain || (!of.empty() && of != bed)) continue;
    const double finer =
        speed.steps_per_ms > 0
            ? number(run, "bed.steps_per_ms", speed.steps_per_ms) / speed.steps_per_ms
            : 1;
    if (run.kind == "sinkage") return {finer * speed.sinkage_s, kSinkage_bytes};
    const double longer = kTraction_Hz / number(run, "experiment.frequency_Hz", kTraction_Hz);
    return {finer * longer * speed.traction_s, longer * kTraction_bytes};
  }
  return {};
}

std::string CostModel::source() const {
  return known_ > 0 ? "by " + std::to_string(known_) + " finished runs of this folder"
                    : "by the speed of one Xeon core (tools/reproduce/README.md): a first guess";
}

std::string cost_text(const CostModel& model, const std::vector<PlannedRun>& missing, int jobs,
                      int threads) {
  if (missing.empty()) return "nothing is missing\n";
  double core_s = 0, bytes = 0;
  for (const PlannedRun& run : missing) {
    const Cost cost = model.of(run);
    core_s += cost.core_s, bytes += cost.disk_bytes;
  }
  char text[300];
  std::snprintf(text, sizeof text,
                "%zu runs missing: about %s with %d at once (%.1f core hours, threads each: %d; "
                "beds not counted), %.2f GB; %s\n",
                missing.size(), format_duration(core_s / jobs / threads).c_str(), jobs,
                core_s / 3600, threads, bytes / 1e9, model.source().c_str());
  return text;
}

}  // namespace hoof::tools
