// Our verifier against the RFC's vectors and against libsodium, which also makes the signatures.
#include "firmware/update/ed25519.h"

#include <sodium.h>

#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

using namespace hoof::firmware::update;
using Bytes = std::vector<std::uint8_t>;
using Scalar = std::array<std::uint8_t, 32>;

namespace {

Bytes from_hex(std::string_view text) {
  Bytes bytes(text.size() / 2);
  REQUIRE(sodium_hex2bin(bytes.data(), bytes.size(), text.data(), text.size(), nullptr, nullptr,
                         nullptr) == 0);
  return bytes;
}

template <std::size_t N>
std::array<std::uint8_t, N> array_of(const Bytes& bytes) {
  std::array<std::uint8_t, N> array;
  REQUIRE(bytes.size() == N);
  std::copy(bytes.begin(), bytes.end(), array.begin());
  return array;
}

bool sodium_verifies(const Signature& signature, const PublicKey& key, const Bytes& message) {
  return crypto_sign_verify_detached(signature.data(), message.data(), message.size(),
                                     key.data()) == 0;
}

struct Signed {
  PublicKey key;
  Signature signature;
  Bytes message;

  bool ours() const { return Verification(signature, key).add(message).good(); }
  bool theirs() const { return sodium_verifies(signature, key, message); }
};

Signed random_signed(std::mt19937& random) {
  std::array<std::uint8_t, crypto_sign_SEEDBYTES> seed;
  for (auto& b : seed) b = std::uint8_t(random());
  std::array<std::uint8_t, crypto_sign_SECRETKEYBYTES> secret;
  Signed s;
  crypto_sign_seed_keypair(s.key.data(), secret.data(), seed.data());
  s.message.resize(random() % 300);
  for (auto& b : s.message) b = std::uint8_t(random());
  crypto_sign_detached(s.signature.data(), nullptr, s.message.data(), s.message.size(),
                       secret.data());
  return s;
}

/// S + L, which stands for the same scalar: a signature of a second form.
Signature with_order_added(Signature signature) {
  const Bytes L = from_hex("edd3f55c1a631258d69cf7a2def9de1400000000000000000000000000000010");
  int carry = 0;
  for (std::size_t i = 0; i < 32; ++i) {
    carry += signature[32 + i] + L[i];
    signature[32 + i] = std::uint8_t(carry);
    carry >>= 8;
  }
  return signature;
}

}  // namespace

TEST_CASE("ed25519: test vectors of RFC 8032, 7.1") {
  struct Vector {
    const char *key, *message, *signature;
  };
  const Vector vectors[] = {
      {"d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a", "",
       "e5564300c360ac729086e2cc806e828a84877f1eb8e5d974d873e065224901555fb8821590a33bacc61e39701cf"
       "9b4"
       "6bd25bf5f0595bbe24655141438e7a100b"},
      {"3d4017c3e843895a92b70aa74d1b7ebc9c982ccf2ec4968cc0cd55f12af4660c", "72",
       "92a009a9f0d4cab8720e820b5f642540a2b27b5416503f8fb3762223ebdb69da085ac1e43e15996e458f3613d0f"
       "11d"
       "8c387b2eaeb4302aeeb00d291612bb0c00"},
      {"fc51cd8e6218a1a38da47ed00230f0580816ed13ba3303ac5deb911548908025", "af82",
       "6291d657deec24024827e69c3abe01a30ce548a284743a445e3680d7db5ac3ac18ff9b538d16f290ae67f760984"
       "dc6"
       "594a7c15e9716ed28dc027beceea1ec40a"},
      {"ec172b93ad5e563bf4932c70e1245034c35467ef2efd4d64ebf819683467e2bf",
       "ddaf35a193617abacc417349ae20413112e6fa4e89a97ea20a9eeee64b55d39a"
       "2192992a274fc1a836ba3c23a3feebbd454d4423643ce80e2a9ac94fa54ca49f",
       "dc2a4459e7369633a52b1bf277839a00201009a3efbf3ecb69bea2186c26b58909351fc9ac90b3ecfdfbc7c6643"
       "1e0"
       "303dca179c138ac17ad9bef1177331a704"}};
  for (const Vector& v : vectors) {
    CAPTURE(v.key);
    const Signed s{array_of<32>(from_hex(v.key)), array_of<64>(from_hex(v.signature)),
                   from_hex(v.message)};
    CHECK(s.theirs());  // the vector was copied right
    CHECK(s.ours());
  }
}

TEST_CASE("ed25519: what libsodium signs is accepted, in one piece or two") {
  std::mt19937 random(4);
  for (int i = 0; i < 150; ++i) {
    const Signed s = random_signed(random);
    CAPTURE(i, s.message.size());
    REQUIRE(s.theirs());
    REQUIRE(s.ours());
    const std::span<const std::uint8_t> all(s.message);
    const std::size_t cut = random() % (all.size() + 1);
    REQUIRE(Verification(s.signature, s.key).add(all.first(cut)).add(all.subspan(cut)).good());
  }
}

