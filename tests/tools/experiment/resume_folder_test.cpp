#include "tools/experiment/resume_folder.h"

#include <catch2/catch.hpp>

#include "sim/terrain/checkpoint_file.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/run_folder.h"

using namespace hoof::tools;
using hoof::tests::ScratchFolder;
namespace fs = std::filesystem;

namespace {

constexpr char kSettings[] = "a = 1\n";

/// A run of this name that was cut off after its first checkpoint.
void cut_off(const fs::path& run) {
  const auto folder = ResumeFolder::begin(run, "sinkage", kSettings, false);
  REQUIRE(folder);
  hoof::sim::CheckpointFiles(folder->path(), folder->key()).write(1, 0.001, "grains");
}

}  // namespace

TEST_CASE("a run that was cut off is found again with its settings") {
  const ScratchFolder scratch;
  const fs::path run = scratch.path() / "run.1";
  cut_off(run);
  for (const fs::path& name :
       {run, fs::path(run.string() + ".resume"), fs::path(run.string() + ".resume/")}) {
    CAPTURE(name);
    const auto folder = ResumeFolder::open(name, "sinkage");
    CHECK(folder->path() == resume_path(run));
    CHECK(folder->run_path() == run);
    CHECK(folder->settings_toml() == kSettings);
    CHECK(folder->has_checkpoint());
  }
  ResumeFolder::open(run, "sinkage")->remove();
  CHECK(fs::is_empty(scratch.path()));
}

TEST_CASE("the key tells settings apart") {
  const ScratchFolder scratch;
  const auto one = ResumeFolder::begin(scratch.path() / "1", "sinkage", "a = 1\n", false),
             same = ResumeFolder::begin(scratch.path() / "2", "sinkage", "a = 1\n", false),
             other = ResumeFolder::begin(scratch.path() / "3", "sinkage", "a = 2\n", false);
  CHECK(one->key() == same->key());
  CHECK(one->key() != other->key());
}

TEST_CASE("without a checkpoint there is nothing to keep") {
  const ScratchFolder scratch;
  { const auto folder = ResumeFolder::begin(scratch.path() / "run", "sinkage", kSettings, false); }
  CHECK(fs::is_empty(scratch.path()));
  // One left by a killed process: taken over by a new run, kept while it is resumed.
  fs::create_directory(scratch.path() / "run.resume");
  write_file(scratch.path() / "run.resume/identity.json", "{}");
  CHECK(ResumeFolder::begin(scratch.path() / "run", "sinkage", "b = 2\n", false)->settings_toml() ==
        "b = 2\n");
  CHECK(fs::is_empty(scratch.path()));
}

TEST_CASE("a new run of the name of one that can be resumed says how, or discards it by force") {
  const ScratchFolder scratch;
  const fs::path run = scratch.path() / "run";
  cut_off(run);
  CHECK_THROWS_WITH(ResumeFolder::begin(run, "traction", "b = 2\n", false),
                    "--out " + run.string() +
                        ": a run of this name was not finished; to finish it: " +
                        "hoof sinkage --resume " + run.string() + ".resume (--force discards it)");
  CHECK(ResumeFolder::open(run, "sinkage")->settings_toml() == kSettings);
  const auto anew = ResumeFolder::begin(run, "traction", "b = 2\n", true);
  CHECK(anew->settings_toml() == "b = 2\n");
  CHECK_FALSE(anew->has_checkpoint());
}

TEST_CASE("one process at a time") {
  const ScratchFolder scratch;
  const fs::path run = scratch.path() / "run";
  const auto folder = ResumeFolder::begin(run, "sinkage", kSettings, false);
  CHECK_FALSE(ResumeFolder::begin(run, "sinkage", kSettings, true));
  CHECK_THROWS_WITH(ResumeFolder::open(run, "sinkage"),
                    Catch::EndsWith("another process is working on this run"));
  CHECK(folder->settings_toml() == kSettings);
}

TEST_CASE("what cannot be resumed is told why") {
  const ScratchFolder scratch;
  const fs::path run = scratch.path() / "run", folder = scratch.path() / "run.resume";
  CHECK_THROWS_WITH(ResumeFolder::open(run, "sinkage"),
                    "--resume " + run.string() + ": there is no folder " + folder.string());
  cut_off(run);
  CHECK_THROWS_WITH(ResumeFolder::open(run, "traction"),
                    Catch::EndsWith("is a sinkage run; hoof sinkage --resume " + run.string()));
  write_file(folder / "identity.json",
             R"({"experiment": "sinkage", "program_sha256": "0", "code": "v1"})");
  CHECK_THROWS_WITH(ResumeFolder::open(run, "sinkage"),
                    Catch::Contains("was begun by another build of hoof (v1, this one is "));
  write_file(folder / "identity.json", "{\"exper");
  CHECK_THROWS_WITH(ResumeFolder::open(run, "sinkage"),
                    Catch::Contains("does not say who wrote it"));
}

TEST_CASE("somebody else's folder of that name is left alone") {
  const ScratchFolder scratch;
  fs::create_directory(scratch.path() / "run.resume");
  write_file(scratch.path() / "run.resume/letter.txt", "Dear");
  for (const bool force : {false, true}) {
    CHECK_THROWS_AS(ResumeFolder::begin(scratch.path() / "run", "sinkage", kSettings, force),
                    UserError);
  }
  CHECK(read_file(scratch.path() / "run.resume/letter.txt") == "Dear");
}
