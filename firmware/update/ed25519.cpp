// Symbols as in RFC 8032, 5.1: the curve -x^2 + y^2 = 1 + d x^2 y^2 modulo p = 2^255 - 19, base
// point B of prime order L; A the key's point, (R, S) the signature, k the hash.
#include "firmware/update/ed25519.h"

#include <cstddef>

#include "firmware/update/field25519.h"

namespace hoof::firmware::update {
namespace {

/// x = X/Z, y = Y/Z, x y = T/Z (5.1.4).
struct Point {
  Field X, Y, Z, T;
};

using Scalar = std::array<std::uint32_t, 8>;

constexpr Field kOne{{1}};
constexpr Field kD{{0x135978A3, 0x75EB4DCA, 0x4141D8AB, 0x00700A4D, 0x7779E898, 0x8CC74079,
                    0x2B6FFE73, 0x52036CEE}};
constexpr Field kTwoD{{0x26B2F159, 0xEBD69B94, 0x8283B156, 0x00E0149A, 0xEEF3D130, 0x198E80F2,
                       0x56DFFCE7, 0x2406D9DC}};
constexpr Field kRootOfMinusOne{{0x4A0EA0B0, 0xC4EE1B27, 0xAD2FE478, 0x2F431806, 0x3DFBD7A7,
                                 0x2B4D0099, 0x4FC1DF0B, 0x2B832480}};
constexpr Point kB{{{0x8F25D51A, 0xC9562D60, 0x9525A7B2, 0x692CC760, 0xFDD6DC5C, 0xC0A4E231,
                     0xCD6E53FE, 0x216936D3}},
                   {{0x66666658, 0x66666666, 0x66666666, 0x66666666, 0x66666666, 0x66666666,
                     0x66666666, 0x66666666}},
                   kOne,
                   {{0xA5B7DDA3, 0x6DDE8AB3, 0x775152F5, 0x20F09F80, 0x64ABE37D, 0x66EA4E8E,
                     0xD78B7665, 0x67875F0F}}};
constexpr Scalar kL = {0x5CF5D3ED, 0x5812631A, 0xA2F79CD6, 0x14DEF9DE, 0, 0, 0, 0x10000000};

/// 5.1.4; complete: it holds for equal points and for the neutral one, too.
void add(Point& p, const Point& q) {
  const Field A = (p.Y - p.X) * (q.Y - q.X);
  const Field B = (p.Y + p.X) * (q.Y + q.X);
  const Field C = p.T * kTwoD * q.T;
  const Field ZZ = p.Z * q.Z;
  const Field D = ZZ + ZZ;
  const Field E = B - A, F = D - C, G = D + C, H = B + A;
  p = {E * F, G * H, F * G, E * H};
}

void twice(Point& p) {
  const Field A = p.X * p.X, B = p.Y * p.Y, ZZ = p.Z * p.Z;
  const Field C = ZZ + ZZ, H = A + B;
  const Field XY = p.X + p.Y;
  const Field E = H - XY * XY, G = A - B, F = C + G;
  p = {E * F, G * H, F * G, E * H};
}

bool is_neutral(const Point& p) {
  return p.X.is_zero() && p.Y == p.Z;
}

/// The points whose order divides the cofactor 8.
bool of_small_order(Point p) {
  for (int i = 0; i < 3; ++i) twice(p);
  return is_neutral(p);
}

std::array<std::uint32_t, 8> words_of(std::span<const std::uint8_t, 32> bytes) {
  std::array<std::uint32_t, 8> words{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    words[i / 4] |= std::uint32_t{bytes[i]} << (8 * (i % 4));
  }
  return words;
}

/// 5.1.3. @return false where the bytes are no point, or one written otherwise than encode() does
bool decode(std::span<const std::uint8_t, 32> bytes, Point& p) {
  Field y{words_of(bytes)};
  const bool odd = (y.word[7] >> 31) != 0;
  y.word[7] &= 0x7FFF'FFFF;
  if (y.canonical().word != y.word) return false;
  // x^2 = u / v; x = u v^3 (u v^7)^((p - 5) / 8), or that times the root of -1.
  const Field yy = y * y;
  const Field u = yy - kOne, v = kD * yy + kOne;
  const Field v3 = v * v * v;
  Field x = u * v3 * power_for_root(u * v3 * v3 * v);
  const Field vxx = v * x * x;
  if (!(vxx == u)) {
    if (!(vxx == Field{} - u)) return false;
    x = x * kRootOfMinusOne;
  }
  if (x.is_zero() && odd) return false;
  if (x.is_odd() != odd) x = Field{} - x;
  p = {x, y, kOne, x * y};
  return true;
}

/// 5.1.2
std::array<std::uint8_t, 32> encode(const Point& p) {
  const Field inverse_Z = inverse(p.Z);
  Field y = (p.Y * inverse_Z).canonical();
  if ((p.X * inverse_Z).is_odd()) y.word[7] |= 1u << 31;
  std::array<std::uint8_t, 32> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(y.word[i / 4] >> (8 * (i % 4)));
  }
  return bytes;
}

/// a -= L where a >= L. @return whether it was
bool take_order(Scalar& a) {
  Scalar less;
  std::uint32_t borrow = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::uint64_t d = std::uint64_t{a[i]} - kL[i] - borrow;
    less[i] = static_cast<std::uint32_t>(d);
    borrow = static_cast<std::uint32_t>(d >> 63);
  }
  if (borrow != 0) return false;
  a = less;
  return true;
}

/// A 512-bit number, lowest byte first, modulo L: bit after bit from the top. L is below 2^253, so
/// that twice a remainder fits.
Scalar modulo_order(const Sha512::Digest& number) {
  Scalar r{};
  for (std::size_t bit = 512; bit-- > 0;) {
    std::uint32_t carry = number[bit / 8] >> (bit % 8) & 1;
    for (std::uint32_t& w : r) {
      const std::uint32_t top = w >> 31;
      w = w << 1 | carry;
      carry = top;
    }
    take_order(r);
  }
  return r;
}

/// [s]B + [k]Q, both at once (Straus); Q is -A.
Point combine(const Scalar& s, const Scalar& k, const Point& Q) {
  Point both = kB;
  add(both, Q);
  Point sum{{}, kOne, kOne, {}};
  for (std::size_t bit = 256; bit-- > 0;) {
    twice(sum);
    const bool in_s = (s[bit / 32] >> (bit % 32) & 1) != 0;
    const bool in_k = (k[bit / 32] >> (bit % 32) & 1) != 0;
    if (in_s || in_k) add(sum, in_s && in_k ? both : in_s ? kB : Q);
  }
  return sum;
}

}  // namespace

Verification::Verification(const Signature& signature, const PublicKey& key)
    : signature_(signature), key_(key) {
  hash_.add(std::span(signature_).first<32>()).add(key_);
}

bool Verification::good() {
  const std::span<const std::uint8_t, 64> both(signature_);
  const auto R = both.first<32>();
  const Scalar S = words_of(both.last<32>());
  Scalar reduced = S;
  if (take_order(reduced)) return false;
  Point A;
  if (!decode(key_, A) || of_small_order(A)) return false;
  const Scalar k = modulo_order(hash_.finish());
  A.X = Field{} - A.X;
  A.T = Field{} - A.T;
  const Point sum = combine(S, k, A);
  if (of_small_order(sum)) return false;
  const auto ours = encode(sum);
  std::uint8_t different = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    different = static_cast<std::uint8_t>(different | (ours[i] ^ R[i]));
  }
  return different == 0;
}

}  // namespace hoof::firmware::update
