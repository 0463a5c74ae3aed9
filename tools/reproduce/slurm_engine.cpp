#include "tools/reproduce/slurm_engine.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "tools/reproduce/slurm_queue.h"
#include "tools/reproduce/worker.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"
#include "tools/run/sha256.h"
#include "tools/run/stop_request.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

/// Slurm's default MaxArraySize is 1001, one more than the largest array.
constexpr std::size_t kMostTasks = 1000;
/// Of one call, for a run whose jobs vanish: nodes do get lost, but not for ever.
constexpr int kMostTries = 3;

/// A job that was submitted, or was about to be: written before sbatch is called.
struct Submission {
  std::string name;
  std::string job;  // number; empty where it is not known
  std::vector<std::string> ids;
  bool beds = false;
};

class Submissions {
 public:
  explicit Submissions(const fs::path& campaign) : folder_(fs::absolute(campaign) / "slurm") {
    fs::create_directories(folder_ / "log");
    if (!fs::exists(file())) return;
    const auto j = nlohmann::json::parse(read_file(file()), nullptr, false);
    if (!j.is_array()) throw UserError(file().string() + ": is no list of submissions");
    for (const auto& s : j) {
      all_.push_back({s.at("name"), s.at("job"), s.at("runs"), s.at("beds")});
    }
  }

  std::vector<Submission>& all() { return all_; }
  const fs::path& folder() const { return folder_; }

  void write() const {
    auto j = nlohmann::ordered_json::array();
    for (const Submission& s : all_) {
      j.push_back({{"name", s.name}, {"job", s.job}, {"beds", s.beds}, {"runs", s.ids}});
    }
    fs::path partial = file();
    partial += ".partial";
    write_result_json(partial, j);
    fs::rename(partial, file());
  }

 private:
  fs::path file() const { return folder_ / "submissions.json"; }

  fs::path folder_;
  std::vector<Submission> all_;
};

std::string quoted(const std::string& text) {
  std::string all = "'";
  for (const char c : text) all += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return all + "'";
}

/// Never given twice, whatever numbers the controller gives.
std::string new_name(const fs::path& folder) {
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  return "hoof-" +
         sha256_hex(folder.string() + " " + std::to_string(now) + " " + std::to_string(getpid()))
             .substr(0, 12);
}

/// hoof takes the place of the shell: signals of the batch system reach it.
std::string script(const Submission& s, const fs::path& campaign, const fs::path& list,
                   const SlurmSettings& settings) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  const fs::path log = list.parent_path() / "log" / (s.name + "-%a.txt");
  std::string text = "#!/bin/bash\n#SBATCH --job-name=" + s.name + "\n";
  text += "#SBATCH --array=0-" + std::to_string(s.ids.size() - 1);
  if (settings.at_once > 0) text += "%" + std::to_string(settings.at_once);
  text += "\n#SBATCH --cpus-per-task=" + std::to_string(settings.threads) + "\n";
  if (!settings.time.empty()) text += "#SBATCH --time=" + settings.time + "\n";
  text += "#SBATCH --signal=B:USR1@" + std::to_string(settings.stop_ahead_s) + "\n";
  text += "#SBATCH --open-mode=append\n";
  text += "run=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" " + quoted(list.string()) + ")\n";
  text += "exec >>" + quoted(log.parent_path().string()) + "/\"$run\".txt 2>&1\n";
  text += "exec " + quoted(program) + " campaign run " + quoted(fs::absolute(campaign).string()) +
          " \"$run\" --quiet" + (s.beds ? " --bed-only" : "") + "\n";
  return text;
}

/// @param after a job to wait for, however it ends; empty: none
std::string send(Submissions& submissions, const fs::path& campaign, std::vector<std::string> ids,
                 bool beds, const std::string& after, const SlurmSettings& settings) {
  Submission s{new_name(submissions.folder()), "", std::move(ids), beds};
  const fs::path list = submissions.folder() / (s.name + ".txt");
  const fs::path file = submissions.folder() / (s.name + ".sh");
  std::string lines;
  for (const std::string& id : s.ids) lines += id + "\n";
  write_file(list, lines);
  write_file(file, script(s, campaign, list, settings));
  submissions.all().push_back(s);
  submissions.write();
  std::vector<std::string> options = {"--output=/dev/null"};
  options.insert(options.end(), settings.options.begin(), settings.options.end());
  if (!after.empty()) options.push_back("--dependency=afterany:" + after);
  submissions.all().back().job = submit(file, options);
  submissions.write();
  return submissions.all().back().job;
}

