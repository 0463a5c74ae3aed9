#include "firmware/update/field25519.h"

#include <cstddef>

namespace hoof::firmware::update {
namespace {

constexpr std::uint32_t kFold = 38;  // 2^256 modulo p

/// value += small; @return the carry out of 256 bits
std::uint32_t add_small(Field& value, std::uint32_t small) {
  std::uint64_t carry = small;
  for (std::uint32_t& w : value.word) {
    carry += w;
    w = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  return static_cast<std::uint32_t>(carry);
}

/// Adds carry * 2^256, twice at most: after a carry the value is small.
void fold(Field& value, std::uint32_t carry) {
  carry = add_small(value, carry * kFold);
  add_small(value, carry * kFold);
}

/// z to the number of `bits` ones in binary, but for the zeros of `clear` at its lower end.
Field power_of_ones(const Field& z, int bits, std::uint32_t clear) {
  Field result = z;
  for (int bit = bits - 2; bit >= 0; --bit) {
    result = result * result;
    if (bit >= 32 || (clear >> bit & 1) == 0) result = result * z;
  }
  return result;
}

}  // namespace

Field operator+(const Field& a, const Field& b) {
  Field sum;
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    carry += std::uint64_t{a.word[i]} + b.word[i];
    sum.word[i] = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  fold(sum, static_cast<std::uint32_t>(carry));
  return sum;
}

Field operator-(const Field& a, const Field& b) {
  Field difference;
  std::uint32_t borrow = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const std::uint64_t d = std::uint64_t{a.word[i]} - b.word[i] - borrow;
    difference.word[i] = static_cast<std::uint32_t>(d);
    borrow = static_cast<std::uint32_t>(d >> 63);
  }
  // A borrow is one 2^256 too many: 38 less, and once more where that borrows again.
  for (int i = 0; i < 2; ++i) {
    std::uint64_t take = borrow * kFold;
    borrow = 0;
    for (std::uint32_t& w : difference.word) {
      const std::uint64_t d = std::uint64_t{w} - take;
      w = static_cast<std::uint32_t>(d);
      take = d >> 63;
    }
    borrow = static_cast<std::uint32_t>(take);
  }
  return difference;
}

Field operator*(const Field& a, const Field& b) {
  std::array<std::uint32_t, 16> product{};
  for (std::size_t i = 0; i < 8; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < 8; ++j) {
      // (2^32 - 1)^2 + 2 (2^32 - 1) = 2^64 - 1: it fits.
      carry += std::uint64_t{a.word[i]} * b.word[j] + product[i + j];
      product[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    product[i + 8] = static_cast<std::uint32_t>(carry);
  }
  Field result;
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    carry += std::uint64_t{product[i + 8]} * kFold + product[i];
    result.word[i] = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  fold(result, static_cast<std::uint32_t>(carry));
  return result;
}

Field Field::canonical() const {
  Field value = *this;
  // Below 2^255 + 19, then below p: p is taken where 19 more reach 2^255.
  for (int i = 0; i < 2; ++i) {
    const std::uint32_t top = value.word[7] >> 31;
    value.word[7] &= 0x7FFF'FFFF;
    add_small(value, 19 * top);
  }
  Field more = value;
  add_small(more, 19);
  if ((more.word[7] >> 31) == 0) return value;
  more.word[7] &= 0x7FFF'FFFF;
  return more;
}

bool Field::is_zero() const {
  std::uint32_t any = 0;
  for (const std::uint32_t w : canonical().word) any |= w;
  return any == 0;
}

bool operator==(const Field& a, const Field& b) {
  return (a - b).is_zero();
}

Field inverse(const Field& z) {
  return power_of_ones(z, 255, 0b10100);  // 2^255 - 1 - 20
}

Field power_for_root(const Field& z) {
  return power_of_ones(z, 252, 0b10);  // 2^252 - 1 - 2
}

}  // namespace hoof::firmware::update
