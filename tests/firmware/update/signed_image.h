// Images for tests: random bytes behind a signed header, as words of a slot.
#pragma once

#include <sodium.h>

#include <array>
#include <random>
#include <vector>

#include "firmware/app/crc32.h"
#include "firmware/protocol/protocol_hash.h"
#include "firmware/update/image_slot.h"
#include "hal/in_process/ram_flash.h"

namespace hoof::test {

using Word = hal::Nonvolatile::Word;

struct SigningKey {
  firmware::update::PublicKey open;
  std::array<std::uint8_t, crypto_sign_SECRETKEYBYTES> secret;

  explicit SigningKey(std::uint8_t seed = 1) {
    std::array<std::uint8_t, crypto_sign_SEEDBYTES> bytes{seed};
    crypto_sign_seed_keypair(open.data(), secret.data(), bytes.data());
  }
};

struct ImageSpec {
  std::uint32_t version = 1;
  std::size_t slot = 0;
  std::size_t words = 40;
  std::uint32_t board = firmware::update::kFootBoard;
  std::uint32_t protocol_hash = firmware::protocol::kProtocolHash;
};

/// Signs words 1 to 15 and all behind the header, as they stand.
inline void sign(std::vector<Word>& words, const SigningKey& key) {
  using firmware::update::ImageHeader;
  std::vector<std::uint8_t> message;
  const auto add = [&](Word word) {
    for (int shift = 0; shift < 32; shift += 8) message.push_back(std::uint8_t(word >> shift));
  };
  for (std::size_t i = 0; i < ImageHeader::kSignedWords; ++i) add(words[1 + i]);
  for (std::size_t i = firmware::update::kHeaderWords; i < words.size(); ++i) add(words[i]);
  firmware::update::Signature signature;
  crypto_sign_detached(signature.data(), nullptr, message.data(), message.size(),
                       key.secret.data());
  for (std::size_t i = 0; i < 16; ++i) words[ImageHeader::kSignatureWord + i] = 0;
  for (std::size_t i = 0; i < signature.size(); ++i) {
    words[ImageHeader::kSignatureWord + i / 4] |= Word(signature[i]) << (8 * (i % 4));
  }
}

/// Header, then the image; word 0 is set.
inline std::vector<Word> make_image(const ImageSpec& spec, const SigningKey& key) {
  using firmware::update::ImageHeader;
  std::vector<Word> words(firmware::update::kHeaderWords, hal::Nonvolatile::kErased);
  std::mt19937 random(spec.version * 2 + std::uint32_t(spec.slot));
  std::vector<Word> image(spec.words);
  for (Word& word : image) word = Word(random());
  const Word fields[] = {0,
                         ImageHeader::kMagic,
                         ImageHeader::kLayout,
                         spec.board,
                         Word(spec.slot),
                         Word(4 * spec.words),
                         spec.version,
                         spec.protocol_hash,
                         firmware::app::Crc32().add(image).value(),
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0};
  std::copy(std::begin(fields), std::end(fields), words.begin());
  words.insert(words.end(), image.begin(), image.end());
  sign(words, key);
  return words;
}

inline void write_image(hal::RamFlash& flash, std::size_t slot, const std::vector<Word>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) flash.program(slot, i, words[i]);
}

}  // namespace hoof::test
