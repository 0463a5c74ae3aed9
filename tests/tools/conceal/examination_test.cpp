// Having a program answer a batch: what it is called with, the time, what is skipped and what
// fails.

#include "tools/conceal/examination.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tests;
using namespace hoof::tools;
using namespace hoof::tools::conceal;

namespace fs = std::filesystem;

namespace {

/// Two cases, the second with a data set beside it, and a program that writes down its words.
struct Bench {
  ScratchFolder scratch;
  ExaminationOptions options;

  explicit Bench(const std::string& script) {
    for (const char* name : {"case_0001", "case_0002"}) {
      fs::create_directories(scratch.path() / "batch" / name);
      write_file(scratch.path() / "batch" / name / "dataset.toml", "format = 1\n");
    }
    write_file(scratch.path() / "batch/case_0002/rigid.toml", "format = 1\n");
    const fs::path program = scratch.path() / "program";
    write_file(program, "#!/bin/sh\n" + script);
    fs::permissions(program, fs::perms::owner_all);
    options.batch = scratch.path() / "batch";
    options.answers = scratch.path() / "answers";
    options.program = program.string();
    options.quiet = true;
  }

  std::string answer(const char* name, const char* file) const {
    return read_file(options.answers / name / file);
  }
};

/// Answers in the folder after --out, with what it was called with.
const std::string kAnswers =
    "words=\"$*\"\nwhile [ \"$1\" != --out ]; do shift; done\n"
    "echo \"$words\" > \"$2/verdict.json\"\necho said\n";

}  // namespace

TEST_CASE("each case is diagnosed once, with the data sets beside it, and timed") {
  Bench bench(kAnswers);
  bench.options.jobs = 2;
  examine(bench.options);
  const std::string batch = bench.options.batch.string(), out = bench.options.answers.string();
  CHECK(bench.answer("case_0001", "verdict.json") ==
        "diagnose " + batch + "/case_0001/dataset.toml --out " + out + "/case_0001\n");
  CHECK(bench.answer("case_0002", "verdict.json") ==
        "diagnose " + batch + "/case_0002/dataset.toml " + batch + "/case_0002/rigid.toml --out " +
            out + "/case_0002\n");
  CHECK(bench.answer("case_0001", "log.txt") == "said\n");
  CHECK(std::stod(bench.answer("case_0001", "seconds.txt")) > 0.0);
  write_file(bench.options.answers / "case_0001" / "verdict.json", "kept");
  examine(bench.options);
  CHECK(bench.answer("case_0001", "verdict.json") == "kept");
}

TEST_CASE("one case alone") {
  Bench bench(kAnswers);
  bench.options.only = "case_0002";
  examine(bench.options);
  CHECK(fs::exists(bench.options.answers / "case_0002"));
  CHECK_FALSE(fs::exists(bench.options.answers / "case_0001"));
  bench.options.only = "case_0009";
  CHECK_THROWS_AS(examine(bench.options), UserError);
}

TEST_CASE("a program that fails is named with its case and asked again next time") {
  Bench bench("echo no; exit 3\n");
  CHECK_THROWS_WITH(examine(bench.options), Catch::Contains("case_0001, case_0002"));
  CHECK_FALSE(fs::exists(bench.options.answers / "case_0001" / "seconds.txt"));
  bench.options.program = (bench.scratch.path() / "nowhere").string();
  CHECK_THROWS_AS(examine(bench.options), UserError);
}
