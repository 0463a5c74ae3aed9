// Values as bytes in a row, for snapshots of the engine that resume to the same bytes. The layout
// and byte order are the machine's own; whoever keeps such bytes adds a version and a checksum.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <ranges>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace hoof::sim {

/// Types that are their bytes and nothing else. Eigen's small vectors are, though they do not say
/// so (their copy constructors are not trivial); views and pointers say so and are not.
template <typename T>
inline constexpr bool kIsItsBytes =
    std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::ranges::view<T>;
template <typename Scalar, int kRows, int kColumns>
inline constexpr bool kIsItsBytes<Eigen::Matrix<Scalar, kRows, kColumns>> =
    kRows != Eigen::Dynamic&& kColumns != Eigen::Dynamic;
template <typename Scalar>
inline constexpr bool kIsItsBytes<Eigen::Quaternion<Scalar>> = true;

class ByteWriter {
 public:
  template <typename T>
  requires kIsItsBytes<T>
  void put(const T& value) { append(&value, sizeof value); }

  /// A vector, span, string or array: its length, then its elements.
  template <std::ranges::contiguous_range Range>
  requires kIsItsBytes<std::ranges::range_value_t<Range>>
  void put_all(const Range& values) {
    const std::uint64_t count = std::ranges::size(values);
    put(count);
    append(std::ranges::data(values), count * sizeof(std::ranges::range_value_t<Range>));
  }

  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::exchange(bytes_, {}); }

 private:
  void append(const void* data, std::size_t size) {
    if (size > 0) bytes_.append(static_cast<const char*>(data), size);
  }

  std::string bytes_;
};

/// Takes values out in the order in which they were put. The bytes must outlive the reader.
/// @throws std::runtime_error "is truncated" where the bytes end too early
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <typename T>
  requires kIsItsBytes<T>
  void get(T& value) { extract(&value, sizeof value); }

  template <typename T>
  requires kIsItsBytes<T> T get() {
    T value;
    get(value);
    return value;
  }

  /// Into a vector or string, which gets the length that was put.
  template <std::ranges::contiguous_range Range>
  requires kIsItsBytes<std::ranges::range_value_t<Range>>
  void get_all(Range& values) {
    constexpr std::size_t kSize = sizeof(std::ranges::range_value_t<Range>);
    const auto count = get<std::uint64_t>();
    // Looked at before it is believed: a damaged length must not become a huge allocation.
    if (count > rest_.size() / kSize) throw std::runtime_error("is truncated");
    values.resize(std::size_t(count));
    extract(std::ranges::data(values), std::size_t(count) * kSize);
  }

  bool at_end() const { return rest_.empty(); }

 private:
  void extract(void* data, std::size_t size) {
    if (size > rest_.size()) throw std::runtime_error("is truncated");
    if (size == 0) return;
    std::memcpy(data, rest_.data(), size);
    rest_.remove_prefix(size);
  }

  std::string_view rest_;
};

}  // namespace hoof::sim
