// What decides a bed's bytes, in one line of text: kept in a bed's file, and read back from it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sim/terrain/bed_settings.h"

namespace hoof::sim {

/// Recipe, settings, materials and seed. A name or doubts of materials do not matter.
std::string bed_key(const BedSettings& bed, const Materials& materials, std::uint64_t seed);

struct BedOrigin {
  BedSettings bed;  // without a name
  Materials materials;
  std::uint64_t seed = 0;
};

/// The settings that a key was made from: bed_key of them is the key again.
/// @throws std::runtime_error where it is no key, or one of another recipe
BedOrigin parse_bed_key(std::string_view key);

}  // namespace hoof::sim
