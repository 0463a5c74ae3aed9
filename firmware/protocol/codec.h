// Structs in physical units to CAN frames and back. The only place where a scale factor is applied.
//
// Rules of packing: a value is first limited to the signal's range (so it never wraps), then
// rounded to the nearest code, halves upwards. Not-a-number packs as zero limited to the range.
// Rules of unpacking: identifier, format and length must match the dictionary exactly, and the CRC
// where the message has one; otherwise the struct is left untouched and the reason returned.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>

#include "firmware/protocol/messages.h"
#include "hal/can_frame.h"

namespace hoof::firmware::protocol {

enum class DecodeResult : std::uint8_t {
  kOk = 0,
  kWrongIdentifier,
  kWrongFormat,  // extended, remote, FD or error frame: none is part of the dictionary
  kWrongLength,
  kBadCrc,
};

/// Raw code of a signal in a payload; `signal` must lie inside the 8 classic data bytes.
std::uint32_t raw_of(const hal::CanFrame& frame, const Signal& signal);
void set_raw(hal::CanFrame& frame, const Signal& signal, std::uint32_t raw);

/// Limits and rounds as stated above.
std::uint32_t raw_from_value(const Signal& signal, float value);
float value_from_raw(const Signal& signal, std::uint32_t raw);

/// CRC-8/AUTOSAR (polynomial 0x2F, initial and final XOR 0xFF) over the identifier, low byte first,
/// and all payload bytes but the last. Hamming distance 4 up to 119 bits, so any three wrong bits
/// of a frame are seen; the identifier is included so that a message under another's name fails.
std::uint8_t crc8(const hal::CanFrame& frame);

/// Checks everything but the meaning: identifier, format, length, CRC.
DecodeResult check(const MessageSpec& spec, const hal::CanFrame& frame);

namespace detail {

template <typename T>
std::uint32_t pack(const Signal& signal, T value) {
  if constexpr (std::floating_point<T>) {
    return raw_from_value(signal, value);
  } else {
    const auto raw = static_cast<std::uint32_t>(value);
    return raw > signal.largest_raw() ? signal.largest_raw() : raw;
  }
}

template <typename T>
T unpack(const Signal& signal, std::uint32_t raw) {
  if constexpr (std::floating_point<T>) {
    return value_from_raw(signal, raw);
  } else if constexpr (std::same_as<T, bool>) {
    return raw != 0;
  } else {
    return static_cast<T>(raw);
  }
}

template <typename M>
constexpr std::size_t kFieldCount = std::tuple_size_v<decltype(M::fields())>;

}  // namespace detail

template <typename M>
hal::CanFrame encode(const MessageSpec& spec, const M& message) {
  hal::CanFrame frame;
  frame.id = spec.id;
  frame.length = spec.length;
  const Signal* signal = spec.signals.data();
  const auto put = [&](auto value) {
    set_raw(frame, *signal, detail::pack(*signal, value));
    ++signal;
  };
  std::apply([&](auto... field) { (put(message.*field), ...); }, M::fields());
  if (spec.crc) frame.data[spec.length - 1u] = crc8(frame);
  return frame;
}

template <typename M>
DecodeResult decode(const MessageSpec& spec, const hal::CanFrame& frame, M& message) {
  const DecodeResult result = check(spec, frame);
  if (result != DecodeResult::kOk) return result;
  const Signal* signal = spec.signals.data();
  const auto take = [&](auto& member) {
    using T = std::remove_reference_t<decltype(member)>;
    member = detail::unpack<T>(*signal, raw_of(frame, *signal));
    ++signal;
  };
  std::apply([&](auto... field) { (take(message.*field), ...); }, M::fields());
  return DecodeResult::kOk;
}

/// For messages with an identifier of their own (all but drive commands and replies).
template <typename M>
hal::CanFrame encode(const M& message) {
  constexpr const MessageSpec& kSpec = spec(M::kMessage);
  static_assert(kSpec.signals.size() == detail::kFieldCount<M> + (kSpec.crc ? 1 : 0));
  return encode(kSpec, message);
}

template <typename M>
DecodeResult decode(const hal::CanFrame& frame, M& message) {
  return decode(spec(M::kMessage), frame, message);
}

/// The three special frames of the AK and mini-cheetah command: FF FF FF FF FF FF FF and this byte.
enum class DriveSwitch : std::uint8_t { kEnter = 0xFC, kExit = 0xFD, kSetZero = 0xFE };

hal::CanFrame encode_switch(Drive drive, DriveSwitch action);

/// Never yields one of the special frames: the one command whose codes would read as such (all
/// values at their upper end) gets the next lower torque code.
///
/// Zero torque: 12 bits spread over -T ... +T have no code at zero. Zero packs as code 2048, which
/// stands for +T/4095: 5.9 mNm on the toe, 98 mNm on hip and knee; friction of the gears is larger
/// (50 mNm, 2 Nm). True zero is the exit frame. The velocity is alike: +V/4095, 11 and 4.9 mrad/s.
hal::CanFrame encode_command(Drive drive, const DriveCommand& command);

/// What a drive makes of a command frame: a switch, or a command.
struct DriveOrder {
  std::optional<DriveSwitch> action;
  DriveCommand command;
};
DecodeResult decode_command(Drive drive, const hal::CanFrame& frame, DriveOrder& order);

constexpr std::uint8_t drive_id(Drive drive) {
  return static_cast<std::uint8_t>(index(drive) + 1);
}

hal::CanFrame encode_reply(Drive drive, DriveReply reply);

/// kWrongIdentifier also where the drive number inside the reply is not the drive's.
DecodeResult decode_reply(Drive drive, const hal::CanFrame& frame, DriveReply& reply);

}  // namespace hoof::firmware::protocol
