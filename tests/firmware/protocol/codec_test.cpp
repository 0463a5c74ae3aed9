#include "firmware/protocol/codec.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace hoof::firmware::protocol;
using hoof::hal::CanFrame;

namespace {

/// The same signal by another way: bit by bit.
std::uint32_t raw_by_bits(const CanFrame& frame, const Signal& signal) {
  std::uint32_t raw = 0;
  for (int i = 0; i < signal.length; ++i) {
    const int bit = signal.first_bit + i;
    raw = raw << 1 | (frame.data[bit / 8] >> (7 - bit % 8) & 1u);
  }
  return raw;
}

template <typename M>
CanFrame random_valid_frame(std::mt19937& random) {
  CanFrame frame;
  frame.id = spec(M::kMessage).id;
  frame.length = spec(M::kMessage).length;
  for (int i = 0; i < frame.length; ++i) frame.data[i] = static_cast<std::uint8_t>(random());
  if (spec(M::kMessage).crc) frame.data[frame.length - 1] = crc8(frame);
  return frame;
}

/// Any value of each field: within its range, beyond it, not a number, all codes of whole numbers.
template <typename M>
M random_message(std::mt19937& random, float spread = 30.0f) {
  M message;
  std::normal_distribution<float> value(0.0f, spread);
  const auto fill = [&](auto& member) {
    using T = std::remove_reference_t<decltype(member)>;
    if constexpr (std::floating_point<T>) {
      member = random() % 50 == 0 ? std::nanf("") : value(random);
    } else {
      member = static_cast<T>(random());
    }
  };
  std::apply([&](auto... field) { (fill(message.*field), ...); }, M::fields());
  return message;
}

/// What encode() says, by another way: signal by signal, each into the frame as it is then.
template <typename M>
CanFrame encode_one_by_one(const MessageSpec& message_spec, const M& message) {
  CanFrame frame;
  frame.id = message_spec.id;
  frame.length = message_spec.length;
  std::size_t i = 0;
  const auto put = [&](auto member) {
    const Signal& signal = message_spec.signals[i++];
    set_raw(frame, signal, detail::pack(signal, member));
  };
  std::apply([&](auto... field) { (put(message.*field), ...); }, M::fields());
  if (message_spec.crc) frame.data[frame.length - 1] = crc8(frame);
  return frame;
}

template <typename M>
bool same_one_by_one(const MessageSpec& message_spec, const CanFrame& frame, const M& message) {
  std::size_t i = 0;
  bool same = true;
  const auto compare = [&](auto member) {
    const Signal& signal = message_spec.signals[i++];
    same = same && member == detail::unpack<decltype(member)>(signal, raw_by_bits(frame, signal));
  };
  std::apply([&](auto... field) { (compare(message.*field), ...); }, M::fields());
  return same;
}

}  // namespace

TEST_CASE("CRC-8 has the catalogued check value") {
  // The identifier takes the first two bytes of "123456789", the payload the rest; the byte of the
  // CRC itself is left out. CRC-8/AUTOSAR of "123456789" is 0xDF.
  CanFrame frame;
  frame.id = '1' | '2' << 8;
  frame.length = 8;
  for (int i = 0; i < 7; ++i) frame.data[i] = static_cast<std::uint8_t>('3' + i);
  CHECK(crc8(frame) == 0xDF);
}

TEST_CASE("Reading and writing raw codes agrees with counting bits, for every signal") {
  const unsigned seed = 1;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  for (const MessageSpec& message : kMessages) {
    for (const Signal& signal : message.signals) {
      for (int n = 0; n < 50; ++n) {
        CanFrame frame;
        for (int i = 0; i < 8; ++i) frame.data[i] = static_cast<std::uint8_t>(random());
        const CanFrame before = frame;
        REQUIRE(raw_of(frame, signal) == raw_by_bits(frame, signal));
        const std::uint32_t raw = random() & signal.largest_raw();
        set_raw(frame, signal, raw);
        REQUIRE(raw_by_bits(frame, signal) == raw);
        set_raw(frame, signal, raw_of(before, signal));
        REQUIRE(frame.data == before.data);  // no other bit touched
      }
    }
  }
}

TEST_CASE("Every code of every physical signal survives value and back") {
  for (const MessageSpec& message : kMessages) {
    for (const Signal& signal : message.signals) {
      if (signal.length > 16) continue;  // whole numbers, never turned into a float
      INFO(message.name << '.' << signal.name);
      std::uint32_t wrong = 0;
      for (std::uint32_t raw = 0; raw <= signal.largest_raw(); ++raw) {
        if (raw_from_value(signal, value_from_raw(signal, raw)) != raw) ++wrong;
      }
      CHECK(wrong == 0);
    }
  }
}

