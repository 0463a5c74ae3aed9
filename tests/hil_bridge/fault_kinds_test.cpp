// Each kind of fault, seen on the bus or in the plant and not by its own counter: taken out, its
// test fails.

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "firmware/protocol/codec.h"
#include "hil_bridge/fault_timeline.h"
#include "tests/hil_bridge/fault_bench.h"

using namespace hoof;
using firmware::protocol::Drive;
using firmware::protocol::DriveReply;
using test::FaultRun;
using test::frames_in;
using test::run_with_faults;
namespace fault = firmware::control::fault;

namespace {

constexpr std::uint32_t kSync = 0x010, kToeReply = 0x031, kToeCommand = 0x021, kFootToe = 0x060;
constexpr double kDegree_rad = 0.017453292519943295;
// In the traction run the toes are homed by 0.5 s, open by 1.2 s, and still while the leg is not on
// the ground.
constexpr double kCode_rad = 25.0 / 65535;  // of the toe's position
constexpr double kSpeedCode_rad_s = 90.0 / 4095;

std::string entry(const std::string& text) {
  return "[[fault]]\n" + text + "\n";
}

FaultRun traction(const std::string& text) {
  return run_with_faults("traction", entry(text));
}

DriveReply decoded(const hal::CanFrame& frame) {
  DriveReply reply;
  REQUIRE(decode_reply(Drive::kToe, frame, reply) == firmware::protocol::DecodeResult::kOk);
  return reply;
}

std::vector<DriveReply> replies(const FaultRun& run, double from_s, double to_s) {
  std::vector<DriveReply> decoded_replies;
  for (const hal::CanFrame& frame : frames_in(run, kToeReply, from_s, to_s)) {
    decoded_replies.push_back(decoded(frame));
  }
  return decoded_replies;
}

double true_toe_rad(const FaultRun& run, double time_s) {
  for (const test::TrueTick& tick : run.truth) {
    if (tick.time_s >= time_s - 1e-6) return tick.toe_rad;
  }
  FAIL("the run ended before " << time_s << " s");
  return 0;
}

double began_s(const FaultRun& run) {
  REQUIRE(run.result.faults.at(0).began_s);
  return *run.result.faults[0].began_s;
}

double mean_position_rad(const std::vector<DriveReply>& seen) {
  double sum = 0;
  for (const DriveReply& reply : seen) sum += double(reply.position_rad);
  return sum / double(seen.size());
}

/// The motor's own angle over the joint's true one: what the encoder adds, and the gear's play.
double encoder_error_rad(const FaultRun& run, double time_s) {
  const auto seen = replies(run, time_s - 1e-3, time_s);
  REQUIRE(seen.size() == 1);
  return double(seen[0].position_rad) - true_toe_rad(run, time_s);
}

}  // namespace

TEST_CASE("fault kinds: delayed replies pause once, then come late") {
  const FaultRun run =
      traction("kind = \"delay\"\ntarget = \"ToeReply\"\nat_s = 1.3\nfor_s = 0.05\ndelay_ms = 3");
  CHECK(frames_in(run, kToeReply, 1.299, 1.3).size() == 1);
  CHECK(frames_in(run, kToeReply, 1.3, 1.303).empty());
  CHECK(frames_in(run, kToeReply, 1.303, 1.35).size() == 47);
  // What was held back comes out beside the first that are on time.
  CHECK(frames_in(run, kToeReply, 1.35, 1.353).size() == 6);
  CHECK(run.result.reaction->faults == 0);
}

TEST_CASE("fault kinds: reordered SYNC numbers swap in pairs") {
  const FaultRun run = traction("kind = \"reorder\"\ntarget = \"Sync\"\nat_s = 1.3\nfor_s = 0.05");
  int back = 0;
  std::uint32_t last = 0;
  for (const test::SeenFrame& seen : run.frames) {
    if (seen.bus != 0 || seen.frame.id != kSync) continue;
    firmware::protocol::Sync sync;
    REQUIRE(decode(seen.frame, sync) == firmware::protocol::DecodeResult::kOk);
    back += sync.tick < last;
    last = sync.tick;
  }
  CHECK(back == 25);
}

TEST_CASE("fault kinds: duplicated frames are there as often as said") {
  const FaultRun run =
      traction("kind = \"duplicate\"\ntarget = \"ToeReply\"\nat_s = 1.3\nfor_s = 0.05\ncopies = 2");
  const auto frames = frames_in(run, kToeReply, 1.3, 1.35);
  REQUIRE(frames.size() == 150);
  for (std::size_t i = 0; i < frames.size(); i += 3) {
    CHECK(frames[i].data == frames[i + 1].data);
    CHECK(frames[i].data == frames[i + 2].data);
  }
}

