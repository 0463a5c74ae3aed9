#include "tools/reproduce/campaign.h"

#include <algorithm>
#include <set>
#include <thread>

#include "sim/config/config_error.h"
#include "tools/experiment/run_settings.h"
#include "tools/reproduce/manifest.h"
#include "tools/run/errors.h"

namespace hoof::tools {

int Engine::threads_each(int cores) const {
  if (threads) return *threads;
  return std::max(1, jobs ? cores / *jobs : 1);
}

int Engine::jobs_at_once(int cores) const {
  return jobs ? *jobs : std::max(1, cores / threads_each(cores));
}

Campaign::Campaign(const std::filesystem::path& folder, std::vector<Cell> cells,
                   const CampaignSettings& settings, const std::vector<Cell>& others)
    : cells_(std::move(cells)), store_(folder), lock_(folder) {
  if (lock_.taken()) {
    throw UserError("--out " + folder.string() + ": another process is working on this campaign");
  }
  const auto plan = [&](const Cell& cell) {
    return planned_run(cell.id(), cell.kind(), settings.of(cell));
  };
  for (const Cell& cell : cells_) planned_[cell.id()] = plan(cell);
  for (const Cell& cell : others) {
    if (planned_.count(cell.id()) == 1 || !std::filesystem::exists(store_.place(cell.id())))
      continue;
    PlannedRun run;
    try {
      run = plan(cell);
    } catch (const sim::ConfigError&) {
      continue;  // what is asked of the others, as a traction's cycles, is no setting of this one
    }
    if (!store_.has(run)) continue;
    planned_[cell.id()] = run;
    others_.push_back(cell);
  }
}

CampaignEnd Campaign::run(const Engine& engine, const std::function<void()>& after) {
  const auto look = [&] {
    std::vector<PlannedRun> missing;
    for (const Cell& cell : cells_) {
      if (!done(cell)) {
        missing.push_back(planned(cell));
      } else {
        store_.seal_if_open(planned(cell));
      }
    }
    return missing;
  };
  const int cores = int(std::max(1U, std::thread::hardware_concurrency()));
  // Of no consequence for a result, so it is no part of a cell.
  const int threads = engine.slurm ? engine.cluster.threads : engine.threads_each(cores);
  std::vector<PlannedRun> all;
  for (const Cell& cell : cells_) {
    PlannedRun& run = planned_.at(cell.id());
    run.settings.push_back("experiment.threads=" + std::to_string(threads));
    all.push_back(run);
  }
  write_manifest(folder(), all);
  const std::vector<PlannedRun> missing = look();
  CampaignEnd end;
  if (!engine.slurm) {
    const LocalEngine local{engine.jobs_at_once(cores), engine.quiet};
    end.failed = local.run(store_, missing, [&](const std::string&) { after(); });
    return end;
  }
  SlurmEngine slurm(engine.cluster);
  SlurmState state;
  if (engine.cluster.wait) {
    std::size_t left = missing.size();
    state = slurm.wait(store_, [&] {
      std::vector<PlannedRun> now = look();
      if (now.size() < left) after();
      left = now.size();
      return now;
    });
  } else {
    state = slurm.reconcile(store_, missing);
  }
  end.failed = state.failed;
  end.queued = state.queued + state.outside;
  return end;
}

Outcomes Campaign::outcomes(const std::string& variation) const {
  Outcomes outcomes;
  const auto read = [&](const Cell& cell) {
    const std::string id = cell.id();
    if (read_.count(id) == 0) read_[id] = read_outcome(cell.traction, store_.place(id));
    outcomes[cell.condition()][cell.bed] = read_[id];
  };
  for (const Cell& cell : cells_) {
    if (cell.variation == variation && done(cell)) read(cell);
  }
  for (const Cell& cell : others_) {
    if (cell.variation == variation) read(cell);
  }
  return outcomes;
}

std::vector<std::pair<std::string, std::string>> Campaign::geometry_hashes() const {
  std::vector<std::pair<std::string, std::string>> hashes;
  for (const Cell& cell : cells_) {
    if (!cell.variation.empty()) continue;
    const bool known = std::any_of(hashes.begin(), hashes.end(),
                                   [&](const auto& hash) { return hash.first == cell.foot; });
    if (known) continue;
    const PlannedRun& run = planned(cell);
    hashes.emplace_back(cell.foot, geometry_hash(read_run_settings(run.kind, run.settings).tree));
  }
  return hashes;
}

std::vector<std::string> Campaign::codes() const {
  std::set<std::string> codes;
  for (const Cell& cell : cells_) {
    if (done(cell)) codes.insert(store_.code(cell.id()));
  }
  return {codes.begin(), codes.end()};
}

}  // namespace hoof::tools
