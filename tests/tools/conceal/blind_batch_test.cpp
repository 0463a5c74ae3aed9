// The tool before its examiner, in small: plants drawn, diagnosed by the program and graded. Six
// cases are too few for shares: this holds that the whole way works and every case is answered.
// Shares are those of tools/conceal/README.md, from a batch that takes longer.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/tools/report/browser.h"

using namespace hoof::tests;
namespace fs = std::filesystem;

TEST_CASE("a small blind batch is drawn, answered and graded") {
  const fs::path root =
      fs::temp_directory_path() / ("hoof-blind-batch-" + std::to_string(getpid()));
  fs::remove_all(root);
  fs::create_directories(root);
  const std::string program = HOOF_PROGRAM, batch = (root / "batch").string(),
                    answers = (root / "answers").string();
  const auto hoof = [&](const std::string& arguments) {
    return run_shell(program + " " + arguments + " 2>&1");
  };
  const ShellOutcome made = hoof("conceal make --seed 2026 --count 6 --quiet --out " + batch);
  INFO(made.output);
  REQUIRE(made.status == 0);
  const ShellOutcome ran =
      hoof("conceal run " + batch + " --quiet --answers " + answers + " --program " + program);
  INFO(ran.output);
  REQUIRE(ran.status == 0);
  const ShellOutcome graded = hoof("conceal grade " + batch + " " + answers);
  INFO(graded.output);
  CHECK(graded.status == 0);
  CHECK(graded.output.find("no answer") == std::string::npos);
  CHECK(graded.output.find("6 cases") != std::string::npos);
  fs::remove_all(root);
}
