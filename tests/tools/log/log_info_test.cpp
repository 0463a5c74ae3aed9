#include "tools/log/log_info.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "hal/can_timing.h"
#include "hil_bridge/recording.h"
#include "tools/log/decoded_frame.h"

using namespace hoof::tools;
namespace protocol = hoof::firmware::protocol;

namespace {

constexpr std::int64_t kMs = 1'000'000;

/// SYNC once a millisecond on bus 0.
BusRecording syncs(int ticks) {
  BusRecording r;
  r.path = "x.log";
  r.interfaces = {"can0", "can1"};
  r.origin_ns = hoof::bridge::kSimulatedEpoch_ns;
  for (int tick = 0; tick < ticks; ++tick) {
    r.frames.push_back({r.origin_ns + tick * kMs, 0, encode(protocol::Sync{std::uint32_t(tick)})});
  }
  return r;
}

std::string all(const std::vector<std::string>& findings) {
  std::string text;
  for (const auto& finding : findings) text += finding + "\n";
  return text;
}

}  // namespace

TEST_CASE("rates, gaps and load of a steady SYNC") {
  const BusRecording r = syncs(1001);
  const LogStatistics s = measure(r);
  REQUIRE(s.ids.size() == 1);
  CHECK(s.ids[0].count == 1001);
  CHECK(s.ids[0].rate_Hz() == Approx(1000));
  CHECK(s.ids[0].longest_ns == kMs);
  CHECK(*s.first_tick == 0);
  CHECK(*s.last_tick == 1000);
  CHECK(s.findings.empty());
  double bits_ns = 0;
  for (const auto& f : r.frames) bits_ns += double(hoof::hal::frame_time_ns(f.frame));
  // The first frame began before the recording did, and counts from there.
  CHECK(s.buses[0].mean_load_ratio == Approx(bits_ns / 1e9).epsilon(2e-3));
  CHECK(s.buses[1].frames == 0);
}

TEST_CASE("a lost SYNC, a pause and a wrong CRC are told with their time") {
  BusRecording r = syncs(100);
  r.frames.erase(r.frames.begin() + 40, r.frames.begin() + 45);
  LoggedFrame broken{r.origin_ns + 50 * kMs + 1000, 0, encode(protocol::Heartbeat{})};
  broken.frame.data[1] ^= 1;
  r.frames.insert(r.frames.begin() + 46, broken);
  const std::string text = all(measure(r).findings);
  CAPTURE(text);
  CHECK_THAT(text, Catch::Contains("0.045000 s: SYNC goes from tick 39 to 45"));
  CHECK_THAT(text, Catch::Contains("0.039000 s: Sync pauses for 6.0 ms, its period is 1 ms"));
  CHECK_THAT(text, Catch::Contains("Heartbeat: bad CRC"));
}

TEST_CASE("faults of the heartbeat are told once, when they appear") {
  BusRecording r = syncs(300);
  for (int i = 0; i < 3; ++i) {
    protocol::Heartbeat heartbeat;
    heartbeat.faults = i > 0 ? 1u << 2 : 0;
    r.frames.push_back({r.origin_ns + (i + 1) * 100 * kMs, 0, encode(heartbeat)});
  }
  std::stable_sort(r.frames.begin(), r.frames.end(),
                   [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; });
  const auto findings = measure(r).findings;
  REQUIRE(findings.size() == 1);
  CHECK(findings[0] == "0.200000 s: the foot reports the fault bus_off");
}

TEST_CASE("a reply on the other bus, error frames and unknown ones are told apart") {
  BusRecording r = syncs(10);
  r.frames.push_back({r.last_ns(), 1, encode_reply(protocol::Drive::kToe, {})});
  hoof::hal::CanFrame error;
  error.error = true;
  error.id = 4;
  r.frames.push_back({r.last_ns(), 1, error});
  hoof::hal::CanFrame unknown;
  unknown.id = 0x7AB;
  r.frames.push_back({r.last_ns(), 1, unknown});
  const LogStatistics s = measure(r);
  CHECK(s.buses[1].error_frames == 1);
  CHECK_THAT(all(s.findings), Catch::Contains("ToeReply: on the wrong bus") &&
                                  Catch::Contains("the first error frame on this bus"));
  std::ostringstream out;
  print_info(r, out);
  CHECK_THAT(out.str(), Catch::Contains("(unknown)") && Catch::Contains("(error frame)"));
}
