#include "hil_bridge/drive_node.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "hal/in_process/in_process_bus.h"

using namespace hoof;
using bridge::DriveNode;
namespace protocol = firmware::protocol;
using protocol::Drive;
using protocol::DriveCommand;
using protocol::DriveSwitch;

namespace {

constexpr double kStep_s = 50e-6;

sim::DriveSettings settings() {
  sim::DriveSettings s;
  s.gear_ratio = 10.0;
  s.rotor_inertia_kg_m2 = 0.012;
  s.torque_limit_Nm = 24.0;
  s.stall_torque_Nm = 1e9;  // no speed line
  s.no_load_speed_rad_s = 1e6;
  s.gear_stiffness_Nm_rad = 5000.0;
  s.gear_damping_Nm_s_rad = 15.0;  // critical on the rotor: 2 sqrt(5000 * 0.012)
  s.coulomb_friction_Nm = 0.05;
  s.encoder_counts_turn = 16384.0;
  s.velocity_filter_Hz = 500.0;
  s.absolute_position = true;
  s.command_timeout_s = 0.02;
  s.thermal_resistance_K_W = 3.0;
  s.heat_capacity_J_K = 100.0;
  s.ambient_C = 25.0;
  s.temperature_limit_C = 100.0;
  return s;
}

/// A drive on a bus with a firmware that says what the test wants; its joint is held.
struct Bench {
  hal::InProcessBus bus{{.name = "bus", .bit_rates = {}}};
  hal::InProcessPort& foot = bus.attach("foot");
  hal::InProcessPort& port = bus.attach("drive");
  Drive which;
  sim::Drive drive{settings(), 0.0};
  DriveNode node;
  double joint_rad = 0.0;
  double torque_Nm = 0.0;

  explicit Bench(Drive d = Drive::kToe) : which(d), node(port, d, drive) {}

