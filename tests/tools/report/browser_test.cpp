// Opens report.html in a headless browser without a network. Where no chromium is installed
// CTest lists these tests as skipped.

#include <sys/wait.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "tests/tools/report/synthetic_run.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/report/report.h"
#include "tools/run/output_file.h"

using hoof::tests::ScratchFolder;
using hoof::tests::write_synthetic_run;
using namespace hoof::tools;
namespace fs = std::filesystem;

namespace {

struct Outcome {
  int status = 0;
  std::string output;
};

Outcome run_shell(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  Outcome outcome;
  std::array<char, 1 << 16> block;
  std::size_t count = 0;
  while ((count = std::fread(block.data(), 1, block.size(), pipe)) > 0) {
    outcome.output.append(block.data(), count);
  }
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

bool browser_is_missing() {
  if (run_shell("command -v chromium").status == 0) return false;
  WARN("SKIPPED: chromium is not installed, the report was not opened in a browser");
  return true;
}

struct Opened {
  std::string page;      ///< the document after its scripts have run
  std::string messages;  ///< errors that scripts wrote to the console
};

// Root, as in a container, cannot use chromium's sandbox; the page is our own.
Opened open_in_browser(const fs::path& page, const fs::path& scratch) {
  const std::string log = (scratch / "browser.log").string();
  const Outcome outcome = run_shell(
      "timeout 60 chromium --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage "
      "--host-resolver-rules='MAP * ~NOTFOUND' --enable-logging=stderr --user-data-dir='" +
      (scratch / "profile").string() + "' --dump-dom 'file://" + page.string() + "' 2>'" + log +
      "'");
  CHECK(outcome.status == 0);
  Opened opened{outcome.output, ""};
  const std::string text = read_file(log);
  for (std::size_t at = text.find(":CONSOLE"); at != std::string::npos;
       at = text.find(":CONSOLE", at + 1)) {
    opened.messages += text.substr(at, text.find('\n', at) - at) + "\n";
  }
  return opened;
}

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("a report of 3000 samples draws every plot offline and without a script error") {
  if (browser_is_missing()) return;
  const ScratchFolder scratch;
  write_synthetic_run(scratch.path(), 3000);
  const fs::path page = write_report(scratch.path());
  const int plots = count_of(read_file(page), "<div class=\"canvas\"></div>");
  REQUIRE(plots >= 6);

  const Opened opened = open_in_browser(page, scratch.path());
  CHECK(opened.messages == "");
  CHECK(count_of(opened.page, "<canvas") == plots);
}

TEST_CASE("the browser test sees a script error and a missing plot") {
  if (browser_is_missing()) return;
  const ScratchFolder scratch;
  write_file(scratch.path() / "broken.html",
             "<!doctype html><div></div><script>no_such_function();</script>");
  const Opened opened = open_in_browser(scratch.path() / "broken.html", scratch.path());
  CHECK_THAT(opened.messages, Catch::Contains("no_such_function is not defined"));
  CHECK(count_of(opened.page, "<canvas") == 0);
}
