#include "firmware/update/image_slot.h"

namespace hoof::firmware::update {

using hal::Nonvolatile;

namespace {

/// A refusal is this and the Problem in its low byte.
constexpr std::uint32_t kRefusal = 0x4846'5200;  // "HFR"

}  // namespace

Signature ImageHeader::signature() const {
  Signature bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(word[kSignatureWord + i / 4] >> (8 * (i % 4)));
  }
  return bytes;
}

Problem examine(const ImageHeader& header, std::uint32_t board, std::size_t slot,
                std::size_t slot_words) {
  if (header.magic() != ImageHeader::kMagic || header.layout() != ImageHeader::kLayout) {
    return Problem::kNoImage;
  }
  if (header.board() != board) return Problem::kOtherBoard;
  if (header.slot() != slot) return Problem::kOtherSlot;
  const std::size_t room = (slot_words - kHeaderWords - kMarkWords) * Nonvolatile::kWordBytes;
  const bool fits = header.bytes() != 0 && header.bytes() % 4 == 0 && header.bytes() <= room;
  return fits ? Problem::kNone : Problem::kLength;
}

ImageHeader ImageSlot::header() const {
  ImageHeader header;
  for (std::size_t i = 0; i < header.word.size(); ++i) header.word[i] = flash_.read(slot_, i);
  return header;
}

bool ImageSlot::signature_good(const PublicKey& key) const {
  const ImageHeader header = this->header();
  Verification verification(header.signature(), key);
  std::array<std::uint8_t, 64> piece;
  std::size_t filled = 0;
  const auto add = [&](Word word) {
    for (int shift = 0; shift < 32; shift += 8) {
      piece[filled++] = static_cast<std::uint8_t>(word >> shift);
    }
    if (filled < piece.size()) return;
    verification.add(piece);
    filled = 0;
  };
  for (std::size_t i = 0; i < ImageHeader::kSignedWords; ++i) {
    add(header.word[ImageHeader::kMagicWord + i]);
  }
  for (std::size_t i = 0; i < header.bytes() / 4; ++i) {
    add(flash_.read(slot_, kHeaderWords + i));
  }
  return verification.add(std::span(piece).first(filled)).good();
}

std::size_t ImageSlot::attempts() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kAttempts; ++i) count += is_set(mark(kFirstAttempt + i)) ? 1 : 0;
  return count;
}

Problem ImageSlot::refusal() const {
  const Word word = flash_.read(slot_, mark(kRefused));
  if (word == Nonvolatile::kErased) return Problem::kNone;
  const Word why = word & 0xFF;
  const bool known =
      (word & ~Word{0xFF}) == kRefusal && why != 0 && why < static_cast<Word>(Problem::kUnknown);
  return known ? static_cast<Problem>(why) : Problem::kUnknown;
}

void ImageSlot::settle() {
  const auto settle_word = [this](std::size_t word, Word value) {
    if (value != Nonvolatile::kErased && value != 0) set(word, 0);
  };
  settle_word(ImageHeader::kCompleteWord, flash_.read(slot_, ImageHeader::kCompleteWord));
  for (std::size_t i = 0; i < kRefused; ++i) settle_word(mark(i), flash_.read(slot_, mark(i)));
  if (refusal() == Problem::kUnknown) set(mark(kRefused), 0);
}

bool ImageSlot::count_attempt() {
  for (std::size_t i = 0; i < kAttempts; ++i) {
    if (!is_set(mark(kFirstAttempt + i))) return set(mark(kFirstAttempt + i), 0);
  }
  return false;
}

bool ImageSlot::refuse(Problem why) {
  return set(mark(kRefused), kRefusal | static_cast<Word>(why));
}

}  // namespace hoof::firmware::update
