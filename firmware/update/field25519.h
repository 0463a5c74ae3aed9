// Numbers modulo p = 2^255 - 19.
#pragma once

#include <array>
#include <cstdint>

namespace hoof::firmware::update {

/// Eight 32-bit words, the lowest first. Between operations any value below 2^256 stands for its
/// remainder (2^256 = 38 modulo p); canonical() brings it below p.
struct Field {
  std::array<std::uint32_t, 8> word{};

  Field canonical() const;
  bool is_zero() const;
  bool is_odd() const { return (canonical().word[0] & 1) != 0; }
};

bool operator==(const Field& a, const Field& b);
Field operator+(const Field& a, const Field& b);
Field operator-(const Field& a, const Field& b);
Field operator*(const Field& a, const Field& b);

/// z^(2^255 - 21) = 1 / z (Fermat); 0 for 0.
Field inverse(const Field& z);
/// z^(2^252 - 3), from which a square root of a fraction comes (RFC 8032, 5.1.3).
Field power_for_root(const Field& z);

}  // namespace hoof::firmware::update
