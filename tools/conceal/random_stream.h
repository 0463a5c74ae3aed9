#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

namespace hoof::tools::conceal {

/// A stream of random numbers that is the same on every machine: SplitMix64 (Steele, Lea and Flood,
/// OOPSLA 2014), with none of the distributions that the C++ library leaves open.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : state_(seed) {}

  /// A stream of its own for a part, such as one channel of one recording: what is drawn there
  /// changes nothing elsewhere.
  RandomStream branch(std::uint64_t index) const;

  std::uint64_t bits();
  double uniform();  ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double log_uniform(double low, double high);  ///< both positive
  double normal();                              ///< mean 0, deviation 1 (Box and Muller)
  bool chance(double probability) { return uniform() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  std::size_t below(std::size_t count);  ///< 0..count-1
  int integer(int low, int high) { return low + int(below(std::size_t(high - low + 1))); }

  template <typename T>
  T pick(std::initializer_list<T> values) {
    return *(values.begin() + below(values.size()));
  }

  template <typename T>
  void shuffle(std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(i)]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace hoof::tools::conceal
