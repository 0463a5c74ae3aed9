// First in, first out, in place.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace hoof::firmware::app {

template <typename T, std::size_t kSize>
class FixedQueue {
 public:
  /// @return false when full; the value is then dropped
  bool put(const T& value) {
    if (count_ == kSize) return false;
    values_[(first_ + count_++) % kSize] = value;
    return true;
  }

  std::optional<T> take() {
    if (count_ == 0) return std::nullopt;
    const T value = values_[first_];
    drop();
    return value;
  }

  bool empty() const { return count_ == 0; }
  /// The oldest; only while not empty.
  const T& front() const { return values_[first_]; }
  void drop() {
    first_ = (first_ + 1) % kSize;
    --count_;
  }

 private:
  std::array<T, kSize> values_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace hoof::firmware::app
