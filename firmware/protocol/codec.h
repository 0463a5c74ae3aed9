// Structs in physical units to CAN frames and back. The only place where a scale factor is applied.
//
// Rules of packing: a value is first limited to the signal's range (so it never wraps), then
// rounded to the nearest code, halves upwards. Not-a-number packs as zero limited to the range.
// Rules of unpacking: identifier, format and length must match the dictionary exactly, and the CRC
// where the message has one; otherwise the struct is left untouched and the reason returned.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

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

/// The 8 classic data bytes as one number, byte 0 most significant. Two instructions a word on the
/// board; byte by byte it was a quarter of the cost of a control tick.
inline std::uint64_t load(const hal::CanFrame& frame) {
  static_assert(std::endian::native == std::endian::little, "the bytes are swapped as a whole");
  std::uint64_t word = 0;
  __builtin_memcpy(&word, frame.data.data(),
                   sizeof word);  // freestanding: std::memcpy would be a call
  return __builtin_bswap64(word);
}

inline void store(hal::CanFrame& frame, std::uint64_t word) {
  word = __builtin_bswap64(word);
  __builtin_memcpy(frame.data.data(), &word, sizeof word);
}

/// Where a signal lies in that number.
struct Place {
  std::uint8_t shift = 0;
  std::uint32_t largest = 0;  // its codes are 0 to this

  friend constexpr bool operator==(const Place&, const Place&) = default;
};

constexpr Place place_of(const Signal& signal) {
  return {static_cast<std::uint8_t>(64u - signal.first_bit - signal.length), signal.largest_raw()};
}

template <typename M>
constexpr std::size_t kFieldCount = std::tuple_size_v<decltype(M::fields())>;

template <typename M>
constexpr std::array<Place, kFieldCount<M>> places_of(const MessageSpec& spec) {
  std::array<Place, kFieldCount<M>> places{};
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = place_of(spec.signals[i]);
  return places;
}

/// Of a message's fields, known to the compiler: a shift of 64 bits by a distance that is not
/// takes ten instructions on the board.
template <typename M>
inline constexpr auto kPlaces = places_of<M>(spec(M::kMessage));
template <>
inline constexpr auto kPlaces<DriveCommand> = places_of<DriveCommand>(command_spec(Drive::kToe));
template <>
inline constexpr auto kPlaces<DriveReply> = places_of<DriveReply>(reply_spec(Drive::kToe));

constexpr bool drives_agree() {
  for (const Drive drive : kDrives) {
    if (places_of<DriveCommand>(command_spec(drive)) != kPlaces<DriveCommand>) return false;
    if (places_of<DriveReply>(reply_spec(drive)) != kPlaces<DriveReply>) return false;
  }
  return true;
}
static_assert(drives_agree(), "one layout for the frames of all drives");

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

template <typename M, std::size_t... kIndex>
std::uint64_t pack_all(const Signal* signals, const M& message, std::index_sequence<kIndex...>) {
  constexpr auto kFields = M::fields();
  constexpr const auto& kAt = kPlaces<M>;
  return (... |
          (static_cast<std::uint64_t>(pack(signals[kIndex], message.*std::get<kIndex>(kFields)))
           << kAt[kIndex].shift));
}

template <typename T>
void unpack_into(T& member, const Signal& signal, const Place& place, std::uint64_t word) {
  member = unpack<T>(signal, static_cast<std::uint32_t>(word >> place.shift) & place.largest);
}

template <typename M, std::size_t... kIndex>
void unpack_all(const Signal* signals, std::uint64_t word, M& message,
                std::index_sequence<kIndex...>) {
  constexpr auto kFields = M::fields();
  constexpr const auto& kAt = kPlaces<M>;
  (unpack_into(message.*std::get<kIndex>(kFields), signals[kIndex], kAt[kIndex], word), ...);
}

template <typename M>
using AllFields = std::make_index_sequence<kFieldCount<M>>;

}  // namespace detail

/// @param spec the message's own, or for a drive's command or reply that of the drive
template <typename M>
hal::CanFrame encode(const MessageSpec& spec, const M& message) {
  hal::CanFrame frame;
  frame.id = spec.id;
  frame.length = spec.length;
  detail::store(frame, detail::pack_all(spec.signals.data(), message, detail::AllFields<M>{}));
  if (spec.crc) frame.data[spec.length - 1u] = crc8(frame);
  return frame;
}

template <typename M>
DecodeResult decode(const MessageSpec& spec, const hal::CanFrame& frame, M& message) {
  const DecodeResult result = check(spec, frame);
  if (result != DecodeResult::kOk) return result;
  detail::unpack_all(spec.signals.data(), detail::load(frame), message, detail::AllFields<M>{});
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