TEST_CASE("A value packs to the nearest code, halves upwards, and never wraps") {
  const Signal& torque = kCommandSignals[0][4];
  const float step = torque.scale;
  CHECK(raw_from_value(torque, -24.0f) == 0);
  CHECK(raw_from_value(torque, 24.0f) == 4095);
  CHECK(raw_from_value(torque, -24.0f + 10.4f * step) == 10);
  CHECK(raw_from_value(torque, -24.0f + 10.6f * step) == 11);
  for (const float beyond : {24.01f, 25.0f, 1e6f, std::numeric_limits<float>::infinity()}) {
    CHECK(raw_from_value(torque, beyond) == 4095);
    CHECK(raw_from_value(torque, -beyond) == 0);
  }
  CHECK(raw_from_value(torque, std::nanf("")) == raw_from_value(torque, 0.0f));
}

TEST_CASE("A whole number too large for its signal packs as the largest, it never wraps") {
  constexpr Signal kByte = number("byte", 0, 8);
  CHECK(detail::pack<std::uint16_t>(kByte, 255) == 255);
  CHECK(detail::pack<std::uint16_t>(kByte, 256) == 255);
  CHECK(detail::pack<std::uint16_t>(kByte, 65535) == 255);
}

TEMPLATE_TEST_CASE("Every message says why it refuses a frame and then changes nothing", "",
                   EmergencyStop, Sync, SupervisorOrder, OrderAcknowledge, SupervisorConnect,
                   ParameterWrite, ServiceRequest, ServiceAnswer, Heartbeat, FootToe, FootLeg,
                   FootGround, FootGate, FootCounters, FootLoad, FootFrames) {
  const CanFrame good = encode(TestType{});
  CanFrame short_frame = good;
  --short_frame.length;
  CanFrame full = good;
  std::fill_n(full.data.begin(), full.length, std::uint8_t{0xFF});
  full.remote = true;
  TestType message;
  CHECK(decode(short_frame, message) == DecodeResult::kWrongLength);
  CHECK(decode(full, message) == DecodeResult::kWrongFormat);
  CHECK(encode(message) == good);
}

TEMPLATE_TEST_CASE("A message is packed and unpacked as its signals one by one are", "",
                   EmergencyStop, Sync, SupervisorOrder, OrderAcknowledge, SupervisorConnect,
                   ParameterWrite, ServiceRequest, ServiceAnswer, Heartbeat, FootToe, FootLeg,
                   FootGround, FootGate, FootCounters, FootLoad, FootFrames) {
  const unsigned seed = 5;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  for (int n = 0; n < 500; ++n) {
    const TestType message = random_message<TestType>(random);
    const CanFrame frame = encode(message);
    REQUIRE(frame == encode_one_by_one(spec(TestType::kMessage), message));
    TestType decoded;
    REQUIRE(decode(frame, decoded) == DecodeResult::kOk);
    REQUIRE(same_one_by_one(spec(TestType::kMessage), frame, decoded));
  }
}

TEST_CASE("A drive's command and reply are packed and unpacked as their signals one by one are") {
  const unsigned seed = 6;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  for (const Drive drive : kDrives) {
    for (int n = 0; n < 2000; ++n) {
      const auto command =
          random_message<DriveCommand>(random, kDriveRanges[index(drive)].torque_Nm);
      const CanFrame frame = encode_command(drive, command);
      REQUIRE(frame == encode_one_by_one(command_spec(drive), command));
      DriveOrder order;
      REQUIRE(decode_command(drive, frame, order) == DecodeResult::kOk);
      REQUIRE(same_one_by_one(command_spec(drive), frame, order.command));
      auto reply = random_message<DriveReply>(random, kDriveRanges[index(drive)].torque_Nm);
      reply.drive_id = drive_id(drive);
      const CanFrame answer = encode_reply(drive, reply);
      REQUIRE(answer == encode_one_by_one(reply_spec(drive), reply));
      REQUIRE(decode_reply(drive, answer, reply) == DecodeResult::kOk);
      REQUIRE(same_one_by_one(reply_spec(drive), answer, reply));
    }
  }
}