/// Runs that are in the queue, by the name of their job and their place in its array. Submissions
/// that have left it are forgotten; tasks that would wait for ever are cancelled.
std::set<std::string> in_queue(Submissions& submissions) {
  std::vector<std::string> names;
  for (const Submission& s : submissions.all()) names.push_back(s.name);
  std::set<std::string> ids, alive;
  for (const QueuedTask& task : queued_tasks(names)) {
    if (task.stuck()) {
      cancel(task.job);
      continue;
    }
    for (const Submission& s : submissions.all()) {
      if (s.name != task.name || std::size_t(task.index) >= s.ids.size()) continue;
      alive.insert(s.name);
      if (!s.beds) ids.insert(s.ids[std::size_t(task.index)]);
    }
  }
  const std::size_t before = submissions.all().size();
  std::erase_if(submissions.all(), [&](const Submission& s) {
    if (alive.count(s.name) > 0) return false;
    std::error_code ignored;  // nobody reads them any more
    fs::remove(submissions.folder() / (s.name + ".txt"), ignored);
    fs::remove(submissions.folder() / (s.name + ".sh"), ignored);
    return true;
  });
  if (submissions.all().size() != before) submissions.write();
  return ids;
}

/// One run for each bed that is needed and not there.
std::vector<std::string> bed_makers(const std::vector<PlannedRun>& runs) {
  std::set<fs::path> beds;
  std::vector<std::string> ids;
  for (const PlannedRun& run : runs) {
    const BedPlace bed = bed_place(run);
    if (bed.file.empty() || bed.there || !beds.insert(bed.file).second) continue;
    ids.push_back(run.id);
  }
  return ids;
}

}  // namespace

SlurmState SlurmEngine::reconcile(const RunStore& store, const std::vector<PlannedRun>& missing) {
  Submissions submissions(store.folder());
  const std::set<std::string> queued = in_queue(submissions);
  SlurmState state;
  std::vector<PlannedRun> lost;
  for (const PlannedRun& run : missing) {
    if (queued.count(run.id) > 0) {
      ++state.queued;
      continue;
    }
    if (store.lock(run.id)->taken()) {
      ++state.outside;
      continue;
    }
    const auto attempt = store.attempt(run.id);
    const std::string how = attempt ? attempt->state : "";
    const int tries = tries_[run.id];
    if (tries > 0 && how == "failed") {
      state.failed.push_back(run.id + ": " + attempt->why);
      continue;
    }
    if (tries >= kMostTries) {
      state.failed.push_back(run.id + ": its job ended " + std::to_string(tries) +
                             " times without an account; logs: " +
                             (store.folder() / "slurm" / "log" / (run.id + ".txt")).string());
      continue;
    }
    // Stopped at a time limit it has a checkpoint: that is progress, and no try.
    if (how == "stopped") {
      tries_[run.id] = 1;
    } else {
      ++tries_[run.id];
    }
    lost.push_back(run);
  }
  if (lost.empty()) return state;
  std::string beds;
  if (const auto makers = bed_makers(lost); !makers.empty()) {
    beds = send(submissions, store.folder(), makers, true, "", settings_);
  }
  for (std::size_t from = 0; from < lost.size(); from += kMostTasks) {
    std::vector<std::string> ids;
    for (std::size_t i = from; i < std::min(lost.size(), from + kMostTasks); ++i) {
      ids.push_back(lost[i].id);
    }
    send(submissions, store.folder(), ids, false, beds, settings_);
  }
  state.submitted = lost.size();
  state.queued += lost.size();
  return state;
}

SlurmState SlurmEngine::wait(const RunStore& store,
                             const std::function<std::vector<PlannedRun>()>& look) {
  const StopRequest stop;
  for (;;) {
    SlurmState state = reconcile(store, look());
    if (state.queued == 0 && state.outside == 0) return state;
    const auto until =
        std::chrono::steady_clock::now() + std::chrono::duration<double>(settings_.poll_s);
    while (std::chrono::steady_clock::now() < until) {
      if (stop.requested()) {
        throw Interrupted(
            "stopped waiting; jobs go on, and the same command looks again what became of them",
            stop.exit_status());
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
}

}  // namespace hoof::tools
