#include "tools/reproduce/manifest.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

fs::path file_of(const fs::path& campaign) {
  return campaign / "manifest.json";
}

}  // namespace

void write_manifest(const fs::path& campaign, const std::vector<PlannedRun>& runs) {
  std::vector<PlannedRun> all;
  if (fs::exists(file_of(campaign))) all = read_manifest(campaign);
  for (const PlannedRun& run : runs) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const PlannedRun& r) { return r.id == run.id; });
    if (same == all.end()) {
      all.push_back(run);
    } else {
      *same = run;
    }
  }
  nlohmann::ordered_json j;
  j["runs"] = nlohmann::ordered_json::array();
  for (const PlannedRun& run : all) {
    j["runs"].push_back({{"id", run.id},
                         {"kind", run.kind},
                         {"settings", run.settings},
                         {"settings_sha256", run.settings_sha256}});
  }
  fs::path partial = file_of(campaign);
  partial += ".partial";
  write_result_json(partial, j);
  fs::rename(partial, file_of(campaign));
}

std::vector<PlannedRun> read_manifest(const fs::path& campaign) {
  const fs::path file = file_of(campaign);
  if (!fs::exists(file)) {
    throw UserError(file.string() + ": there is none; hoof reproduce or hoof claims makes one");
  }
  try {
    const auto j = nlohmann::json::parse(read_file(file));
    std::vector<PlannedRun> runs;
    for (const auto& run : j.at("runs")) {
      runs.push_back({run.at("id"), run.at("kind"), run.at("settings"), run.at("settings_sha256")});
    }
    return runs;
  } catch (const nlohmann::json::exception& error) {
    throw UserError(file.string() + ": " + error.what());
  }
}

PlannedRun find_run(const std::vector<PlannedRun>& runs, const std::string& id) {
  for (const PlannedRun& run : runs) {
    if (run.id == id) return run;
  }
  throw UserError("no run " + id + " among the " + std::to_string(runs.size()) +
                  " of this campaign");
}

}  // namespace hoof::tools
