// Memory on cache lines, and on huge pages where it is large, for std::vector.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace hoof::sim {

template <typename T>
struct AlignedAllocator {
  using value_type = T;
  static constexpr std::size_t kAlignment = alignof(T) < 64 ? 64 : alignof(T);

  static constexpr std::size_t kHugePage = std::size_t(1) << 21;

  AlignedAllocator() = default;
  template <typename U>
  explicit AlignedAllocator(const AlignedAllocator<U>&) {}

  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    if (bytes < kHugePage) {
      return static_cast<T*>(::operator new(bytes, std::align_val_t(kAlignment)));
    }
    // Pages of 2 MiB: with those of 4 KiB, looking up the address of a neighbour's record often
    // takes longer than fetching it.
    void* p = ::operator new(bytes, std::align_val_t(kHugePage));
    madvise(p, bytes, MADV_HUGEPAGE);  // advice: where the kernel has none, nothing is lost
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t n) {
    ::operator delete(p, std::align_val_t(n * sizeof(T) < kHugePage ? kAlignment : kHugePage));
  }

  friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
};

}  // namespace hoof::sim
