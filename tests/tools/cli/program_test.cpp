// Drives the program itself: exit statuses and what it prints.

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

#include "tests/tools/report/synthetic_run.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/run/output_file.h"

namespace {

struct Outcome {
  int status = 0;
  std::string text;
};

// `redirection` picks what is read: the default, standard error only.
Outcome hoof_program(const std::string& arguments,
                     const std::string& redirection = "2>&1 >/dev/null") {
  const std::string command = std::string(HOOF_PROGRAM) + " " + arguments + " " + redirection;
  std::FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  Outcome outcome;
  std::array<char, 4096> block;
  std::size_t count = 0;
  while ((count = std::fread(block.data(), 1, block.size(), pipe)) > 0) {
    outcome.text.append(block.data(), count);
  }
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

}  // namespace

TEST_CASE("bad input is one line on standard error and exit status 2") {
  const hoof::tests::ScratchFolder scratch;
  const std::string absent = (scratch.path() / "absent").string();
  struct Case {
    std::string arguments;
    const char* complaint;
  };
  const std::vector<Case> cases = {
      {"", "no command given; known are"},
      {"dance", "unknown command 'dance'; known are"},
      {"--loud", "--loud"},
      {"version --loud", "version: "},
      {"dbc --out " + absent + "/hoof.dbc", "hoof.dbc: cannot open: No such file"},
      {"command", "command: ORDER is required"},
      {"command ready", "command: --bus is required"},
      {"command dance --bus vcan0", "dance not in {"},
      {"command ready --bus vcan0 --toe 41", "--toe: Value 41 not in range"},
      {"command stop --bus vcan0 --toe 20", "--toe: only ready and run open the toes"},
      {"command ready --bus vcan0 --frequency 1", "--frequency: only run has one"},
      {"command run --bus vcan0", "--frequency: run needs one, e.g. --frequency 0.45"},
      {"command run --bus vcan0 --frequency 3", "--frequency: Value 3 not in range"},
      {"command stop --bus vcan0 --id 0", "--id: Value 0 not in range"},
      {"calibrate", "calibrate: A subcommand is required"},
      {"calibrate rolling --run 2", "--run = 2 mm, must be from 5 to 1000 mm"},
      {"calibrate rolling --mu-r 1.2",
       "rolling friction 1.2 holds a grain on an incline of 45 deg"},
      {"calibrate sliding --mu-s 9", "--mu-s: Value 9 not in range"},
      {"calibrate restitution --e 0", "--e: Value 0 not in range"},
      {"calibrate repose --grains 9", "--grains = 9, must be from 100 to 200000"},
      {"calibrate repose --material " + absent, "--material: File does not exist"},
      {"material", "material: A subcommand is required"},
      {"material show gravel", "gravel: no such card; there are"},
      {"material suggest --bulk-density 1.55 --repose 33",
       "--bulk-density = 1.55 kg/m3, must be from 300 to 5000 kg/m3"},
      {"report", "report: RUN_DIR is required"},
      {"report " + absent, "absent: is no run folder"},
      {"report " + scratch.path().string(), "result.json: cannot read: No such file"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.arguments);
    const Outcome outcome = hoof_program(c.arguments);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.text, Catch::StartsWith("hoof: ") && Catch::Contains(c.complaint));
    CHECK(std::count(outcome.text.begin(), outcome.text.end(), '\n') == 1);
  }
}

TEST_CASE("a bus that is not there is told with its cure, and is no fault of the flags") {
  for (const char* arguments : {"command stop --bus nocan7", "command estop --bus nocan7"}) {
    const Outcome outcome = hoof_program(arguments);
    CHECK(outcome.status == 3);
    // "no CAN in this kernel" or "no such interface", each with what to do about it.
    CHECK_THAT(outcome.text, Catch::StartsWith("hoof: nocan7: ") &&
                                 (Catch::Contains("with-vcan") || Catch::Contains("ip link add")));
    CHECK(std::count(outcome.text.begin(), outcome.text.end(), '\n') == 1);
  }
}

TEST_CASE("hoof dbc prints the dictionary, or writes it to a file") {
  const Outcome printed = hoof_program("dbc", "");
  CHECK(printed.status == 0);
  CHECK_THAT(printed.text, Catch::StartsWith("VERSION") && Catch::Contains("BO_ 33 ToeCommand: 8"));
  const hoof::tests::ScratchFolder scratch;
  const std::string file = (scratch.path() / "hoof.dbc").string();
  CHECK(hoof_program("dbc --out " + file, "").text.empty());
  CHECK(hoof::tools::read_file(file) == printed.text);
}

TEST_CASE("hoof trajectory ends with the status that its check gives") {
  const std::string data = std::string(HOOF_TEST_DATA_DIR) + "/trajectory/";
  CHECK(hoof_program("trajectory random --count 50 --seed 3", "").status == 0);
  CHECK(hoof_program("trajectory check " + data + "wrong_duration.csv", "").status == 1);
  CHECK(hoof_program("trajectory").status == 2);
}

TEST_CASE("every command has help with an example") {
  const Outcome overview = hoof_program("--help", "");
  CHECK(overview.status == 0);
  const std::size_t first = overview.text.find("Subcommands:\n");
  REQUIRE(first != std::string::npos);
  int commands = 0;
  std::size_t line = overview.text.find('\n', first) + 1;
  while (overview.text.compare(line, 2, "  ") == 0) {
    const std::string name =
        overview.text.substr(line + 2, overview.text.find(' ', line + 2) - line - 2);
    CAPTURE(name);
    const Outcome help = hoof_program(name + " --help", "");
    CHECK(help.status == 0);
    CHECK_THAT(help.text, Catch::Contains("Example") && Catch::Contains("  hoof " + name));
    line = overview.text.find('\n', line) + 1;
    ++commands;
  }
  CHECK(commands >= 2);
}

TEST_CASE("hoof version and hoof --version say what was built") {
  const Outcome command = hoof_program("version", "2>/dev/null");
  const Outcome flag = hoof_program("--version", "2>/dev/null");
  CHECK(command.status == 0);
  CHECK(command.text.rfind("code ", 0) == 0);
  CHECK(flag.status == 0);
  CHECK(flag.text == command.text);
}

TEST_CASE("a design with runs beyond its bounds says so, and how to keep them inside") {
  // Rotatable with two factors: the axis is the square root of 2, here 0.45 -+ 0.35 * 1.41421.
  const std::string factors = " --factor e=0.1:0.8 --factor mu_r=0.1:0.4";
  const Outcome beyond = hoof_program("design central-composite" + factors);
  CHECK(beyond.status == 0);
  CHECK(beyond.text ==
        "axial runs go beyond the bounds, to e -0.04497 and 0.945, mu_r 0.03787 and 0.4621; "
        "--within keeps them inside\n");
  const Outcome within = hoof_program("design central-composite --within" + factors);
  CHECK(within.status == 0);
  CHECK(within.text.empty());
  const Outcome box = hoof_program("design box-behnken --factor mu_s=0.1:0.9" + factors);
  CHECK(box.status == 0);
  CHECK(box.text.empty());
}

TEST_CASE("a report is made again and its path printed") {
  const hoof::tests::ScratchFolder scratch;
  hoof::tests::write_synthetic_run(scratch.path(), 20);
  const Outcome outcome = hoof_program("report " + scratch.path().string(), "");
  CHECK(outcome.status == 0);
  CHECK(outcome.text == (scratch.path() / "report.html").string() + "\n");
  CHECK(std::filesystem::exists(scratch.path() / "report.html"));
}