TEST_CASE("fault kinds: of corrupted frames exactly so many bits are flipped") {
  // Telemetry: nobody acts on it, so all else of the run is as without the fault.
  const FaultRun clean = run_with_faults("traction", "");
  const FaultRun run =
      traction("kind = \"corrupt\"\ntarget = \"FootToe\"\nat_s = 1.3\nfor_s = 0.1\nbits = 3");
  const auto good = frames_in(clean, kFootToe, 1.3, 1.4), bad = frames_in(run, kFootToe, 1.3, 1.4);
  REQUIRE(good.size() == 10);
  REQUIRE(bad.size() == 10);
  for (std::size_t i = 0; i < good.size(); ++i) {
    int flipped = 0;
    for (std::size_t b = 0; b < good[i].length; ++b) {
      flipped += std::popcount(unsigned(good[i].data[b] ^ bad[i].data[b]));
    }
    CHECK(flipped == 3);
  }
}

TEST_CASE("fault kinds: a flood comes at its rate, or fills the wire") {
  const FaultRun some = traction(
      "kind = \"flood\"\ntarget = \"can0\"\nid = 0x7F0\nrate_Hz = 2000\nat_s = 1.3\nfor_s = 0.05");
  CHECK(double(frames_in(some, 0x7F0, 1.3, 1.35).size()) == Approx(100).margin(2));
  const FaultRun full =
      traction("kind = \"flood\"\ntarget = \"can0\"\nid = 0\nat_s = 1.3\nfor_s = 0.05");
  // 50 ms of frames of 111 bits and up to 24 stuffed at 1 Mbit/s.
  CHECK(frames_in(full, 0, 1.3, 1.35).size() > 360);
  CHECK((full.result.reaction->faults & (fault::kSyncLost | fault::kDriveLost)) != 0);
}

TEST_CASE("fault kinds: a node whose controller is off the bus is not on it, and knows") {
  const FaultRun drive =
      traction("kind = \"bus_off\"\ntarget = \"toe\"\nat_s = 1.3\nfor_s = 0.015");
  CHECK(frames_in(drive, kToeReply, 1.3, 1.315).empty());
  CHECK(frames_in(drive, kToeCommand, 1.3, 1.315).size() == 15);
  const FaultRun foot = traction("kind = \"bus_off\"\ntarget = \"foot\"\nat_s = 1.3\nfor_s = 0.05");
  CHECK(frames_in(foot, kToeCommand, 1.3002, 1.35).empty());
  CHECK((foot.result.reaction->faults & fault::kBusOff) != 0);
  CHECK(*foot.result.reaction->tripped_s == Approx(1.3).margin(0.0015));
}

TEST_CASE("fault kinds: a silent foot hears, but says nothing") {
  const FaultRun run =
      traction("kind = \"node_silent\"\ntarget = \"foot\"\nat_s = 1.3\nfor_s = 0.05");
  CHECK(frames_in(run, kToeCommand, 1.3002, 1.35).empty());
  CHECK(run.result.reaction->faults == fault::kDriveLost);
}

TEST_CASE("fault kinds: a toe drive that restarts counts from where it wakes up") {
  const FaultRun run =
      traction("kind = \"node_restart\"\ntarget = \"toe\"\nat_s = 1.3\nfor_s = 0.03");
  const auto before = replies(run, 1.299, 1.3), after = replies(run, 1.33, 1.335);
  REQUIRE(before.size() == 1);
  REQUIRE(!after.empty());
  CHECK(std::abs(before[0].position_rad) > 0.2);
  CHECK(std::abs(after[0].position_rad) < 0.01);
  CHECK(frames_in(run, kToeReply, 1.3002, 1.33).empty());
}

TEST_CASE("fault kinds: a foot that restarts is in mode off, with the cause that was told") {
  const FaultRun run = traction(
      "kind = \"node_restart\"\ntarget = \"foot\"\nat_s = 1.3\nfor_s = 0.03\ncause = \"watchdog\"");
  CHECK(run.result.reaction->faults == fault::kUnexpectedReset);
  CHECK(frames_in(run, kToeCommand, 1.3002, 1.33).empty());
}

