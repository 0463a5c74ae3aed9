// Which bed a command means: a preset or settings file, as runs read them, or a kept bed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/terrain/bed_settings.h"

namespace hoof::tools {

/// The flags that choose a bed's settings.
struct BedOptions {
  std::string bed = "demo";  ///< demo, medium, bench, paper, or a TOML file
  std::optional<std::int64_t> seed;
  std::optional<int> threads;
  bool periodic = false;
  std::string sieve;                   ///< CSV file of a sieve analysis
  std::vector<double> sieve_range_mm;  ///< from, to
  std::optional<double> sieve_scale;
  std::vector<std::string> settings;  ///< each "key=value", as given by --set
};

struct ChosenBed {
  sim::BedSettings bed;
  sim::Materials materials;
  std::uint64_t seed = 0;
  int threads = 1;
  std::filesystem::path file;  ///< where it is or will be kept

  std::string key() const;
};

/// The bed of such settings; its file is where runs look for it.
ChosenBed kept_bed(const sim::BedSettings& bed, const sim::Materials& materials, std::uint64_t seed,
                   int threads);

/// The bed that the flags describe; its file is where runs look for it.
/// @throws sim::ConfigError, UserError
ChosenBed choose_bed(const BedOptions& options);

struct OpenedBed {
  ChosenBed origin;
  sim::BedState state;
};

/// A kept bed: by its file, or, where `bed` names a preset or ends in ".toml", the one that runs
/// with such settings use.
/// @throws UserError where it is no bed or was not made yet: says how to make it
OpenedBed open_bed(const BedOptions& options);

}  // namespace hoof::tools
