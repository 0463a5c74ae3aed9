// SHA-512, for signatures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace hoof::firmware::update {

/// FIPS 180-4, 6.4. Takes its input in pieces of any size; 336 bytes of state, no heap.
class Sha512 {
 public:
  using Digest = std::array<std::uint8_t, 64>;

  Sha512& add(std::span<const std::uint8_t> bytes);
  /// Ends it: nothing may be added after.
  Digest finish();

 private:
  static constexpr std::size_t kBlock = 128;

  void compress();

  std::array<std::uint64_t, 8> state_{0x6A09E667F3BCC908, 0xBB67AE8584CAA73B, 0x3C6EF372FE94F82B,
                                      0xA54FF53A5F1D36F1, 0x510E527FADE682D1, 0x9B05688C2B3E6C1F,
                                      0x1F83D9ABFB41BD6B, 0x5BE0CD19137E2179};
  std::array<std::uint8_t, kBlock> block_{};
  std::size_t filled_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace hoof::firmware::update
