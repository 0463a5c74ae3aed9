#include "sim/terrain/bed_grading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::sim {
namespace {

/// Mean number of grains per unit of solids, 1/m^3: each class holds mass_share / (high - low) of
/// the mass per metre of diameter, and a grain of diameter d holds pi/6 d^3.
double number_density(const SieveClass& c, double scale) {
  const double a = scale * c.low_m, b = scale * c.high_m;
  return c.mass_share / (b - a) * 6 / std::numbers::pi * 0.5 * (1 / (a * a) - 1 / (b * b));
}

double number_density(const BedSettings& bed) {
  double sum = 0;
  for (const SieveClass& c : bed.sieve) sum += number_density(c, bed.grain_scale);
  return sum;
}

}  // namespace

double sphere_m3(double diameter_m) {
  return std::numbers::pi / 6 * diameter_m * diameter_m * diameter_m;
}

std::vector<double> graded_diameters(const BedSettings& bed, std::size_t n) {
  std::vector<double> diameters;
  diameters.reserve(n);
  const double total = number_density(bed);
  for (std::size_t i = 0; i < n; ++i) {
    double u = (double(i) + 0.5) / double(n) * total;  // quantile, in grains per unit of solids
    for (std::size_t k = 0; k < bed.sieve.size(); ++k) {
      const SieveClass& c = bed.sieve[k];
      const double share = number_density(c, bed.grain_scale);
      if (u > share && k + 1 < bed.sieve.size()) {
        u -= share;
        continue;
      }
      // Number density ~ d^-3 within the class: invert its integral.
      const double a = bed.grain_scale * c.low_m, b = bed.grain_scale * c.high_m;
      const double inverse2 = 1 / (a * a) + std::min(1.0, u / share) * (1 / (b * b) - 1 / (a * a));
      diameters.push_back(1 / std::sqrt(inverse2));
      break;
    }
  }
  return diameters;
}

std::size_t grains_to_pour(const BedSettings& bed, double share) {
  const double solids_m3 = share * bed.overfill * bed.box_length_m * bed.box_width_m * bed.depth_m;
  return std::size_t(std::llround(solids_m3 * number_density(bed)));
}

std::vector<double> graded_shares(const BedSettings& bed, std::span<const Grain> grains) {
  std::vector<double> shares(bed.sieve.size(), 0.0);
  double all_m3 = 0;
  for (const Grain& g : grains) {
    const double volume_m3 = sphere_m3(2 * g.radius_m);
    all_m3 += volume_m3;
    std::size_t k = 0;
    while (k + 1 < bed.sieve.size() && 2 * g.radius_m >= bed.grain_scale * bed.sieve[k + 1].low_m) {
      ++k;
    }
    shares[k] += volume_m3;
  }
  for (double& share : shares) share /= all_m3;
  return shares;
}

}  // namespace hoof::sim
