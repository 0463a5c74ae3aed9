// report.html of hoof diagnose in a headless browser. Where no chromium is installed CTest lists
// these tests as skipped.
#include <catch2/catch.hpp>

#include "tests/tools/diagnose/sample_verdict.h"
#include "tests/tools/report/browser.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/diagnose/report_page.h"
#include "tools/run/output_file.h"

using namespace hoof::tests;
using namespace hoof::tools;

TEST_CASE("a diagnosis draws signal and residual of each recording, offline, without an error") {
  if (browser_is_missing()) return;
  for (const Verdict& verdict : {sample_verdict(), sample_verdict_none()}) {
    const ScratchFolder scratch;
    const auto page = scratch.path() / "report.html";
    write_file(page, report_page(verdict, sample_data_sets()));
    const Opened opened = open_in_browser(page, scratch.path());
    CHECK(opened.messages == "");
    CHECK(count_of(opened.page, "<canvas") == 4);
  }
}

TEST_CASE("what is folded away is drawn at its width once it is opened") {
  if (browser_is_missing()) return;
  const ScratchFolder scratch;
  const auto page = scratch.path() / "report.html";
  Verdict verdict = sample_verdict();
  for (int i = 0; i < 3; ++i) verdict.traces.push_back(verdict.traces[0]);
  std::string html = report_page(verdict, sample_data_sets());
  // The event itself comes after the page is dumped; then, how wide is the last plot?
  html +=
      "<script>const fold = document.querySelector('details');"
      "const all = document.querySelectorAll('canvas'), last = all[all.length - 1];"
      "fold.open = true;"
      "fold.dispatchEvent(new Event('toggle'));"
      "document.title = `wide: ${last.clientWidth > 200}`;</script>";
  write_file(page, html);
  const Opened opened = open_in_browser(page, scratch.path());
  CHECK(opened.messages == "");
  CHECK_THAT(opened.page, Catch::Contains("<title>wide: true</title>"));
}
