// Stores at the speed of loads, in spite of Unicorn 2.0.1.
//
// An emulator that translates code must notice when code is overwritten. QEMU marks the pages of
// its translation buffer for that (TLB_NOTDIRTY) and takes the mark away with the first store that
// finds no code there. Unicorn 2.0.1, which Debian 12 has, lost that last step
// (qemu/accel/tcg/cputlb.c, notdirty_write): each store takes the slow way, allocates a set of
// pages, finds no code and frees the set, some 700 instructions of the host, more than half of the
// time of a run. Here the step is done when a page enters the buffer: the library's own
// tlb_set_page_with_attrs(), interposed, then calls its own tlb_set_dirty().
//
// Pages that may hold code keep the mark, and so do those of flash. Without the interposed
// function, which is there for exactly that version, all works as well, only slower.
#pragma once

#include <cstdint>

namespace hoof::tools::emulator {

class DataPages {
 public:
  /// Whether the page of this address can be written by plain stores, and holds no code. All other
  /// pages need the slow way: it also finds the stores that are not allowed.
  virtual bool plain_data(std::uint32_t address) const = 0;

 protected:
  ~DataPages() = default;
};

/// While it lives, stores to plain data by the core that this thread runs are fast.
class FastStores {
 public:
  explicit FastStores(const DataPages& pages);
  ~FastStores();
  FastStores(const FastStores&) = delete;
  FastStores& operator=(const FastStores&) = delete;

 private:
  const DataPages* before_;
};

}  // namespace hoof::tools::emulator