  /// A millisecond of plant and bus.
  void millisecond() {
    for (int i = 0; i < 20; ++i) {
      bus.advance_to(bus.now_ns() + 50'000);
      node.poll();
      torque_Nm = drive.step(kStep_s, joint_rad, 0.0);
    }
  }

  /// Sends a frame; the answer, or an identifier of zero when none came.
  protocol::DriveReply ask(const hal::CanFrame& frame, int& answers) {
    REQUIRE(foot.send(frame) == hal::SendResult::kQueued);
    millisecond();
    protocol::DriveReply reply;
    hal::CanFrame received;
    answers = 0;
    while (foot.receive(received)) {
      REQUIRE(decode_reply(which, received, reply) == protocol::DecodeResult::kOk);
      ++answers;
    }
    return reply;
  }

  protocol::DriveReply ask(const hal::CanFrame& frame) {
    int answers = 0;
    const protocol::DriveReply reply = ask(frame, answers);
    CHECK(answers == 1);
    return reply;
  }
};

}  // namespace

TEST_CASE("Each frame is answered once, under the drive's own identifier and number") {
  for (const Drive drive : protocol::kDrives) {
    Bench bench(drive);
    CHECK(bench.ask(encode_switch(drive, DriveSwitch::kEnter)).drive_id == drive_id(drive));
    CHECK(bench.ask(encode_command(drive, {})).drive_id == drive_id(drive));
    CHECK(bench.ask(encode_switch(drive, DriveSwitch::kExit)).drive_id == drive_id(drive));
    CHECK(bench.node.commands() == 3);
  }
}

TEST_CASE("Only an entered drive obeys; after exit it no longer does") {
  Bench bench;
  const hal::CanFrame push = encode_command(Drive::kToe, {.torque_Nm = 5.0f});
  bench.ask(push);
  CHECK(std::abs(bench.torque_Nm) < 1e-9);
  bench.ask(encode_switch(Drive::kToe, DriveSwitch::kEnter));
  for (int i = 0; i < 15; ++i) bench.ask(push);
  // At rest against the gear: 5 Nm less at most friction.
  CHECK(bench.torque_Nm == Approx(5.0).margin(0.06));
  bench.ask(encode_switch(Drive::kToe, DriveSwitch::kExit));
  bench.ask(push);
  CHECK(std::abs(bench.drive.motor_torque_Nm()) < 1e-9);
}

TEST_CASE("The torque ends 20 ms after the last command and comes back with the next") {
  Bench bench;
  const hal::CanFrame push = encode_command(Drive::kToe, {.torque_Nm = 5.0f});
  bench.ask(encode_switch(Drive::kToe, DriveSwitch::kEnter));
  bench.ask(push);
  for (int i = 0; i < 18; ++i) bench.millisecond();
  CHECK(bench.drive.motor_torque_Nm() == Approx(5.0).margin(0.01));
  for (int i = 0; i < 2; ++i) bench.millisecond();
  CHECK(bench.drive.motor_torque_Nm() == 0.0);
  bench.ask(push);
  CHECK(bench.drive.motor_torque_Nm() == Approx(5.0).margin(0.01));
}

TEST_CASE("A repeated enter frame does not take the torque away") {
  Bench bench;
  bench.ask(encode_switch(Drive::kToe, DriveSwitch::kEnter));
  bench.ask(encode_command(Drive::kToe, {.torque_Nm = 5.0f}));
  bench.ask(encode_switch(Drive::kToe, DriveSwitch::kEnter));
  CHECK(bench.drive.motor_torque_Nm() == Approx(5.0).margin(0.01));
}

TEST_CASE("The answer is the state when the command arrived") {
  Bench bench(Drive::kHip);
  bench.ask(encode_switch(Drive::kHip, DriveSwitch::kEnter));
  const hal::CanFrame push = encode_command(Drive::kHip, {.torque_Nm = 20.0f});
  CHECK(bench.ask(push).torque_Nm == Approx(0.0).margin(0.1));  // before it took effect
  protocol::DriveReply reply;
  for (int i = 0; i < 10; ++i) reply = bench.ask(push);
  CHECK(reply.torque_Nm == Approx(20.0).margin(0.2));  // a code is 0.195 Nm
  CHECK(reply.position_rad == Approx(20.0 / 5000.0).margin(2e-4));
  CHECK(reply.temperature_C == Approx(25.0).margin(1.0));
  CHECK(reply.error == 0);
}

TEST_CASE("Zero makes the present angle the zero of answers") {
  Bench bench;
  bench.ask(encode_switch(Drive::kToe, DriveSwitch::kEnter));
  protocol::DriveReply reply;
  for (int i = 0; i < 10; ++i) {
    reply = bench.ask(encode_command(Drive::kToe, {.torque_Nm = 10.0f}));
  }
  REQUIRE(reply.position_rad > 1.5e-3f);
  bench.ask(encode_switch(Drive::kToe, DriveSwitch::kSetZero));
  reply = bench.ask(encode_command(Drive::kToe, {.torque_Nm = 10.0f}));
  CHECK(reply.position_rad == Approx(0.0).margin(4e-4));  // a code
}

TEST_CASE("Frames of others are left alone; broken ones of its own are counted and not answered") {
  Bench bench;
  int answers = 0;
  bench.ask(encode_command(Drive::kHip, {}), answers);
  CHECK(answers == 0);
  CHECK(bench.node.malformed() == 0);
  hal::CanFrame broken = encode_command(Drive::kToe, {});
  broken.length = 7;
  bench.ask(broken, answers);
  CHECK(answers == 0);
  CHECK(bench.node.malformed() == 1);
  CHECK(bench.node.commands() == 0);
}

TEST_CASE("An overheated drive says so with the code of the dictionary") {
  Bench bench;
  sim::DriveSettings hot = settings();
  hot.temperature_limit_C = 26.0;
  hot.copper_loss_W_Nm2 = 1e4;  // 5 Nm heat it by 2.5 K in a millisecond
  sim::Drive drive(hot, 0.0);
  drive.enable();
  drive.command({.torque_Nm = 5.0});
  for (int i = 0; i < 20; ++i) drive.step(kStep_s, 0.0, 0.0);
  DriveNode node(bench.port, Drive::kToe, drive);
  bench.foot.send(encode_command(Drive::kToe, {}));
  bench.bus.advance_to(500'000);
  node.poll();
  bench.bus.advance_to(1'000'000);
  hal::CanFrame frame;
  protocol::DriveReply reply;
  REQUIRE(bench.foot.receive(frame));
  REQUIRE(decode_reply(Drive::kToe, frame, reply) == protocol::DecodeResult::kOk);
  CHECK(reply.error == 1);
  CHECK(protocol::kDriveErrorNames[reply.error].name == "motor_over_temperature");
  CHECK(reply.temperature_C >= 26.0f);  // whole degrees
}
