// The nouns of the message dictionary: a signal and a message, as data that the compiler can read.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace hoof::firmware::protocol {

enum class Node : std::uint8_t {
  kSupervisor = 0,  // gives orders: a person's tool or a test bench
  kSyncMaster,      // gives the beat: the lock-step bridge, or a timer node on a real leg
  kEstopButton,
  kFoot,  // this firmware
  kToeDrive,
  kHipDrive,
  kKneeDrive,
};
inline constexpr std::string_view kNodeNames[] = {"Supervisor", "SyncMaster", "EstopButton", "Foot",
                                                  "ToeDrive",   "HipDrive",   "KneeDrive"};

using BusMask = std::uint8_t;
inline constexpr BusMask kBus0 = 1;  // toe drive, supervisor, telemetry, heartbeat, e-stop
inline constexpr BusMask kBus1 = 2;  // hip and knee drives
inline constexpr int kBusCount = 2;

struct ValueName {
  std::uint32_t value;
  std::string_view name;
};

/// A run of bits and the physical value it carries: value = offset + scale * raw.
/// Bits are counted in the order of the wire: 0 is the most significant bit of byte 0, and a
/// signal's first bit is its most significant one (a DBC file calls this Motorola order).
struct Signal {
  std::string_view name;  // ends in its unit, as every physical name here
  std::uint8_t first_bit = 0;
  std::uint8_t length = 0;  // bits, 1 to 32
  float scale = 1.0f;
  float offset = 0.0f;
  float minimum = 0.0f;
  float maximum = 0.0f;
  std::string_view unit = "";
  std::span<const ValueName> values{};
  std::string_view comment = "";

  constexpr std::uint32_t largest_raw() const {
    return length >= 32 ? 0xFFFFFFFFu : (1u << length) - 1u;
  }
};

struct MessageSpec {
  std::string_view name;
  std::uint32_t id = 0;           // 11 bits; the smaller wins arbitration
  std::uint8_t length = 0;        // bytes
  bool crc = false;               // last byte is the CRC-8 over identifier and payload
  std::uint16_t cycle_ms = 0;     // period in normal running; 0: only on an event
  std::uint16_t shortest_ms = 0;  // shortest period that may occur: what the load is computed with
  Node sender = Node::kFoot;
  Node receiver = Node::kFoot;
  BusMask buses = 0;
  std::span<const Signal> signals{};
  std::string_view comment = "";
};

/// A signal whose codes 0 ... 2^length - 1 are spread evenly from `minimum` to `maximum`, both
/// included: the packing of mini-cheetah and T-Motor drives.
constexpr Signal spread(std::string_view name, int first_bit, int length, float minimum,
                        float maximum, std::string_view unit, std::string_view comment = "") {
  const double codes = static_cast<double>((1ULL << length) - 1);
  return {.name = name,
          .first_bit = static_cast<std::uint8_t>(first_bit),
          .length = static_cast<std::uint8_t>(length),
          .scale = static_cast<float>((double{maximum} - double{minimum}) / codes),
          .offset = minimum,
          .minimum = minimum,
          .maximum = maximum,
          .unit = unit,
          .comment = comment};
}

/// A signal with a chosen step; its range follows from the step and the number of bits.
constexpr Signal stepped(std::string_view name, int first_bit, int length, float step, float offset,
                         std::string_view unit, std::string_view comment = "") {
  const double codes = static_cast<double>((1ULL << length) - 1);
  return {.name = name,
          .first_bit = static_cast<std::uint8_t>(first_bit),
          .length = static_cast<std::uint8_t>(length),
          .scale = step,
          .offset = offset,
          .minimum = offset,
          .maximum = static_cast<float>(double{offset} + double{step} * codes),
          .unit = unit,
          .comment = comment};
}

/// A whole number, a set of bits, or one of named values.
constexpr Signal number(std::string_view name, int first_bit, int length,
                        std::string_view comment = "", std::span<const ValueName> values = {}) {
  Signal signal = stepped(name, first_bit, length, 1.0f, 0.0f, "", comment);
  signal.values = values;
  return signal;
}

}  // namespace hoof::firmware::protocol