TEST_CASE("Frames with the wrong identifier, format or length change nothing") {
  const CanFrame good = encode(Heartbeat{Mode::kReady, 0x5, 0x123456, 0x9ABCDE});
  Heartbeat message;
  REQUIRE(decode(good, message) == DecodeResult::kOk);
  CHECK(message.mode == Mode::kReady);
  CHECK(message.counter == 0x5);
  CHECK(message.faults == 0x123456);
  CHECK(message.protocol_hash == 0x9ABCDE);

  struct Case {
    void (*spoil)(CanFrame&);
    DecodeResult result;
  };
  const Case cases[] = {
      {[](CanFrame& f) { f.id ^= 1; }, DecodeResult::kWrongIdentifier},
      {[](CanFrame& f) { f.length = 7; }, DecodeResult::kWrongLength},
      {[](CanFrame& f) { f.length = 0; }, DecodeResult::kWrongLength},
      {[](CanFrame& f) { f.length = 64; }, DecodeResult::kWrongLength},
      {[](CanFrame& f) { f.extended = true; }, DecodeResult::kWrongFormat},
      {[](CanFrame& f) { f.remote = true; }, DecodeResult::kWrongFormat},
      {[](CanFrame& f) { f.error = true; }, DecodeResult::kWrongFormat},
      {[](CanFrame& f) { f.fd = true; }, DecodeResult::kWrongFormat},
  };
  for (const Case& c : cases) {
    CanFrame bad = good;
    c.spoil(bad);
    Heartbeat untouched;
    CHECK(decode(bad, untouched) == c.result);
    CHECK(untouched.faults == 0);
  }
}

TEMPLATE_TEST_CASE("Any one, two or three wrong bits of a frame with a CRC are seen", "",
                   SupervisorOrder, OrderAcknowledge, SupervisorConnect, ParameterWrite,
                   ServiceRequest, ServiceAnswer, Heartbeat) {
  const unsigned seed = 3;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  const CanFrame good = random_valid_frame<TestType>(random);
  TestType order;
  REQUIRE(decode(good, order) == DecodeResult::kOk);
  const auto flip = [](CanFrame& frame, int bit) {
    frame.data[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
  };
  int missed = 0;
  for (int a = 0; a < 64; ++a) {
    for (int b = a; b < 64; ++b) {
      for (int c = b; c < 64; ++c) {
        CanFrame bad = good;
        flip(bad, a);
        if (b != a) flip(bad, b);
        if (c != b) flip(bad, c);
        if (decode(bad, order) != DecodeResult::kBadCrc) ++missed;
      }
    }
  }
  CHECK(missed == 0);
}

TEST_CASE("An order's CRC does not pass under another identifier") {
  CanFrame order = encode(SupervisorOrder{});
  order.id = spec(Message::kOrderAcknowledge).id;
  OrderAcknowledge answer;
  CHECK(decode(order, answer) == DecodeResult::kBadCrc);
}

TEMPLATE_TEST_CASE("Decoding any payload and encoding it again gives the same bytes", "",
                   EmergencyStop, Sync, SupervisorOrder, OrderAcknowledge, SupervisorConnect,
                   ParameterWrite, ServiceRequest, ServiceAnswer, Heartbeat, FootLeg, FootGate,
                   FootCounters, FootFrames) {
  const unsigned seed = 2;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  for (int n = 0; n < 2000; ++n) {
    const CanFrame frame = random_valid_frame<TestType>(random);
    TestType message;
    REQUIRE(decode(frame, message) == DecodeResult::kOk);
    REQUIRE(encode(message) == frame);
  }
}

TEST_CASE("Orders keep their meaning on the wire") {
  SupervisorOrder order;
  REQUIRE(decode(encode(SupervisorOrder{9, Order::kReady, 0.6981f, 0.45f, 255}), order) ==
          DecodeResult::kOk);
  CHECK(order.supervisor_id == 9);
  CHECK(order.order == Order::kReady);
  CHECK(order.toe_angle_rad == Approx(0.6981f).margin(0.5e-4));  // half a code
  CHECK(order.frequency_Hz == Approx(0.45f).margin(0.5e-3));
  CHECK(order.counter == 255);
}

TEST_CASE("A flag is read as set from any code but zero") {
  for (const std::uint32_t code : {0u, 1u, 2u, 128u, 255u}) {
    CanFrame toe = encode(FootToe{});
    CanFrame ground = encode(FootGround{});
    set_raw(toe, kFootToeSignals[4], code);
    set_raw(ground, kFootGroundSignals[4], code);
    FootToe toe_read;
    FootGround ground_read;
    REQUIRE(decode(toe, toe_read) == DecodeResult::kOk);
    REQUIRE(decode(ground, ground_read) == DecodeResult::kOk);
    CHECK(toe_read.moving == (code != 0));
    CHECK(ground_read.contact == (code != 0));
  }
}
