// Opens report.html in a headless browser without a network. Where no chromium is installed
// CTest lists these tests as skipped.

#include "tests/tools/report/browser.h"

#include <catch2/catch.hpp>
#include <string>

#include "tests/tools/report/synthetic_run.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/report/report.h"
#include "tools/run/output_file.h"

using hoof::tests::browser_is_missing;
using hoof::tests::count_of;
using hoof::tests::open_in_browser;
using hoof::tests::Opened;
using hoof::tests::ScratchFolder;
using hoof::tests::write_synthetic_run;
using namespace hoof::tools;
namespace fs = std::filesystem;

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
