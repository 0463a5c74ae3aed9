// Host build and board's image, the same test: they must say the same, byte for byte.
#include "tests/tools/emulator/golden.h"

using namespace hoof;
using test::RunRecord;
using test::SeenFrame;

namespace {

/// @return ticks compared
std::uint32_t compare(const std::string& kind, const std::vector<std::string>& set,
                      std::uint32_t ticks = UINT32_MAX) {
  const tools::RunSettings run = test::rigid_run(kind, set);
  // Without faults nothing is missing, and the pace of the polls does not matter.
  const RunRecord host = test::record_run(
      run, run.faults.empty() ? test::host(run) : test::host_at_board_pace(run), ticks);
  const RunRecord board = test::record_run(run, test::image(run), ticks);
  // One a tick. A fault takes SYNC or the wire away for at most 0.05 s, and for the 20 ms (and the
  // tick in which that is seen) after which the foot takes it for lost.
  const std::size_t taken = run.faults.empty() ? 0 : 50 + 21;
  test::require_same(host, board, host.result.ticks - taken);
  return host.result.ticks;
}

}  // namespace

TEST_CASE("golden: sinkage on the rigid floor, host and image") {
  for (const char* toe : {"0", "20", "40"}) {
    CAPTURE(toe);
    compare("sinkage", {std::string("experiment.toe_deg=") + toe});
  }
  if (!test::full()) return;
  // Lowered by 1 mm/s.
  const std::uint32_t ticks = compare("sinkage",
                                      {"experiment.toe_deg=20", "experiment.start_height_mm=60",
                                       "experiment.speed_m_s=0.001", "experiment.time_limit_s=60"},
                                      20'000);
  CHECK(ticks == 20'000);
}

TEST_CASE("golden: traction on the rigid floor, host and image") {
  const std::uint32_t ticks = test::full() ? 20'000 : 4'000;
  CHECK(compare("traction",
                {"experiment.frequency_Hz=1", "experiment.toe_deg=20", "experiment.cycles=20"},
                ticks) == ticks);
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
    compare("sinkage", set);
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
