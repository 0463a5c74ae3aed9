// Host build and board's image, the same test: they must say the same, byte for byte.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/tools/emulator/image_bench.h"

using namespace hoof;
using test::RunRecord;
using test::SeenFrame;

namespace {

bool full() {
  return std::getenv("HOOF_FULL_TESTS") != nullptr;
}

std::string text(const SeenFrame& s) {
  std::string line = std::to_string(s.frame.stamp_ns) + " ns bus " + std::to_string(s.bus) +
                     " id " + std::to_string(s.frame.id) + ":";
  for (int i = 0; i < s.frame.length; ++i) line += " " + std::to_string(s.frame.data[i]);
  return line;
}

/// Every frame on both buses, with its time to the nanosecond.
/// @param least_commands so many of them are drive commands, or the test compares too little
void require_same(const RunRecord& host, const RunRecord& board, std::size_t least_commands) {
  const std::size_t count = std::min(host.frames.size(), board.frames.size());
  std::size_t commands = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const SeenFrame& a = host.frames[i];
    const SeenFrame& b = board.frames[i];
    const bool same = a.bus == b.bus && a.frame.id == b.frame.id &&
                      a.frame.stamp_ns == b.frame.stamp_ns && a.frame == b.frame;
    if (!same) FAIL("frame " << i << ", host " << text(a) << "\n           image " << text(b));
    if (test::is_command(a.frame)) ++commands;
  }
  CHECK(host.frames.size() == board.frames.size());
  CHECK(commands >= least_commands);
  CHECK(host.result.ticks == board.result.ticks);
  CHECK(host.result.toe_reached_rad == board.result.toe_reached_rad);
}

void compare(const std::string& kind, const std::vector<std::string>& set, std::uint32_t ticks) {
  const tools::RunSettings run = test::rigid_run(kind, set);
  // Without faults nothing is missing, and the pace of the polls does not matter.
  const RunRecord host = test::record_run(
      run, run.faults.empty() ? test::host(run) : test::host_at_board_pace(run), ticks);
  const RunRecord board = test::record_run(run, test::image(run), ticks);
  // One a tick. A fault takes SYNC or the wire away for at most 0.05 s, and for the 20 ms (and the
  // tick in which that is seen) after which the foot takes it for lost.
  const std::size_t taken = run.faults.empty() ? 0 : 50 + 21;
  require_same(host, board, host.result.ticks - taken);
}

}  // namespace

TEST_CASE("golden: sinkage on the rigid floor, host and image") {
  for (const char* toe : {"0", "20", "40"}) {
    CAPTURE(toe);
    compare("sinkage", {std::string("experiment.toe_deg=") + toe}, UINT32_MAX);
  }
}

TEST_CASE("golden: traction on the rigid floor, host and image") {
  compare("traction", {"experiment.frequency_Hz=1", "experiment.toe_deg=20"},
          full() ? 20'000 : 4'000);
}

TEST_CASE("golden: faults of frames, nodes, drives and encoders, host and image") {
  // In the middle of the toes' opening, where most is going on.
  const std::vector<std::vector<std::string>> faults = {
      {"kind=drop", "target=ToeReply", "for_s=0.05"},
      {"kind=delay", "target=ToeReply", "delay_ms=3", "for_s=0.03"},
      {"kind=reorder", "target=Sync", "for_s=0.01"},
      {"kind=duplicate", "target=can0", "for_s=0.05"},
      {"kind=corrupt", "target=ToeReply", "bits=3", "for_s=0.05"},
      {"kind=corrupt", "target=Sync", "bits=2", "probability=0.5", "for_s=0.05"},
      {"kind=sync_jitter", "jitter_ms=2", "for_s=0.05"},
      {"kind=flood", "target=can0", "for_s=0.05"},
      {"kind=node_silent", "target=toe", "for_s=0.05"},
      {"kind=node_silent", "target=sync", "for_s=0.03"},
      {"kind=node_restart", "target=toe"},
      {"kind=bus_off", "target=toe", "for_s=0.05"},
      {"kind=encoder_jump", "target=toe", "jump_deg=5", "for_s=0.05"},
      {"kind=encoder_stuck", "target=toe", "for_s=0.2"},
      {"kind=encoder_drift", "target=toe", "drift_deg_s=60", "for_s=0.2"},
      {"kind=encoder_noise", "target=toe", "noise_deg=1", "for_s=0.1"},
      {"kind=encoder_offset", "target=toe", "offset_deg=3", "for_s=0.05"},
      {"kind=torque_loss", "target=toe", "for_s=0.2"},
      {"kind=stall", "target=toe", "for_s=0.3"},
      {"kind=estop", "target=can0", "for_s=0.02"},
  };
  for (const auto& fault : faults) {
    std::vector<std::string> set = {"fault.0.at_s=0.3"};
    for (const std::string& entry : fault) set.push_back("fault.0." + entry);
    CAPTURE(fault[0], fault[1]);
    compare("sinkage", set, UINT32_MAX);
  }
}

TEST_CASE("a gain of the board's parameters changes what is on the bus") {
  const tools::RunSettings run = test::rigid_run("sinkage");
  tools::RunSettings other = test::rigid_run("sinkage", {"control.toe_kp_Nm_rad=249"});
  const auto go = [](const tools::RunSettings& r) { return test::record_run(r, test::image(r)); };
  const RunRecord a = go(run), b = go(other), again = go(run);
  const auto commands = [](const RunRecord& r) {
    std::vector<hal::CanFrame> found;
    for (const SeenFrame& s : r.frames) {
      if (test::is_command(s.frame)) found.push_back(s.frame);
    }
    return found;
  };
  CHECK(commands(a) == commands(again));
  CHECK(commands(a) != commands(b));
}
