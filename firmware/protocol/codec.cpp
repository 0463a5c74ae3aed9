#include "firmware/protocol/codec.h"

#include <array>

namespace hoof::firmware::protocol {
namespace {

using Frame = hal::CanFrame;

using detail::load;
using detail::store;

/// What the polynomial makes of four bits: the remainder of each, shifted out at the top.
constexpr std::array<std::uint8_t, 16> crc8_table() {
  constexpr unsigned kPolynomial = 0x2F;
  std::array<std::uint8_t, 16> table{};
  for (unsigned nibble = 0; nibble < table.size(); ++nibble) {
    unsigned value = nibble << 4;
    for (int bit = 0; bit < 4; ++bit) {
      value = (value & 0x80u) != 0 ? value << 1 ^ kPolynomial : value << 1;
    }
    table[nibble] = static_cast<std::uint8_t>(value);
  }
  return table;
}
/// Sixteen bytes, one line of the board's flash.
alignas(16) constexpr std::array<std::uint8_t, 16> kCrc8 = crc8_table();

unsigned crc8_byte(unsigned crc, std::uint8_t byte) {
  crc ^= byte;
  crc = (crc << 4 & 0xFFu) ^ kCrc8[crc >> 4];
  return (crc << 4 & 0xFFu) ^ kCrc8[crc >> 4];
}

bool is_switch(const Frame& frame) {
  if (load(frame) >> 8 != ~std::uint64_t{0} >> 8) return false;
  return frame.data[7] >= static_cast<std::uint8_t>(DriveSwitch::kEnter) &&
         frame.data[7] <= static_cast<std::uint8_t>(DriveSwitch::kSetZero);
}

}  // namespace

std::uint32_t raw_of(const Frame& frame, const Signal& signal) {
  return static_cast<std::uint32_t>(load(frame) >> detail::place_of(signal).shift) &
         signal.largest_raw();
}

void set_raw(Frame& frame, const Signal& signal, std::uint32_t raw) {
  const unsigned shift = detail::place_of(signal).shift;
  const std::uint64_t mask = static_cast<std::uint64_t>(signal.largest_raw()) << shift;
  const std::uint64_t bits = static_cast<std::uint64_t>(raw) << shift & mask;
  store(frame, (load(frame) & ~mask) | bits);
}

std::uint32_t raw_from_value(const Signal& signal, float value) {
  if (!(value == value)) value = 0.0f;
  value = value < signal.minimum ? signal.minimum : value;
  value = value > signal.maximum ? signal.maximum : value;
  const float code = (value - signal.offset) / signal.scale + 0.5f;
  const std::uint32_t largest = signal.largest_raw();
  return code >= static_cast<float>(largest) ? largest : static_cast<std::uint32_t>(code);
}

float value_from_raw(const Signal& signal, std::uint32_t raw) {
  return signal.offset + signal.scale * static_cast<float>(raw);
}

std::uint8_t crc8(const Frame& frame) {
  unsigned crc = 0xFF;
  crc = crc8_byte(crc, static_cast<std::uint8_t>(frame.id));
  crc = crc8_byte(crc, static_cast<std::uint8_t>(frame.id >> 8));
  for (std::size_t i = 0; i + 1 < frame.length; ++i) crc = crc8_byte(crc, frame.data[i]);
  return static_cast<std::uint8_t>(crc ^ 0xFF);
}

DecodeResult check(const MessageSpec& spec, const Frame& frame) {
  if (frame.extended || frame.remote || frame.error || frame.fd) return DecodeResult::kWrongFormat;
  if (frame.id != spec.id) return DecodeResult::kWrongIdentifier;
  if (frame.length != spec.length) return DecodeResult::kWrongLength;
  if (spec.crc && frame.data[spec.length - 1u] != crc8(frame)) return DecodeResult::kBadCrc;
  return DecodeResult::kOk;
}

Frame encode_switch(Drive drive, DriveSwitch action) {
  Frame frame;
  frame.id = command_spec(drive).id;
  frame.length = command_spec(drive).length;
  store(frame, ~std::uint64_t{0xFF} | static_cast<std::uint8_t>(action));
  return frame;
}

Frame encode_command(Drive drive, const DriveCommand& command) {
  Frame frame = encode(command_spec(drive), command);
  if (is_switch(frame)) frame.data[7] = static_cast<std::uint8_t>(DriveSwitch::kEnter) - 1;
  return frame;
}

DecodeResult decode_command(Drive drive, const Frame& frame, DriveOrder& order) {
  const DecodeResult result = decode(command_spec(drive), frame, order.command);
  if (result != DecodeResult::kOk) return result;
  order.action.reset();
  if (is_switch(frame)) {
    order.action = static_cast<DriveSwitch>(frame.data[7]);
    order.command = {};
  }
  return DecodeResult::kOk;
}

Frame encode_reply(Drive drive, DriveReply reply) {
  reply.drive_id = drive_id(drive);
  return encode(reply_spec(drive), reply);
}

DecodeResult decode_reply(Drive drive, const Frame& frame, DriveReply& reply) {
  DriveReply candidate;
  const DecodeResult result = decode(reply_spec(drive), frame, candidate);
  if (result != DecodeResult::kOk) return result;
  if (candidate.drive_id != drive_id(drive)) return DecodeResult::kWrongIdentifier;
  reply = candidate;
  return DecodeResult::kOk;
}

}  // namespace hoof::firmware::protocol
