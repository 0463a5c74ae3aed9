#include "sim/terrain/bed_maker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/terrain/random.h"

namespace hoof::sim {
namespace {

constexpr double kShareAimed = 0.60;   // solids of the paper's bed, from 42.5 kg in 120 mm
constexpr double kShareOfRain = 0.30;  // random places are found quickly up to about 0.3

double sphere_m3(double diameter_m) {
  return std::numbers::pi / 6 * diameter_m * diameter_m * diameter_m;
}

/// Cells with the grains placed so far, for finding overlaps.
class PlacedGrains {
 public:
  PlacedGrains(const BedSettings& bed, double column_m)
      : bed_(bed), cell_m_(bed.largest_diameter_m()) {
    nx_ = std::max(1, int(bed.box_length_m / cell_m_));
    ny_ = std::max(1, int(bed.box_width_m / cell_m_));
    nz_ = int(column_m / cell_m_) + 1;
    cells_.resize(std::size_t(nx_) * ny_ * nz_);
  }

  /// Adds the grain unless it overlaps one. Position from the corner of the box.
  bool add(const Eigen::Vector3d& p_m, double radius_m) {
    const int x = cell(p_m.x(), bed_.box_length_m, nx_), y = cell(p_m.y(), bed_.box_width_m, ny_),
              z = std::min(nz_ - 1, int(p_m.z() / cell_m_));
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (overlaps(x + dx, y + dy, z + dz, p_m, radius_m)) return false;
        }
      }
    }
    at(x, y, z).push_back({p_m, radius_m});
    return true;
  }

 private:
  struct Placed {
    Eigen::Vector3d p_m;
    double radius_m;
  };

  static int cell(double x_m, double length_m, int n) {
    return std::clamp(int(x_m / length_m * n), 0, n - 1);
  }
  std::vector<Placed>& at(int x, int y, int z) {
    return cells_[(std::size_t(z) * ny_ + y) * nx_ + x];
  }
  bool overlaps(int x, int y, int z, const Eigen::Vector3d& p_m, double radius_m) {
    if (z < 0 || z >= nz_) return false;
    if (!bed_.periodic_sides && (x < 0 || x >= nx_ || y < 0 || y >= ny_)) return false;
    for (const Placed& q : at((x + nx_) % nx_, (y + ny_) % ny_, z)) {
      Eigen::Vector3d d = p_m - q.p_m;
      if (bed_.periodic_sides) {
        d.x() -= bed_.box_length_m * std::round(d.x() / bed_.box_length_m);
        d.y() -= bed_.box_width_m * std::round(d.y() / bed_.box_width_m);
      }
      const double reach = radius_m + q.radius_m;
      if (d.squaredNorm() < reach * reach) return true;
    }
    return false;
  }

  const BedSettings& bed_;
  double cell_m_;
  int nx_, ny_, nz_;
  std::vector<std::vector<Placed>> cells_;
};

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

/// Runs the bed for a while, in pieces small enough for a progress bar and Ctrl-C.
void run(SandBed& bed, double duration_s, double from, double to, const BedProgress& progress) {
  const int steps = int(std::ceil(duration_s / bed.settings().dt_s));
  constexpr int kPiece = 200;
  for (int done = 0; done < steps; done += kPiece) {
    bed.advance(std::min(kPiece, steps - done));
    if (progress && !progress(from + (to - from) * std::min(1.0, double(done + kPiece) / steps))) {
      throw std::runtime_error("stopped");
    }
  }
}

/// A scraper passes at z = 0: every grain that stands above is taken away.
void scrape(BedState& state) {
  std::vector<Grain> kept;
  for (const Grain& g : state.grains) {
    if (g.p_m.z() + g.radius_m <= 0) kept.push_back(g);
  }
  std::vector<std::uint32_t> ids;
  for (const Grain& g : kept) ids.push_back(g.id);
  const auto there = [&](std::uint32_t id) {
    return id >= GrainContact::kWallContact || std::binary_search(ids.begin(), ids.end(), id);
  };
  std::erase_if(state.contacts, [&](const GrainContact& c) { return !there(c.i) || !there(c.j); });
  state.grains = std::move(kept);
}

void number_from_zero(BedState& state) {
  std::vector<std::uint32_t> ids;
  for (const Grain& g : state.grains) ids.push_back(g.id);
  const auto place = [&](std::uint32_t id) {
    return std::uint32_t(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
  };
  for (GrainContact& c : state.contacts) {
    c.i = place(c.i);
    if (c.j < GrainContact::kWallContact) c.j = place(c.j);
  }
  for (std::uint32_t i = 0; i < state.grains.size(); ++i) state.grains[i].id = i;
}

}  // namespace

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

