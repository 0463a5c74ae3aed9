#include <catch2/catch.hpp>
#include <random>

#include "firmware/protocol/codec.h"

using namespace hoof::firmware::protocol;
using hoof::hal::CanFrame;

TEST_CASE("A command packs like a mini-cheetah command") {
  // Position at its upper end, speed at its lower, gains at upper and lower, torque upper:
  // FFFF 000 FFF 000 FFF.
  const CanFrame frame = encode_command(Drive::kToe, {12.5f, -45.0f, 500.0f, 0.0f, 24.0f});
  CHECK(frame.id == 0x021);
  CHECK(frame.length == 8);
  const std::uint8_t expected[8] = {0xFF, 0xFF, 0x00, 0x0F, 0xFF, 0x00, 0x0F, 0xFF};
  for (int i = 0; i < 8; ++i) CHECK(frame.data[i] == expected[i]);
}

TEST_CASE("Enter, exit and zero are the published byte rows") {
  for (const auto action : {DriveSwitch::kEnter, DriveSwitch::kExit, DriveSwitch::kSetZero}) {
    const CanFrame frame = encode_switch(Drive::kKnee, action);
    CHECK(frame.id == 0x023);
    for (int i = 0; i < 7; ++i) CHECK(frame.data[i] == 0xFF);
    CHECK(frame.data[7] == static_cast<std::uint8_t>(action));
    DriveOrder order;
    REQUIRE(decode_command(Drive::kKnee, frame, order) == DecodeResult::kOk);
    CHECK(order.action == action);
    CHECK(order.command.kp_Nm_rad == 0.0f);
  }
}

TEST_CASE("No command reads as enter, exit or zero") {
  for (const Drive drive : kDrives) {
    const DriveRange& r = kDriveRanges[index(drive)];
    for (std::uint32_t raw = 4000; raw <= 4095; ++raw) {
      const float torque_Nm = value_from_raw(kCommandSignals[index(drive)][4], raw);
      const CanFrame frame = encode_command(
          drive, {r.position_rad, r.velocity_rad_s, r.kp_Nm_rad, r.kd_Nm_s_rad, torque_Nm});
      DriveOrder order;
      REQUIRE(decode_command(drive, frame, order) == DecodeResult::kOk);
      REQUIRE_FALSE(order.action.has_value());
      // Never more than asked, and at most three codes less.
      CHECK(order.command.torque_Nm <= torque_Nm);
      CHECK(order.command.torque_Nm >= torque_Nm - 3.01f * kCommandSignals[index(drive)][4].scale);
    }
  }
}

TEST_CASE("Every torque code of every drive comes back as the same bytes") {
  for (const Drive drive : kDrives) {
    for (std::uint32_t raw = 0; raw <= 4095; ++raw) {
      CanFrame frame = encode_command(drive, {});
      set_raw(frame, kCommandSignals[index(drive)][4], raw);
      DriveOrder order;
      REQUIRE(decode_command(drive, frame, order) == DecodeResult::kOk);
      REQUIRE(encode_command(drive, order.command) == frame);
    }
  }
}

TEST_CASE("Random commands and replies come back as the same bytes") {
  const unsigned seed = 3;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  for (int n = 0; n < 20000; ++n) {
    const Drive drive = kDrives[random() % 3];
    CanFrame frame;
    frame.length = 8;
    for (int i = 0; i < 8; ++i) frame.data[i] = static_cast<std::uint8_t>(random());
    frame.id = command_spec(drive).id;
    DriveOrder order;
    REQUIRE(decode_command(drive, frame, order) == DecodeResult::kOk);
    REQUIRE(encode_command(drive, order.command) == frame);
    frame.id = reply_spec(drive).id;
    frame.data[0] = drive_id(drive);
    DriveReply reply;
    REQUIRE(decode_reply(drive, frame, reply) == DecodeResult::kOk);
    REQUIRE(encode_reply(drive, reply) == frame);
  }
}

TEST_CASE("Zero torque has no code: it packs to the one above, within half a code") {
  const float residual_Nm[] = {0.0059f, 0.0977f, 0.0977f};  // T / 4095, as the header states
  for (const Drive drive : kDrives) {
    DriveOrder order;
    REQUIRE(decode_command(drive, encode_command(drive, {}), order) == DecodeResult::kOk);
    CHECK(raw_of(encode_command(drive, {}), kCommandSignals[index(drive)][4]) == 2048);
    CHECK(order.command.torque_Nm > 0.0f);
    CHECK(order.command.torque_Nm == Approx(residual_Nm[index(drive)]).epsilon(0.01));
    CHECK(order.command.kp_Nm_rad == 0.0f);  // gains do have an exact zero
    CHECK(order.command.kd_Nm_s_rad == 0.0f);
  }
}

TEST_CASE("A reply under the identifier of one drive with the number of another is refused") {
  CanFrame frame = encode_reply(Drive::kHip, {});
  frame.data[0] = drive_id(Drive::kKnee);
  DriveReply reply;
  reply.position_rad = 1.0f;
  CHECK(decode_reply(Drive::kHip, frame, reply) == DecodeResult::kWrongIdentifier);
  CHECK(reply.position_rad == 1.0f);
}

TEST_CASE("A command or reply that is not in order changes nothing and is no switch") {
  for (const Drive drive : kDrives) {
    CanFrame command = encode_switch(drive, DriveSwitch::kEnter);
    command.length = 7;
    DriveOrder order;
    order.command.torque_Nm = 1.0f;
    CHECK(decode_command(drive, command, order) == DecodeResult::kWrongLength);
    CHECK_FALSE(order.action.has_value());
    CHECK(order.command.torque_Nm == 1.0f);
    CanFrame answer = encode_reply(drive, {});
    answer.remote = true;
    DriveReply reply;
    reply.torque_Nm = 1.0f;
    CHECK(decode_reply(drive, answer, reply) == DecodeResult::kWrongFormat);
    CHECK(reply.torque_Nm == 1.0f);
  }
}
