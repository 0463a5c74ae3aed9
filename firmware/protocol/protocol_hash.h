// A number that differs whenever two nodes would read the same bits differently.
#pragma once

#include <cstdint>

#include "firmware/protocol/dictionary.h"

namespace hoof::firmware::protocol {

namespace detail {

/// FNV-1a, 32 bits (Fowler, Noll, Vo).
class Fnv1a {
 public:
  constexpr void add(std::uint32_t value) {
    for (int i = 0; i < 4; ++i) add_byte(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  constexpr void add(float value) { add(__builtin_bit_cast(std::uint32_t, value)); }
  constexpr void add(std::string_view text) {
    for (const char c : text) add_byte(static_cast<std::uint8_t>(c));
    add_byte(0);
  }
  constexpr std::uint32_t value() const { return hash_; }

 private:
  constexpr void add_byte(std::uint8_t byte) { hash_ = (hash_ ^ byte) * 16777619u; }
  std::uint32_t hash_ = 2166136261u;
};

}  // namespace detail

/// Over everything that gives a bit its meaning; comments and periods do not count.
constexpr std::uint32_t compute_protocol_hash() {
  detail::Fnv1a hash;
  for (const MessageSpec& message : kMessages) {
    hash.add(message.name);
    hash.add(message.id);
    hash.add(static_cast<std::uint32_t>(message.length) << 16 | message.buses << 8 | message.crc);
    for (const Signal& signal : message.signals) {
      hash.add(signal.name);
      hash.add(static_cast<std::uint32_t>(signal.first_bit) << 8 | signal.length);
      hash.add(signal.scale);
      hash.add(signal.offset);
      hash.add(signal.unit);
      for (const ValueName& value : signal.values) {
        hash.add(value.value);
        hash.add(value.name);
      }
    }
  }
  return hash.value();
}

inline constexpr std::uint32_t kProtocolHash = compute_protocol_hash();

/// As much of it as a heartbeat has room for.
inline constexpr std::uint32_t kHeartbeatHash = kProtocolHash & 0xFF'FFFFu;

}  // namespace hoof::firmware::protocol