TEST_CASE("fault kinds: an encoder that jumps shows it as way and as speed, and keeps it") {
  const FaultRun run =
      traction("kind = \"encoder_jump\"\ntarget = \"toe\"\nat_s = 1.3\njump_deg = 5");
  const auto before = replies(run, 1.299, 1.3), after = replies(run, 1.3, 1.301);
  CHECK(after.at(0).position_rad - before.at(0).position_rad ==
        Approx(5 * kDegree_rad).margin(0.01));
  CHECK(after[0].velocity_rad_s > 5);
  CHECK(encoder_error_rad(run, 1.4) - encoder_error_rad(run, 1.299) ==
        Approx(5 * kDegree_rad).margin(0.01));
}

TEST_CASE("fault kinds: an offset is there while it lasts, without speed") {
  const FaultRun run = traction(
      "kind = \"encoder_offset\"\ntarget = \"toe\"\nat_s = 1.3\nfor_s = 0.05\noffset_deg = -1");
  const auto before = replies(run, 1.299, 1.3), after = replies(run, 1.3, 1.301);
  CHECK(after.at(0).position_rad - before.at(0).position_rad ==
        Approx(-1 * kDegree_rad).margin(4 * kCode_rad));
  CHECK(std::abs(after[0].velocity_rad_s - before[0].velocity_rad_s) < 4 * kSpeedCode_rad_s);
  CHECK(encoder_error_rad(run, 1.4) == Approx(encoder_error_rad(run, 1.299)).margin(0.005));
}

TEST_CASE("fault kinds: a stuck encoder shows one code while the toe goes on") {
  const FaultRun run = traction(
      "kind = \"encoder_stuck\"\ntarget = \"toe\"\nwhen = \"toe_rad > 0.15\"\nfor_s = 0.05");
  const double t_s = began_s(run);
  const auto seen = replies(run, t_s + 2e-3, t_s + 0.05);
  REQUIRE(seen.size() > 40);
  for (const DriveReply& reply : seen) CHECK(reply.position_rad == seen[0].position_rad);
  CHECK(std::abs(true_toe_rad(run, t_s + 0.05) - true_toe_rad(run, t_s)) > 0.02);
}

TEST_CASE("fault kinds: a drift adds up at its rate, and stays") {
  const FaultRun run = traction(
      "kind = \"encoder_drift\"\ntarget = \"toe\"\nat_s = 1.3\nfor_s = 0.1\ndrift_deg_s = 10");
  const double before_rad = encoder_error_rad(run, 1.299);
  CHECK(encoder_error_rad(run, 1.35) - before_rad == Approx(0.5 * kDegree_rad).margin(1e-3));
  CHECK(encoder_error_rad(run, 1.4) - before_rad == Approx(1 * kDegree_rad).margin(1e-3));
  CHECK(encoder_error_rad(run, 1.45) - before_rad == Approx(1 * kDegree_rad).margin(1e-3));
}

TEST_CASE("fault kinds: noise has the standard deviation that was asked for") {
  // So little that the watch on readings against speeds bears it, and ten codes all the same.
  const FaultRun run = traction(
      "kind = \"encoder_noise\"\ntarget = \"toe\"\nat_s = 1.3\nfor_s = 0.2\nnoise_deg = 0.2");
  const auto spread_rad = [&](double from_s, double to_s) {
    const auto seen = replies(run, from_s, to_s);
    const double mean_rad = mean_position_rad(seen);
    double sum = 0;
    for (const DriveReply& r : seen) sum += std::pow(double(r.position_rad) - mean_rad, 2);
    return std::sqrt(sum / double(seen.size()));
  };
  CHECK(spread_rad(1.25, 1.3) < 2 * kCode_rad);
  // The drive's law shakes the toe with it: not exactly what was added.
  CHECK(spread_rad(1.301, 1.311) == Approx(0.2 * kDegree_rad).epsilon(0.7));
}

TEST_CASE("fault kinds: a drive without torque tells none while it is asked for some") {
  const FaultRun run =
      traction("kind = \"torque_loss\"\ntarget = \"toe\"\nwhen = \"toe_rad > 0.15\"\nfor_s = 0.05");
  const double t_s = began_s(run);
  double before_Nm = 0, after_Nm = 0;
  for (const DriveReply& r : replies(run, t_s - 0.05, t_s)) {
    before_Nm = std::max(before_Nm, std::abs(double(r.torque_Nm)));
  }
  for (const DriveReply& r : replies(run, t_s + 1e-3, t_s + 0.05)) {
    after_Nm = std::max(after_Nm, std::abs(double(r.torque_Nm)));
  }
  CHECK(before_Nm > 0.3);
  CHECK(after_Nm < 0.01);
}

