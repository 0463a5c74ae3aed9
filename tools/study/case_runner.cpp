#include "tools/study/case_runner.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <set>

#include "sim/terrain/bed_file.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

constexpr double kSolidShare = 0.6;  // for estimates of the work only
/// Made beds of 100 and 200 mm took 0.22 to 0.30 s of their own time.
constexpr double kSettling_s = 0.25;

double grains(const PressCase& c) {
  return double(sim::grains_to_pour(c.bed, kSolidShare));
}

double bed_work(const PressCase& c) {
  return grains(c) * kSettling_s / c.bed.settling_step_s();
}

double press_work(const PressCase& c) {
  return grains(c) * c.steps();
}

}  // namespace

struct CaseRunner::Plan {
  ProgressLine progress;
  double total = 0, done = 0;

  void show(double share_of, double work, const std::string& what) {
    progress.update(total > 0 ? (done + share_of * work) / total : 1, what);
  }
};

CaseRunner::CaseRunner(std::filesystem::path folder, std::filesystem::path beds,
                       sim::Materials materials, int threads, ProgressStyle style)
    : folder_(std::move(folder)),
      store_(std::move(beds)),
      materials_(std::move(materials)),
      threads_(threads),
      style_(style) {
  std::error_code error;
  std::filesystem::create_directories(folder_ / "cases", error);
  if (error) throw UserError((folder_ / "cases").string() + ": " + error.message());
}

std::filesystem::path CaseRunner::file(const PressCase& c) const {
  const std::string key = c.key(materials_);
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(sim::fnv1a(key.data(), key.size())));
  std::string name = c.name();
  std::replace(name.begin(), name.end(), ' ', '_');
  return folder_ / "cases" / (name + "-" + hash + ".csv");
}

std::vector<PressCurve> CaseRunner::run(const std::string& label,
                                        const std::vector<PressCase>& cases) {
  Plan plan{ProgressLine(label, style_, std::cerr)};
  std::set<std::filesystem::path> beds;
  for (const PressCase& c : cases) {
    if (std::filesystem::exists(file(c))) continue;
    plan.total += press_work(c);
    const auto bed = store_.file(c.bed, materials_, c.seed);
    if (!std::filesystem::exists(bed) && beds.insert(bed).second) plan.total += bed_work(c);
  }
  std::vector<PressCurve> curves;
  for (const PressCase& c : cases) {
    const std::filesystem::path kept = file(c);
    if (!std::filesystem::exists(kept)) write_curve(kept, run_one(c, plan));
    curves.push_back(read_curve(kept));
  }
  plan.progress.finish();
  return curves;
}

PressCurve CaseRunner::run_one(const PressCase& c, Plan& plan) {
  const auto watch = [&](double work, const std::string& what) {
    return [&plan, this, work, what](double share) {
      plan.show(share, work, what);
      return !stop_.requested();
    };
  };
  try {
    const sim::StoredBed bed = store_.get(c.bed, materials_, c.seed, threads_,
                                          watch(bed_work(c), "settling for " + c.name()));
    if (bed.made) plan.done += bed_work(c);
    if (!bed.discarded.empty()) std::cerr << "hoof: " << bed.discarded << "; made anew\n";
    const PressCurve curve =
        press(c, materials_, bed.state, threads_, watch(press_work(c), c.name()));
    plan.done += press_work(c);
    return curve;
  } catch (const std::runtime_error& e) {
    plan.progress.finish();
    if (stop_.requested()) stop();
    throw CannotFinish(c.name() + ": " + e.what());
  }
}

void CaseRunner::stop() const {
  throw Interrupted("stopped; finished cases are kept in " + (folder_ / "cases").string() +
                        " and the same command goes on from there",
                    stop_.exit_status());
}

}  // namespace hoof::tools
