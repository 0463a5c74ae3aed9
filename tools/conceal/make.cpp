#include "tools/conceal/make.h"

#include <atomic>
#include <cstdio>
#include <exception>
#include <iostream>
#include <mutex>
#include <thread>
#include <vector>

#include "tools/conceal/alike.h"
#include "tools/conceal/deck.h"
#include "tools/conceal/sand_case.h"
#include "tools/conceal/servo_case.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/progress_line.h"
#include "tools/run/sha256.h"
#include "tools/run/stop_request.h"

namespace hoof::tools::conceal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

CaseData make_case(const std::string& name, const DealtCase& dealt, const RandomStream& random) {
  if (dealt.request.kind == "not_decidable") return make_alike_case(name, dealt, random);
  if (dealt.rig == "plate_sand") return make_sand_case(name, dealt.request, random);
  return make_servo_case(name, dealt.request, random);
}

class Batch {
 public:
  explicit Batch(const MakeOptions& options)
      : options_(options),
        random_(options.seed),
        cases_(deal(options.count, options.rig, random_.branch(0))),
        truths_(cases_.size()),
        progress_("cases", choose_progress_style(options.quiet), std::cerr) {}

  void run() {
    std::vector<std::thread> threads;
    for (int i = 1; i < options_.threads; ++i) threads.emplace_back([this] { work(); });
    work();
    for (std::thread& t : threads) t.join();
    progress_.finish();
    if (failure_) std::rethrow_exception(failure_);
    if (stop_.requested()) {
      throw Interrupted("stopped; a batch is made in one go: remove " + options_.out.string(),
                        stop_.exit_status());
    }
  }

  Json truth() const {
    Json truth = {{"format", 1}, {"seed", options_.seed}, {"count", options_.count}};
    truth["rig"] = options_.rig;
    truth["cases"] = Json::array();
    for (const Json& one : truths_) truth["cases"].push_back(one);
    return truth;
  }

 private:
  void work() {
    try {
      for (std::size_t i = next_++; i < cases_.size(); i = next_++) {
        if (stop_.requested() || failed_) return;
        const CaseData data = make_case(case_name(i), cases_[i], random_.branch(i + 1));
        write_case(options_.out / case_name(i), "dataset.toml", data);
        truths_[i] = {{"case", case_name(i)}};
        truths_[i].update(data.truth);
        const std::lock_guard lock(mutex_);
        ++done_;
        progress_.update(double(done_) / double(cases_.size()), case_name(i));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      failed_ = true;
    }
  }

  const MakeOptions& options_;
  RandomStream random_;
  std::vector<DealtCase> cases_;
  std::vector<Json> truths_;
  ProgressLine progress_;
  StopRequest stop_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::size_t done_ = 0;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

void require_new(const fs::path& out) {
  if (fs::exists(out) && !(fs::is_directory(out) && fs::is_empty(out))) {
    throw UserError(out.string() + ": is there already; a sealed batch goes into a new folder");
  }
}

}  // namespace

std::string case_name(std::size_t index) {
  char text[32];
  std::snprintf(text, sizeof text, "case_%04zu", index + 1);
  return text;
}

void make(const MakeOptions& options) {
  require_new(options.out);
  Batch batch(options);
  batch.run();
  const std::string text = batch.truth().dump(1) + "\n";
  const std::string hash = sha256_hex(text);
  const fs::path truth = options.truth.empty() ? options.out / "truth.json" : options.truth;
  write_file(options.out / "truth.sha256", hash + "  " + truth.filename().string() + "\n");
  write_file(truth, text);
  std::cout << options.count << " cases in " << options.out.string() << "\n"
            << "SHA-256 of the truth: " << hash << "\n"
            << "truth (not for whom it examines): " << truth.string() << "\n";
}

}  // namespace hoof::tools::conceal