std::vector<Grain> rain(const BedSettings& bed, double column_m, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> diameters = graded_diameters(bed, grains_to_pour(bed, kShareAimed));
  // The largest first: they find a place while there is much room.
  std::sort(diameters.begin(), diameters.end(), std::greater<>());
  PlacedGrains placed(bed, column_m);
  std::vector<Grain> grains;
  constexpr int kTries = 20000;
  for (const double d : diameters) {
    const double side = bed.periodic_sides ? 0 : d / 2;
    int tries = 0;
    Eigen::Vector3d p;
    do {
      if (++tries > kTries) {
        throw std::runtime_error("bed: no room for grain " + std::to_string(grains.size()) +
                                 " of " + std::to_string(diameters.size()) + " in the rain");
      }
      p = {random.between(side, bed.box_length_m - side),
           random.between(side, bed.box_width_m - side), random.between(d / 2, column_m - d / 2)};
    } while (!placed.add(p, d / 2));
    Grain g;
    g.id = std::uint32_t(grains.size());
    g.radius_m = d / 2;
    g.p_m = p - Eigen::Vector3d(bed.box_length_m / 2, bed.box_width_m / 2, bed.depth_m);
    grains.push_back(g);
  }
  return grains;
}

BedState make_bed(const BedSettings& bed, const Materials& materials, std::uint64_t seed,
                  int threads, const BedProgress& progress) {
  const double column_m = bed.depth_m * bed.overfill * kShareAimed / kShareOfRain;
  const DemSettings settings = dem_settings(bed, materials, threads);
  BedState state;
  state.grains = rain(bed, column_m, seed);

  // Friction as set for packing while they fall; a medium takes the speed of a long fall away.
  const double fall_s = std::sqrt(2 * (column_m - bed.depth_m) / 9.81);
  {
    DemSettings falling = settings;
    falling.grain_grain.static_friction = bed.packing_friction;
    falling.grain_wall.static_friction = bed.packing_friction;
    falling.grain_grain.rolling_friction = bed.packing_rolling_friction;
    falling.grain_wall.rolling_friction =
        std::min(bed.packing_rolling_friction, settings.grain_wall.rolling_friction);
    falling.viscous_rate_1_s = 5;
    SandBed sand(falling, state);
    run(sand, 1.3 * fall_s, 0.0, 0.5, progress);
    sand.set_viscous_rate(30);
    run(sand, 0.3 * fall_s, 0.5, 0.65, progress);
    state = sand.state();
  }
  scrape(state);
  {
    SandBed sand(settings, state);  // all friction from here on
    sand.set_viscous_rate(30);
    run(sand, 0.3 * fall_s, 0.65, 0.8, progress);
    sand.set_viscous_rate(0);
    run(sand, 0.3 * fall_s, 0.8, 1.0, progress);
    state = sand.state();
  }
  scrape(state);  // what the release pushed up again
  number_from_zero(state);
  return state;
}

BedReport inspect_bed(const BedSettings& bed, const Materials& materials, const BedState& state) {
  BedReport report;
  report.grains = state.grains.size();
  const double low = -0.9 * bed.depth_m, high = -0.1 * bed.depth_m;
  double in_layer_m3 = 0, all_m3 = 0;
  std::array<std::size_t, 12> regions{};
  for (const Grain& g : state.grains) {
    all_m3 += sphere_m3(2 * g.radius_m);
    // Part of a sphere below height h above its centre: pi/3 (r+h)^2 (2r-h), between -r and r.
    const auto below = [&](double z) {
      const double h = std::clamp(z - g.p_m.z(), -g.radius_m, g.radius_m);
      return std::numbers::pi / 3 * (g.radius_m + h) * (g.radius_m + h) * (2 * g.radius_m - h);
    };
    in_layer_m3 += below(high) - below(low);
    const int x = std::clamp(int((g.p_m.x() / bed.box_length_m + 0.5) * 4), 0, 3);
    const int y = std::clamp(int((g.p_m.y() / bed.box_width_m + 0.5) * 3), 0, 2);
    ++regions[std::size_t(y * 4 + x)];
  }
  report.solids_kg = all_m3 * materials.sand.density_kg_m3.value;
  report.solid_share = in_layer_m3 / (bed.box_length_m * bed.box_width_m * (high - low));
  for (const std::size_t n : regions) {
    report.largest_cell_deviation = std::max(
        report.largest_cell_deviation, std::abs(double(n) * 12 / double(state.grains.size()) - 1));
  }
  const SandBed sand(dem_settings(bed, materials, 1), state);
  report.coordination_number = 2.0 *
                               double(std::count_if(state.contacts.begin(), state.contacts.end(),
                                                    [](const GrainContact& c) {
                                                      return c.j < GrainContact::kWallContact;
                                                    })) /
                               double(state.grains.size());
  report.kinetic_energy_J = sand.kinetic_energy_J();
  return report;
}

}  // namespace hoof::sim