TEST_CASE("fault kinds: a stalled drive stands, whatever it is told") {
  const std::string begin = "target = \"toe\"\nwhen = \"toe_rad > 0.15\"\nfor_s = 0.3\n";
  const FaultRun stall = traction("kind = \"stall\"\n" + begin);
  const double t_s = began_s(stall);
  // The gear winds up and back, the rotor stands.
  const auto seen = replies(stall, t_s + 5e-3, t_s + 0.1);
  for (const DriveReply& reply : seen) {
    CHECK(std::abs(reply.position_rad - seen[0].position_rad) < 2 * kCode_rad);
  }
  CHECK(std::abs(true_toe_rad(stall, t_s + 0.1) - true_toe_rad(stall, t_s + 0.01)) < 0.02);
  CHECK(stall.result.reaction->faults != 0);
}

TEST_CASE(
    "fault kinds: a supply that sags and a button that is pressed are told as what they are") {
  const auto bits = [](const std::string& text) {
    return traction(text + "\nat_s = 1.3\nfor_s = 0.02").result.reaction->faults;
  };
  CHECK(bits("kind = \"brown_out\"") == fault::kBrownOut);
  CHECK(bits("kind = \"brown_out\"\nsupply_V = 30") == fault::kBrownOut);
  CHECK(bits("kind = \"brown_out\"\nsupply_V = 48") == 0);
  CHECK(bits("kind = \"estop\"\ntarget = \"line\"") == fault::kEmergencyStop);
  const FaultRun frame = traction("kind = \"estop\"\ntarget = \"can0\"\nat_s = 1.3\nfor_s = 0.02");
  CHECK(frame.result.reaction->faults == fault::kEmergencyStop);
  CHECK(frames_in(frame, 0x001, 1.3, 1.32).size() == 2);
}

TEST_CASE("fault kinds: a supply that is measured is 48 V before it sags and once it is back") {
  const auto supply_V = [](const FaultRun& run, double from_s, double to_s) {
    std::set<float> told;
    for (const hal::CanFrame& frame : frames_in(run, 0x065, from_s, to_s)) {
      firmware::protocol::FootLoad load;
      REQUIRE(decode(frame, load) == firmware::protocol::DecodeResult::kOk);
      told.insert(load.supply_V);
    }
    return told;
  };
  const std::string when = "\nat_s = 1.3\nfor_s = 0.05";
  const FaultRun sags = traction("kind = \"brown_out\"\nsupply_V = 30" + when);
  CHECK(supply_V(sags, 0, 1.3) == std::set<float>{48.0f});
  CHECK(supply_V(sags, 1.311, 1.35) == std::set<float>{30.0f});
  CHECK(supply_V(sags, 1.361, 1.5) == std::set<float>{48.0f});
  // The early warning alone is no measurement.
  const FaultRun warned = traction("kind = \"brown_out\"" + when);
  CHECK(supply_V(warned, 0, 1.5) == std::set<float>{0.0f});
}

TEST_CASE("fault kinds: SYNC jitters as far as said, and no farther") {
  const FaultRun run = traction("kind = \"sync_jitter\"\nat_s = 1.3\nfor_s = 0.2\njitter_ms = 0.8");
  const auto late_ms = [&](double from_s, double to_s) {
    std::vector<double> late;
    for (const test::SeenFrame& seen : run.frames) {
      const double t_s = test::time_of(seen);
      if (seen.bus != 0 || seen.frame.id != kSync || t_s < from_s || t_s >= to_s) continue;
      firmware::protocol::Sync sync;
      REQUIRE(decode(seen.frame, sync) == firmware::protocol::DecodeResult::kOk);
      late.push_back((t_s - double(sync.tick) * 1e-3) * 1e3);
    }
    REQUIRE(!late.empty());
    const auto [least, most] = std::minmax_element(late.begin(), late.end());
    return std::make_pair(*least, *most);
  };
  // A frame of four bytes takes 0.08 to 0.1 ms, and may wait for another of 0.135.
  CHECK(late_ms(1.2, 1.3).second < 0.3);
  const auto [least, most] = late_ms(1.3, 1.5);
  CHECK(least < 0.3);
  CHECK(most > 0.6);
  CHECK(most < 0.8 + 0.3);
}
