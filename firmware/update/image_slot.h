// An image in its slot: what stands before it, what is noted behind it.
//
// A slot is one sector of flash, in words from its start:
//   0 - 127  header, see ImageHeader; of its words 32 - 127 are erased
//   128 -    the image, its vector table first
//   the last eight: marks, each erased until it is set
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "firmware/update/ed25519.h"
#include "hal/nonvolatile.h"

namespace hoof::firmware::update {

inline constexpr std::size_t kSlots = 2;
inline constexpr std::size_t kHeaderWords = 128;  // the vector table is aligned to 512 bytes
inline constexpr std::size_t kMarkWords = 8;

/// Which board an image is for.
inline constexpr std::uint32_t kFootBoard = 0x4634'3035;  // "F405"

/// The first words of a slot. An image is linked for its slot, so each version has two.
struct ImageHeader {
  using Word = hal::Nonvolatile::Word;
  static constexpr Word kMagic = 0x4846'494D;  // "HFIM"
  static constexpr Word kLayout = 1;
  static constexpr std::size_t kSignedWords = 15;  // from kMagicWord on
  static constexpr std::size_t kSignatureWord = 16;
  static constexpr std::size_t kWords = 32;

  /// Word 0, not signed: erased until all else stands there, then 0. Written last, it makes the
  /// difference between a part of an image and a whole one.
  static constexpr std::size_t kCompleteWord = 0;
  static constexpr std::size_t kMagicWord = 1;

  std::array<Word, kWords> word{};

  Word magic() const { return word[1]; }
  Word layout() const { return word[2]; }
  Word board() const { return word[3]; }
  Word slot() const { return word[4]; }
  Word bytes() const { return word[5]; }  // of the image, without header
  Word version() const { return word[6]; }
  Word protocol_hash() const { return word[7]; }
  Word crc() const { return word[8]; }  // CRC-32 of the image: transfer, not trust
  Signature signature() const;
};

/// What is wrong with a header, or became of an image. Told over the bus, so the numbers stay.
enum class Problem : std::uint8_t {
  kNone = 0,
  kNoImage = 1,  // not the magic, or another layout
  kOtherBoard = 2,
  kOtherSlot = 3,  // linked for the other slot
  kLength = 4,     // zero, no whole words, or more than the slot has room for
  kNotNewer = 5,   // its version is not above the running one's
  kChecksum = 6,   // the words that came are not those that were meant
  kSignature = 7,
  kNotConfirmed = 8,  // on trial it did not report healthy
  kFlash = 9,         // a word or sector did not take what was written
  kUnknown = 10,      // refused, and the power failed as the reason was noted
};

/// Of a header alone. @param slot_words of the sector
Problem examine(const ImageHeader& header, std::uint32_t board, std::size_t slot,
                std::size_t slot_words);

/// A slot as it stands in flash. Marks may be set by boot loader and application; whenever the
/// power fails a mark is set, or not, or reads now so and now so until settle() sets it.
class ImageSlot {
 public:
  using Word = hal::Nonvolatile::Word;
  static constexpr std::size_t kAttempts = 3;

  ImageSlot(hal::Nonvolatile& flash, std::size_t slot) : flash_(flash), slot_(slot) {}

  std::size_t number() const { return slot_; }
  std::size_t words() const { return flash_.sector_words(slot_); }
  ImageHeader header() const;
  /// Whether all of an image was once written here.
  bool complete() const { return is_set(ImageHeader::kCompleteWord); }
  /// Reads all of it, some 50 ms at 168 MHz.
  bool signature_good(const PublicKey& key) const;

  bool confirmed() const { return is_set(mark(kConfirmed)); }
  std::size_t attempts() const;
  /// kNone where it was not refused.
  Problem refusal() const;

  /// Makes sure that what reads as set reads so for ever.
  void settle();
  bool confirm() { return set(mark(kConfirmed), 0); }
  bool count_attempt();
  bool refuse(Problem why);

 private:
  enum Mark : std::size_t { kFirstAttempt = 0, kConfirmed = kAttempts, kRefused };

  std::size_t mark(std::size_t which) const { return words() - kMarkWords + which; }
  bool is_set(std::size_t word) const {
    return flash_.read(slot_, word) != hal::Nonvolatile::kErased;
  }
  bool set(std::size_t word, Word value) {
    return flash_.program(slot_, word, value) == hal::FlashResult::kOk;
  }

  hal::Nonvolatile& flash_;
  std::size_t slot_;
};

}  // namespace hoof::firmware::update
