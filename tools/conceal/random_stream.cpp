#include "tools/conceal/random_stream.h"

#include <cmath>
#include <numbers>

namespace hoof::tools::conceal {
namespace {

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ull;

}  // namespace

RandomStream RandomStream::branch(std::uint64_t index) const {
  return RandomStream(mix(mix(state_ + kGolden) ^ mix((index + 1) * kGolden)));
}

std::uint64_t RandomStream::bits() {
  state_ += kGolden;
  return mix(state_);
}

double RandomStream::uniform() {
  return double(bits() >> 11) * 0x1.0p-53;
}

double RandomStream::log_uniform(double low, double high) {
  return low * std::exp(std::log(high / low) * uniform());
}

double RandomStream::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

std::size_t RandomStream::below(std::size_t count) {
  return std::size_t(uniform() * double(count));
}

}  // namespace hoof::tools::conceal
