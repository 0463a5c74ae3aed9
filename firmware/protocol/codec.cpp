#include "firmware/protocol/codec.h"

#include <algorithm>
#include <bit>

namespace hoof::firmware::protocol {
namespace {

using Frame = hal::CanFrame;

static_assert(std::endian::native == std::endian::little, "the bytes are swapped as a whole");

/// The 8 classic data bytes as one number, byte 0 most significant. Two instructions a word on the
/// board; byte by byte it was a quarter of the cost of a control tick.
std::uint64_t load(const Frame& frame) {
  std::uint64_t word = 0;
  __builtin_memcpy(&word, frame.data.data(),
                   sizeof word);  // freestanding: std::memcpy would be a call
  return __builtin_bswap64(word);
}

void store(Frame& frame, std::uint64_t word) {
  word = __builtin_bswap64(word);
  __builtin_memcpy(frame.data.data(), &word, sizeof word);
}

unsigned shift_of(const Signal& signal) {
  return 64u - signal.first_bit - signal.length;
}

std::uint8_t crc8_byte(std::uint8_t crc, std::uint8_t byte) {
  constexpr unsigned kPolynomial = 0x2F;
  unsigned value = crc ^ byte;
  for (int bit = 0; bit < 8; ++bit) {
    value = (value & 0x80u) != 0 ? value << 1 ^ kPolynomial : value << 1;
  }
  return static_cast<std::uint8_t>(value);
}

bool is_switch(const Frame& frame) {
  for (std::size_t i = 0; i < 7; ++i) {
    if (frame.data[i] != 0xFF) return false;
  }
  return frame.data[7] >= static_cast<std::uint8_t>(DriveSwitch::kEnter) &&
         frame.data[7] <= static_cast<std::uint8_t>(DriveSwitch::kSetZero);
}

}  // namespace

std::uint32_t raw_of(const Frame& frame, const Signal& signal) {
  return static_cast<std::uint32_t>(load(frame) >> shift_of(signal)) & signal.largest_raw();
}

void set_raw(Frame& frame, const Signal& signal, std::uint32_t raw) {
  const std::uint64_t mask = static_cast<std::uint64_t>(signal.largest_raw()) << shift_of(signal);
  const std::uint64_t bits = static_cast<std::uint64_t>(raw) << shift_of(signal) & mask;
  store(frame, (load(frame) & ~mask) | bits);
}

std::uint32_t raw_from_value(const Signal& signal, float value) {
  if (!(value == value)) value = 0.0f;
  value = std::clamp(value, signal.minimum, signal.maximum);
  const float code = (value - signal.offset) / signal.scale + 0.5f;
  const float largest = static_cast<float>(signal.largest_raw());
  return code >= largest ? signal.largest_raw() : static_cast<std::uint32_t>(code);
}

float value_from_raw(const Signal& signal, std::uint32_t raw) {
  return signal.offset + signal.scale * static_cast<float>(raw);
}

std::uint8_t crc8(const Frame& frame) {
  std::uint8_t crc = 0xFF;
  crc = crc8_byte(crc, static_cast<std::uint8_t>(frame.id));
  crc = crc8_byte(crc, static_cast<std::uint8_t>(frame.id >> 8));
  for (std::size_t i = 0; i + 1 < frame.length; ++i) crc = crc8_byte(crc, frame.data[i]);
  return crc ^ 0xFF;
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
  std::fill_n(frame.data.begin(), 7, std::uint8_t{0xFF});
  frame.data[7] = static_cast<std::uint8_t>(action);
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
