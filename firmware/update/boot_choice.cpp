#include "firmware/update/boot_choice.h"

namespace hoof::firmware::update {

std::optional<std::size_t> BootChoice::choose() {
  for (ImageSlot& slot : slots_) slot.settle();
  // Twice at most: a round that starts nothing refuses an image.
  for (std::size_t round = 0; round <= kSlots; ++round) {
    const std::optional<std::size_t> newest = newest_fit();
    if (!newest) break;
    if (start(slots_[*newest], slots_[1 - *newest])) return newest;
  }
  // Whatever was held against it: it is all there is.
  for (const bool confirmed : {true, false}) {
    for (ImageSlot& slot : slots_) {
      const bool candidate = readable(slot) && slot.confirmed() == confirmed;
      if (candidate && sound(slot)) return slot.number();
    }
  }
  return std::nullopt;
}

/// By its header: whole, and for this board and slot.
bool BootChoice::readable(const ImageSlot& slot) const {
  return slot.complete() &&
         examine(slot.header(), board_, slot.number(), slot.words()) == Problem::kNone;
}

/// Refuses it for ever where its signature is not good.
bool BootChoice::sound(ImageSlot& slot) {
  before_long_();
  if (slot.signature_good(key_)) return true;
  if (slot.refusal() == Problem::kNone) slot.refuse(Problem::kSignature);
  return false;
}

/// Of two with the same version the one that was confirmed; else the first.
std::optional<std::size_t> BootChoice::newest_fit() const {
  std::optional<std::size_t> newest;
  for (const ImageSlot& slot : slots_) {
    if (!readable(slot) || slot.refusal() != Problem::kNone) continue;
    if (newest) {
      const ImageSlot& former = slots_[*newest];
      const std::uint32_t version = slot.header().version(), its = former.header().version();
      if (version < its || (version == its && (former.confirmed() || !slot.confirmed()))) continue;
    }
    newest = slot.number();
  }
  return newest;
}

/// @return false where it is not to be started; it was then refused
bool BootChoice::start(ImageSlot& slot, ImageSlot& other) {
  if (!sound(slot)) return false;
  if (slot.confirmed()) return true;
  const bool way_back =
      readable(other) && other.refusal() == Problem::kNone && other.confirmed() && sound(other);
  if (!way_back) {
    slot.confirm();
    return true;
  }
  // An attempt that cannot be noted would be made again and again.
  if (slot.count_attempt()) return true;
  slot.refuse(Problem::kNotConfirmed);
  return false;
}

}  // namespace hoof::firmware::update