TEST_CASE("ed25519: one flipped bit anywhere is refused") {
  std::mt19937 random(5);
  Signed s = random_signed(random);
  s.message.resize(0);  // signed below: few bits to flip
  std::array<std::uint8_t, 32> seed{7};
  std::array<std::uint8_t, 64> secret;
  crypto_sign_seed_keypair(s.key.data(), secret.data(), seed.data());
  s.message = {1, 2, 3};
  crypto_sign_detached(s.signature.data(), nullptr, s.message.data(), 3, secret.data());
  REQUIRE(s.ours());
  const auto flip_each = [&](auto member) {
    for (std::size_t bit = 0; bit < 8 * (s.*member).size(); ++bit) {
      Signed other = s;
      (other.*member)[bit / 8] ^= std::uint8_t(1 << (bit % 8));
      CAPTURE(bit);
      REQUIRE_FALSE(other.theirs());
      REQUIRE_FALSE(other.ours());
    }
  };
  flip_each(&Signed::signature);
  flip_each(&Signed::key);
  flip_each(&Signed::message);
}

TEST_CASE("ed25519: a second form of S is refused") {
  std::mt19937 random(6);
  for (int i = 0; i < 10; ++i) {
    Signed s = random_signed(random);
    s.signature = with_order_added(s.signature);
    REQUIRE_FALSE(s.theirs());
    REQUIRE_FALSE(s.ours());
  }
}

// Keys and R of small order: with them S = 0 fits many messages, or all.
TEST_CASE("ed25519: points of small order are refused, in each way of writing them") {
  const char* points[] = {
      "0100000000000000000000000000000000000000000000000000000000000000",   // order 1
      "0100000000000000000000000000000000000000000000000000000000000080",   // the same, sign of 0
      "ecffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",   // order 2
      "0000000000000000000000000000000000000000000000000000000000000000",   // order 4
      "0000000000000000000000000000000000000000000000000000000000000080",   // order 4
      "26e8958fc2b227b045c3f489f2ef98f0d5dfac05d3c63339b13802886d53fc05",   // order 8
      "c7176a703d4dd84fba3c0b760d10670f2a2053fa2c39ccc64ec7fd7792ac037a",   // order 8
      "edffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",   // p: 0 otherwise
      "eeffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f"};  // p + 1: 1 otherwise
  for (const char* key : points) {
    for (const char* r : points) {
      Signed s{array_of<32>(from_hex(key)), {}, {}};
      const Bytes R = from_hex(r);
      std::copy(R.begin(), R.end(), s.signature.begin());
      for (std::uint8_t m = 0; m < 16; ++m) {
        s.message = {m};
        REQUIRE_FALSE(s.theirs());
        REQUIRE_FALSE(s.ours());
      }
    }
  }
}

// The equation holds for both: only the refusal of small order stands in the way.
TEST_CASE("ed25519: forged by a neutral key, and signed with a neutral R") {
  std::mt19937 random(7);
  Scalar s{}, a{};
  for (auto& b : s) b = std::uint8_t(random());
  for (auto& b : a) b = std::uint8_t(random());
  s[31] = a[31] = 1;  // below L
  Signed by_neutral_key{{1}, {}, {1, 2, 3}};
  crypto_scalarmult_ed25519_base_noclamp(by_neutral_key.signature.data(), s.data());
  std::copy(s.begin(), s.end(), by_neutral_key.signature.begin() + 32);
  CHECK_FALSE(by_neutral_key.theirs());
  CHECK_FALSE(by_neutral_key.ours());

  Signed with_neutral_r{{}, {1}, {1, 2, 3}};
  crypto_scalarmult_ed25519_base_noclamp(with_neutral_r.key.data(), a.data());
  Bytes hashed(with_neutral_r.signature.begin(), with_neutral_r.signature.begin() + 32);
  hashed.insert(hashed.end(), with_neutral_r.key.begin(), with_neutral_r.key.end());
  hashed.insert(hashed.end(), with_neutral_r.message.begin(), with_neutral_r.message.end());
  std::array<std::uint8_t, 64> digest;
  crypto_hash_sha512(digest.data(), hashed.data(), hashed.size());
  Scalar k{}, S{};
  crypto_core_ed25519_scalar_reduce(k.data(), digest.data());
  crypto_core_ed25519_scalar_mul(S.data(), k.data(), a.data());
  std::copy(S.begin(), S.end(), with_neutral_r.signature.begin() + 32);
  CHECK_FALSE(with_neutral_r.theirs());
  CHECK_FALSE(with_neutral_r.ours());
}

TEST_CASE("ed25519: at random bytes it says what libsodium says") {
  std::mt19937 random(8);
  for (int i = 0; i < 200; ++i) {
    Signed s = random_signed(random);
    switch (random() % 3) {
      case 0:
        for (auto& b : s.key) b = std::uint8_t(random());
        break;
      case 1:
        for (std::size_t k = 0; k < 32; ++k) s.signature[k] = std::uint8_t(random());
        break;
      default:
        for (std::size_t k = 32; k < 64; ++k) s.signature[k] = std::uint8_t(random() % 16);
    }
    CAPTURE(i);
    REQUIRE(s.ours() == s.theirs());
  }
}
