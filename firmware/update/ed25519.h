// Ed25519 signatures: verification alone. Whoever signs does it elsewhere.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace hoof::firmware::update {

using PublicKey = std::array<std::uint8_t, 32>;
using Signature = std::array<std::uint8_t, 64>;

/// RFC 8032, 5.1.7, without the cofactor, and strict as libsodium is: the key and S must be
/// canonical, and neither key nor R of small order (a key that is all zeros would else accept what
/// anyone can make). Signature and message are public: times may depend on them.
/// @param first @param second the message, in two pieces
bool verify(const Signature& signature, const PublicKey& key, std::span<const std::uint8_t> first,
            std::span<const std::uint8_t> second = {});

}  // namespace hoof::firmware::update
