#include "tools/reproduce/status.h"

#include <algorithm>

#include "tools/reproduce/cost.h"
#include "tools/reproduce/manifest.h"

namespace hoof::tools {
namespace {

struct Counts {
  std::vector<PlannedRun> missing;
  std::vector<std::string> under_way, failed, stopped;  // lines
  std::size_t done = 0;
};

Counts count(const RunStore& store, const std::vector<PlannedRun>& runs) {
  Counts counts;
  for (const PlannedRun& run : runs) {
    if (store.done(run)) {
      ++counts.done;
      continue;
    }
    counts.missing.push_back(run);
    const Attempt attempt = store.attempt(run.id).value_or(Attempt{});
    if (attempt.state == "running") {
      // Its maker holds the lock; one that was killed does not, and the run is simply missing.
      if (store.lock(run.id)->taken()) counts.under_way.push_back(run.id + ": " + attempt.where);
    } else if (attempt.state == "failed") {
      counts.failed.push_back(run.id + ": " + attempt.why);
    } else if (attempt.state == "stopped") {
      counts.stopped.push_back(run.id);
    }
  }
  return counts;
}

}  // namespace

std::string campaign_status(const std::filesystem::path& folder) {
  const std::vector<PlannedRun> runs = read_manifest(folder);
  const RunStore store(folder);
  const Counts counts = count(store, runs);
  std::string text = std::to_string(counts.done) + " of " + std::to_string(runs.size()) +
                     " runs done, " + std::to_string(counts.under_way.size()) + " under way, " +
                     std::to_string(counts.stopped.size()) + " stopped, " +
                     std::to_string(counts.failed.size()) + " failed\n";
  for (const std::string& line : counts.under_way) text += "under way  " + line + "\n";
  for (const std::string& line : counts.stopped) text += "stopped    " + line + "\n";
  for (const std::string& line : counts.failed) text += "failed     " + line + "\n";
  if (counts.missing.empty()) return text;
  const int at_once = int(std::max<std::size_t>(1, counts.under_way.size()));
  return text + cost_text(CostModel(store, runs), counts.missing, at_once, 1);
}

}  // namespace hoof::tools
