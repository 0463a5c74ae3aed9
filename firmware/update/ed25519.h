// Ed25519 signatures: verification alone. Whoever signs does it elsewhere.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "firmware/update/sha512.h"

namespace hoof::firmware::update {

using PublicKey = std::array<std::uint8_t, 32>;
using Signature = std::array<std::uint8_t, 64>;

/// RFC 8032, 5.1.7, without the cofactor, and strict as libsodium is: the key and S must be
/// canonical, and neither key nor R of small order (a key that is all zeros would else accept what
/// anyone can make). Signature and message are public: times may depend on them.
class Verification {
 public:
  Verification(const Signature& signature, const PublicKey& key);
  /// The next piece of the message.
  Verification& add(std::span<const std::uint8_t> piece) {
    hash_.add(piece);
    return *this;
  }
  /// Whether the signature is that of the message. Ends it.
  bool good();

 private:
  const Signature signature_;
  const PublicKey key_;
  Sha512 hash_;
};

}  // namespace hoof::firmware::update
