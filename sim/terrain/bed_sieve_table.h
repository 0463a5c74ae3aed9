// A sieve analysis as a laboratory writes it down, read into classes of grain sizes.
//
//   # comment
//   aperture_mm,passing_percent        or   aperture_mm,retained_percent
//   0.2,5.28                                0,5.28        (the pan)
//   0.5,26.42                               0.2,21.14
//   ...
//
// Apertures rise from row to row. passing_percent is the share of the whole mass that falls through
// the sieve: it never falls and ends at 100. retained_percent is the share that lies on the sieve
// (and fell through the next wider one): it adds up to 100, and the widest sieve holds nothing
// back.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace hoof::sim {

/// One sieve class: mass uniform in diameter between the two sizes.
struct SieveClass {
  double low_m = 0;
  double high_m = 0;
  double mass_share = 0;
};

/// What of a table is used, and how it is enlarged. The paper keeps 0.5 to 1.6 mm, times 4.
struct SieveSelection {
  std::optional<double> from_m;  // not given: from the finest sieve
  std::optional<double> to_m;    // not given: to the widest
  double scale = 1;
};

/// Classes from small to large whose shares add up to 1. A range that ends inside of a class takes
/// its part of the class's mass, which is uniform in diameter.
/// @throws ConfigError naming file, line, column, value and bound
std::vector<SieveClass> read_sieve_table(const std::filesystem::path& file,
                                         const SieveSelection& selection);

}  // namespace hoof::sim
