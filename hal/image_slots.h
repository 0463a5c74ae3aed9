// The two places for images on a board that can be updated, and the way from one to the other.
#pragma once

#include <cstddef>

#include "hal/nonvolatile.h"

namespace hoof::hal {

class ImageSlots {
 public:
  /// Sectors 0 and 1 are the slots. The one that runs is not to be erased.
  virtual Nonvolatile& flash() = 0;
  /// The slot of the image that runs.
  virtual std::size_t running() const = 0;
  /// Starts over through the boot loader: ResetCause::kRequested then. Does not return on a board.
  virtual void restart() = 0;

 protected:
  ~ImageSlots() = default;
};

}  // namespace hoof::hal
