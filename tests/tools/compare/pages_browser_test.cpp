// The pages of hoof compare and hoof log plot in a headless browser. Where no chromium is installed
// CTest lists these tests as skipped.

#include <catch2/catch.hpp>

#include "hil_bridge/recording.h"
#include "tests/tools/report/browser.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/compare/compare_text.h"
#include "tools/log/decoded_frame.h"
#include "tools/log/log_plot.h"
#include "tools/run/output_file.h"

using namespace hoof::tests;
using namespace hoof::tools;
namespace protocol = hoof::firmware::protocol;

TEST_CASE("a comparison draws each signal that both have, offline and without a script error") {
  if (browser_is_missing()) return;
  SignalSeries a{"depth_m", false, {}, {}, {}};
  for (int i = 0; i < 2000; ++i) a.time_s.push_back(1e-3 * i), a.values.push_back(1e-5 * i);
  SignalSeries b = a, phase{"phase_name", true, {0, 1}, {0, 1}, {"<lowered>", "loaded"}};
  b.values[1000] = 1;
  const auto only_a = SignalSeries{"fz_N", false, {0, 1}, {1, 2}, {}};
  const ScratchFolder scratch;
  const auto page = scratch.path() / "compare.html";
  write_file(page, comparison_page(compare({a, phase, only_a}, {b, phase}, {}), {"A", "B"}));
  const Opened opened = open_in_browser(page, scratch.path());
  CHECK(opened.messages == "");
  CHECK(count_of(opened.page, "<canvas") == 2);
  CHECK_THAT(opened.page, Catch::Contains("ONLY IN A") && Catch::Contains("depth_m: OUT"));
}

TEST_CASE("a plot of the bus draws one panel for each message and unit") {
  if (browser_is_missing()) return;
  BusRecording r;
  r.path = "x.log";
  r.interfaces = {"can0"};
  r.origin_ns = hoof::bridge::kSimulatedEpoch_ns;
  for (int i = 0; i < 500; ++i) {
    protocol::DriveReply reply;
    reply.position_rad = 0.001f * float(i);
    r.frames.push_back(
        {r.origin_ns + i * 1'000'000, 0, encode_reply(protocol::Drive::kToe, reply)});
  }
  const ScratchFolder scratch;
  const auto page = scratch.path() / "plot.html";
  write_file(page, plot_page(r, {"ToeReply.position_rad", "ToeReply.torque_Nm"}));
  const Opened opened = open_in_browser(page, scratch.path());
  CHECK(opened.messages == "");
  CHECK(count_of(opened.page, "<canvas") == 2);
  const std::string svg = plot_svg(r, {"ToeReply.position_rad"});
  CHECK_THAT(svg, Catch::StartsWith("<svg") && Catch::Contains("ToeReply.position_rad"));
  CHECK_THROWS_WITH(plot_svg(r, {"ToeReply.position_rad", "ToeReply.torque_Nm"}),
                    Catch::Contains("different units"));
}
