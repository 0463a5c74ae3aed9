// Settled beds, made once and kept: the dear part of every experiment.
#pragma once

#include <filesystem>
#include <string>

#include "sim/terrain/bed_maker.h"

namespace hoof::sim {

struct StoredBed {
  BedState state;
  std::filesystem::path file;
  bool made = false;      // settled in this call
  std::string discarded;  // why a file that was there could not be used; empty if none
};

class BedStore {
 public:
  explicit BedStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Everything that decides a bed's bytes, in one line: recipe, settings, materials, seed.
  static std::string key(const BedSettings& bed, const Materials& materials, std::uint64_t seed);
  std::filesystem::path file(const BedSettings& bed, const Materials& materials,
                             std::uint64_t seed) const;

  /// The bed of these settings, from its file or, where there is none or a damaged one, made anew.
  StoredBed get(const BedSettings& bed, const Materials& materials, std::uint64_t seed, int threads,
                const BedProgress& progress) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace hoof::sim
