// A batch: the same bytes for the same seed, sealed, and nothing in a case that gives it away.

#include "tools/conceal/make.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/tools/run/scratch_folder.h"
#include "tools/conceal/servo_case.h"
#include "tools/conceal/servo_sizes.h"
#include "tools/conceal/truth.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/sha256.h"

using namespace hoof::tests;
using namespace hoof::tools;
using namespace hoof::tools::conceal;

namespace fs = std::filesystem;

namespace {

MakeOptions batch(const fs::path& out, std::uint64_t seed, const char* rig, int count,
                  int threads) {
  MakeOptions options;
  options.seed = seed;
  options.count = count;
  options.rig = rig;
  options.out = out;
  options.threads = threads;
  options.quiet = true;
  return options;
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
    }
  }
  return files;
}

}  // namespace

TEST_CASE("the same seed gives the same bytes for any number of threads, another seed others") {
  const ScratchFolder scratch;
  const auto path = [&scratch](const char* name) { return scratch.path() / name; };
  make(batch(path("a"), 4, "servo_pendulum", 2, 1));
  make(batch(path("b"), 4, "servo_pendulum", 2, 3));
  const auto a = files_of(path("a"));
  CHECK(a.size() >= 12);
  CHECK(a == files_of(path("b")));
  make(batch(path("c"), 4, "plate_sand", 6, 2));
  make(batch(path("d"), 4, "plate_sand", 6, 1));
  make(batch(path("e"), 5, "plate_sand", 6, 1));
  CHECK(files_of(path("c")) == files_of(path("d")));
  CHECK(files_of(path("c")).at("truth.sha256") != files_of(path("e")).at("truth.sha256"));
}

TEST_CASE("the seal is the SHA-256 of the truth, and a truth that was touched is not read") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "sealed", truth = scratch.path() / "kept.json";
  MakeOptions options = batch(out, 8, "plate_sand", 10, 1);
  options.truth = truth;
  make(options);
  CHECK_FALSE(fs::exists(out / "truth.json"));
  CHECK(read_file(out / "truth.sha256") == sha256_hex_of_file(truth) + "  kept.json\n");
  CHECK(read_truth(truth, out / "truth.sha256").size() == 10);
  std::string text = read_file(truth);
  text.replace(text.find("false"), 5, "true ");
  write_file(truth, text);
  CHECK_THROWS_AS(read_truth(truth, out / "truth.sha256"), UserError);
  CHECK_THROWS_AS(make(options), UserError);  // a batch is there already
}

TEST_CASE("nothing in a case names what is hidden, and every case can be told by its truth") {
  const ScratchFolder scratch;
  make(batch(scratch.path() / "sealed", 21, "plate_sand", 14, 1));
  std::vector<std::string> words = {"one", "pair", "unknown_", "decid", "hidden", "#"};
  for (const std::string& name : listed_servo_effects()) words.push_back(name);
  for (const TruthCase& c :
       read_truth(scratch.path() / "sealed/truth.json", scratch.path() / "sealed/truth.sha256")) {
    for (const HiddenEffect& effect : c.effects) words.push_back(effect.name);
    for (const auto& [file, text] : files_of(scratch.path() / "sealed" / c.name)) {
      for (const std::string& word : words) {
        CAPTURE(c.name, file, word);
        CHECK(text.find(word) == std::string::npos);
      }
    }
    CHECK(c.effects.empty() == c.nothing_hidden());
    CHECK(c.holdout_rmse.at("force_rmse") > 0.0);
  }
}

TEST_CASE("a servo case: something is hidden, it is seen, the truth predicts to the noise") {
  CaseRequest request;
  request.kind = "one";
  request.effects = {"stribeck_friction"};
  request.stiff = true;
  const CaseData data = make_servo_case("case_0001", request, RandomStream(17));
  CHECK(data.truth.at("strength").get<double>() >= 15.0);
  CHECK(data.recordings.size() >= 4);
  const auto held_out = std::count_if(data.recordings.begin(), data.recordings.end(),
                                      [](const auto& r) { return r.holdout; });
  CHECK(held_out >= 1);
  CHECK(held_out <= 2);
  CHECK(data.truth.at("law") == "impedance");
  for (const auto& [channel, change] : data.truth.at("channels").items()) {
    CHECK(change.at("after_refit").get<double>() > 0.0);
    CHECK(data.truth.at("holdout_rmse").contains(channel + "_rmse"));
  }
  double covered_s = 0.0, whole_s = 0.0;
  for (const auto& i : data.truth.at("intervals")) {
    covered_s += i.at("end").get<double>() - i.at("start").get<double>();
  }
  for (const RecordingData& r : data.recordings) {
    if (!r.holdout) whole_s += r.channels[0].values.back() - r.channels[0].values.front();
  }
  CHECK(covered_s > 0.0);
  // The median halves the samples; gaps that are closed add a little.
  CHECK(covered_s < 0.6 * whole_s);
}
