#include "firmware/update/sha512.h"

#include <sodium.h>

#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

using hoof::firmware::update::Sha512;
using Bytes = std::vector<std::uint8_t>;

namespace {

std::string hex(const Sha512::Digest& digest) {
  std::string text(129, '\0');
  sodium_bin2hex(text.data(), text.size(), digest.data(), digest.size());
  text.pop_back();
  return text;
}

Sha512::Digest sodium(const Bytes& bytes) {
  Sha512::Digest digest;
  crypto_hash_sha512(digest.data(), bytes.data(), bytes.size());
  return digest;
}

}  // namespace

TEST_CASE("sha512: the standard's examples") {
  const auto of = [](std::string_view text) {
    return hex(Sha512().add(Bytes(text.begin(), text.end())).finish());
  };
  // FIPS 180-4's example page (SHA512.pdf): one block, two blocks.
  CHECK(of("abc") ==
        "ddaf35a193617abacc417349ae20413112e6fa4e89a97ea20a9eeee64b55d39a"
        "2192992a274fc1a836ba3c23a3feebbd454d4423643ce80e2a9ac94fa54ca49f");
  CHECK(of("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmn"
           "hijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnopqrstnopqrstu") ==
        "8e959b75dae313da8cf4f72814fc143f8f7779c6eb9f7fa17299aeadb6889018"
        "501d289e4900f7e4331b99dec4b5433ac7d329eeb6dd26545e96e55b874be909");
}

TEST_CASE("sha512: every length around the edges of a block, as libsodium has it") {
  std::mt19937 random(1);
  for (std::size_t length = 0; length <= 400; ++length) {
    Bytes bytes(length);
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
    CAPTURE(length);
    REQUIRE(Sha512().add(bytes).finish() == sodium(bytes));
  }
}

TEST_CASE("sha512: in pieces of any size it is the same") {
  std::mt19937 random(2);
  Bytes bytes(5000);
  for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
  for (int i = 0; i < 50; ++i) {
    Sha512 hash;
    const std::span<const std::uint8_t> all(bytes);
    for (std::size_t at = 0; at < bytes.size();) {
      const std::size_t size = std::min<std::size_t>(random() % 300, bytes.size() - at);
      hash.add(all.subspan(at, size));
      at += size;
    }
    REQUIRE(hash.finish() == sodium(bytes));
  }
}
