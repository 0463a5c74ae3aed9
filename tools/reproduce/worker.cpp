#include "tools/reproduce/worker.h"

#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "tools/bed/make_bed.h"
#include "tools/experiment/run_settings.h"
#include "tools/reproduce/manifest.h"
#include "tools/run/errors.h"
#include "tools/run/stop_request.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

/// Whoever started this was killed: nobody would know of it.
void end_with(int parent) {
  if (parent == 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) std::_Exit(EXIT_FAILURE);  // it went before the line above
}

std::string where() {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  std::string text = std::string(host) + ", process " + std::to_string(getpid());
  const char* array = std::getenv("SLURM_ARRAY_JOB_ID");
  const char* task = std::getenv("SLURM_ARRAY_TASK_ID");
  if (array != nullptr && task != nullptr) {
    text += ", job " + std::string(array) + "_" + task;
  }
  return text;
}

ChosenBed bed_of(const PlannedRun& run) {
  const RunSettings settings = read_run_settings(run.kind, run.settings);
  return kept_bed(settings.bed, settings.materials, settings.seed, settings.threads);
}

/// By this process, or by another while this one waits for it.
void need_bed(const RunStore& store, const PlannedRun& run, bool quiet) {
  const BedPlace place = bed_place(run);
  if (place.file.empty() || place.there) return;
  bool told = quiet;
  for (;;) {
    const auto lock = store.lock(place.file.filename().string());
    if (fs::exists(place.file)) return;
    if (!lock->taken()) {
      MakeBedOptions options;
      options.quiet = quiet;
      make_bed(bed_of(run), options);
      return;
    }
    if (!told) std::cerr << "hoof: another process is making the bed; waiting for it\n";
    told = true;
    const StopRequest stop;
    for (int i = 0; i < 10 && !stop.requested(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    if (stop.requested()) {
      throw Interrupted("stopped while another process was making the bed", stop.exit_status());
    }
  }
}

}  // namespace

BedPlace bed_place(const PlannedRun& run) {
  if (!read_run_settings(run.kind, run.settings).on_grains()) return {};
  const fs::path file = bed_of(run).file;
  return {file, fs::exists(file)};
}

namespace {

/// Whoever calls holds the run's lock.
std::string make_noted(const RunStore& store, const PlannedRun& run, bool quiet) {
  Attempt attempt = store.attempt(run.id).value_or(Attempt{});
  attempt = {"running", "", where(), attempt.tries + 1};
  store.note_attempt(run.id, attempt);
  const auto note = [&](const std::string& state, const std::string& why) {
    attempt.state = state, attempt.why = why;
    store.note_attempt(run.id, attempt);
  };
  std::string why_not;
  try {
    need_bed(store, run, quiet);
    if (!store.make(run, quiet, why_not)) {
      note("failed", why_not);
      return why_not;
    }
  } catch (const Interrupted& error) {
    note("stopped", error.what());
    throw;
  } catch (const std::exception& error) {
    note("failed", error.what());
    throw;
  }
  note("done", "");
  return "";
}

}  // namespace

std::string make_once(const RunStore& store, const PlannedRun& run, bool quiet) {
  auto lock = store.lock(run.id);
  // Whoever looks whether a run is under way holds its lock for a moment.
  for (int i = 0; i < 20 && lock->taken(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    lock = store.lock(run.id);
  }
  if (lock->taken()) return kHeldByAnother;
  if (store.done(run)) {
    store.seal_if_open(run);
    return "";
  }
  return make_noted(store, run, quiet);
}

void work(const WorkerOptions& options) {
  end_with(options.parent);
  const PlannedRun run = find_run(read_manifest(options.campaign), options.id);
  const RunStore store(options.campaign);
  if (options.bed_only) {
    need_bed(store, run, options.quiet);
    return;
  }
  const std::string why_not = make_once(store, run, options.quiet);
  if (why_not == kHeldByAnother) {
    std::cerr << "hoof: " << run.id << ": " << why_not << "; left to that one\n";
    return;
  }
  if (!why_not.empty()) throw CannotFinish(run.id + ": " + why_not);
}

}  // namespace hoof::tools
