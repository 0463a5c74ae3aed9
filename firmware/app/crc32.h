// CRC-32 of stored records and of names.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace hoof::firmware::app {

/// The common one (IEEE 802.3, zlib): polynomial 0x04C11DB7 reflected, start and final XOR all
/// ones. A table of 16 entries, half a byte at a time: 64 bytes of flash instead of 1 KB.
class Crc32 {
 public:
  constexpr Crc32& add(std::uint8_t byte) {
    state_ ^= byte;
    for (int half = 0; half < 2; ++half) state_ = (state_ >> 4) ^ kTable[state_ & 0xF];
    return *this;
  }
  constexpr Crc32& add(std::string_view text) {
    for (const char c : text) add(static_cast<std::uint8_t>(c));
    return *this;
  }
  /// Lowest byte first, as a little-endian memory holds it.
  constexpr Crc32& add(std::span<const std::uint32_t> words) {
    for (const std::uint32_t word : words) {
      for (int shift = 0; shift < 32; shift += 8) add(static_cast<std::uint8_t>(word >> shift));
    }
    return *this;
  }

  constexpr std::uint32_t value() const { return ~state_; }

 private:
  static constexpr std::array<std::uint32_t, 16> make_table() {
    std::array<std::uint32_t, 16> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
      table[i] = i;
      for (int bit = 0; bit < 4; ++bit) {
        table[i] = (table[i] >> 1) ^ ((table[i] & 1) != 0 ? 0xEDB8'8320u : 0u);
      }
    }
    return table;
  }
  static const std::array<std::uint32_t, 16> kTable;

  std::uint32_t state_ = 0xFFFF'FFFF;
};

inline constexpr std::array<std::uint32_t, 16> Crc32::kTable = Crc32::make_table();

/// The check value that the catalogue of CRC algorithms gives for CRC-32/ISO-HDLC.
static_assert(Crc32().add("123456789").value() == 0xCBF4'3926);

}  // namespace hoof::firmware::app
