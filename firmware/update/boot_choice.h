// Which of two images to start.
#pragma once

#include <cstddef>
#include <optional>

#include "firmware/update/image_slot.h"

namespace hoof::firmware::update {

/// The newest image that is sound and has not failed. One that was not yet confirmed is on trial:
/// each start costs it one of three attempts, and without any left it is refused for ever. Where
/// nothing else is sound there is nothing to go back to, and the one that is counts as confirmed.
///
/// Every start looks at the signature of the image that it starts, so that neither decay nor
/// whoever once got into the application can leave something behind that starts.
///
/// Sound is decided on what the flash says now; what is to be remembered is a mark of its own, so
/// that a cut at any of the writes here changes which image starts, and not that one does.
class BootChoice {
 public:
  /// @param flash sectors 0 and 1 are the slots
  /// @param before_long called before each look at a signature, for the watchdog
  BootChoice(hal::Nonvolatile& flash, const PublicKey& key, std::uint32_t board,
             void (*before_long)())
      : slots_{ImageSlot(flash, 0), ImageSlot(flash, 1)},
        key_(key),
        board_(board),
        before_long_(before_long) {}

  /// Sets the marks that come of it. Nothing where neither image is sound.
  std::optional<std::size_t> choose();

 private:
  bool readable(const ImageSlot& slot) const;
  bool sound(ImageSlot& slot);
  std::optional<std::size_t> newest_fit() const;
  bool start(ImageSlot& slot, ImageSlot& other);

  std::array<ImageSlot, kSlots> slots_;
  const PublicKey& key_;
  std::uint32_t board_;
  void (*before_long_)();
};

}  // namespace hoof::firmware::update
