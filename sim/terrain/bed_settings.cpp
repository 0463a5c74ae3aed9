#include "sim/terrain/bed_settings.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hoof::sim {
namespace {

void require(bool ok, const std::string& rule) {
  if (!ok) throw std::invalid_argument(rule);
}

std::string number(double value) {
  return to_text(Value(value));
}

PairCoefficients coefficients(const ContactPair& pair) {
  return {pair.restitution.value, pair.static_friction.value, pair.rolling_friction.value};
}

ElasticMaterial elastic(const Material& m) {
  return {m.young_Pa.value, m.poisson.value, m.density_kg_m3.value};
}

std::vector<SieveClass> read_sieve_lists(Reader& section) {
  std::vector<double> low, high, share;
  section.numbers("sieve_low_mm", low, kMillimetre, 0.05, 100);
  section.numbers("sieve_high_mm", high, kMillimetre, 0.05, 100);
  section.numbers("mass_share_ratio", share, kUnitless, 0, 1);
  if (low.size() != high.size() || low.size() != share.size()) {
    section.fail("mass_share_ratio",
                 "sieve_low_mm, sieve_high_mm and mass_share_ratio must be "
                 "equally long");
  }
  std::vector<SieveClass> sieve;
  for (std::size_t i = 0; i < low.size(); ++i) sieve.push_back({low[i], high[i], share[i]});
  return sieve;
}

/// A table in a file takes the place of the lists, which a preset may still hold.
std::vector<SieveClass> read_sieve_file(Reader& section) {
  for (const char* list : {"sieve_low_mm", "sieve_high_mm", "mass_share_ratio"}) {
    std::vector<double> unused;
    if (section.has(list)) section.numbers(list, unused, kUnitless, 0, 100);
  }
  std::string file;
  section.text("sieve_file", file);
  SieveSelection selection;
  if (section.has("sieve_range_mm")) {
    std::vector<double> range_m;
    section.numbers("sieve_range_mm", range_m, kMillimetre, 0, 100);
    if (range_m.size() != 2) section.fail("sieve_range_mm", "must be two numbers: from, to");
    selection.from_m = range_m[0], selection.to_m = range_m[1];
  }
  if (section.has("sieve_scale_ratio")) {
    section.number("sieve_scale_ratio", selection.scale, kUnitless, 0.05, 50);
  }
  return read_sieve_table(file, selection);
}

}  // namespace

double BedSettings::d50_m() const {
  double below = 0;
  for (const SieveClass& c : sieve) {
    if (below + c.mass_share >= 0.5) {
      return grain_scale * (c.low_m + (0.5 - below) / c.mass_share * (c.high_m - c.low_m));
    }
    below += c.mass_share;
  }
  return largest_diameter_m();
}

void BedSettings::validate() const {
  require(!sieve.empty(), "sieve_low_mm needs at least one class");
  double total = 0;
  for (std::size_t i = 0; i < sieve.size(); ++i) {
    const SieveClass& c = sieve[i];
    require(c.low_m < c.high_m, "sieve class " + std::to_string(i + 1) +
                                    ": sieve_low_mm = " + number(c.low_m * 1e3) +
                                    " must be under sieve_high_mm = " + number(c.high_m * 1e3));
    require(i == 0 || c.low_m >= sieve[i - 1].high_m,
            "sieve classes must go from small to large without overlap");
    total += c.mass_share;
  }
  require(std::abs(total - 1) < 1e-3,
          "mass_share_ratio adds up to " + number(total) + ", must be 1 within 0.001");
  const double d = largest_diameter_m();
  require(depth_m >= 4 * d, "depth_mm = " + number(depth_m * 1e3) +
                                ", must be at least 4 of the largest grains (" + number(4e3 * d) +
                                " mm)");
  for (const auto& [name, side_m] :
       {std::pair("box_length_mm", box_length_m), std::pair("box_width_mm", box_width_m)}) {
    require(side_m >= 6 * d, name + (" = " + number(side_m * 1e3)) +
                                 ", must be at least 6 of the largest grains (" + number(6e3 * d) +
                                 " mm)");
  }
}

BedSettings read_bed(Reader section) {
  BedSettings bed;
  section.text("name", bed.name);
  section.number("box_length_mm", bed.box_length_m, kMillimetre, 10, 5000);
  section.number("box_width_mm", bed.box_width_m, kMillimetre, 10, 5000);
  section.number("depth_mm", bed.depth_m, kMillimetre, 5, 2000);
  std::string sides, cap, rolling, precision;
  section.choice("sides", sides, {"walls", "periodic"});
  bed.periodic_sides = sides == "periodic";
  bed.sieve = section.has("sieve_file") ? read_sieve_file(section) : read_sieve_lists(section);
  section.number("grain_scale_ratio", bed.grain_scale, kUnitless, 0.05, 50);
  section.integer("steps_per_ms", bed.steps_per_ms, 10, 100000);
  section.integer("settling_steps_per_ms", bed.settling_steps_per_ms, 1, 100000);
  section.number("skin_um", bed.skin_m, kMicrometre, 0, 20000);
  section.number("packing_friction", bed.packing_friction, kUnitless, 0, 5);
  section.number("packing_rolling_friction", bed.packing_rolling_friction, kUnitless, 0, 5);
  section.number("rain_share_ratio", bed.rain_share, kUnitless, 0.05, 0.55);
  section.number("overfill_ratio", bed.overfill, kUnitless, 1, 2);
  section.choice("coulomb_cap", cap, {"total", "elastic"});
  section.choice("rolling_law", rolling, {"own_spin", "relative_spin"});
  section.choice("precision", precision, {"mixed", "double"});
  bed.coulomb_cap = cap == "total" ? CoulombCap::kTotalNormal : CoulombCap::kElasticNormal;
  bed.rolling_law = rolling == "own_spin" ? RollingLaw::kOwnSpin : RollingLaw::kRelativeSpin;
  bed.precision = precision == "mixed" ? Precision::kMixed : Precision::kDouble;
  section.finish();
  section.check([&] { bed.validate(); });
  return bed;
}

DemSettings dem_settings(const BedSettings& bed, const Materials& materials, int threads) {
  DemSettings s;
  const double x = bed.box_length_m / 2, y = bed.box_width_m / 2;
  // Room outside of the walls for grains that press into them, and above for the rain of grains and
  // for what a foot throws up: three depths, less the room above the lid.
  const double room_m = bed.periodic_sides ? 0 : 2 * bed.largest_diameter_m();
  s.low_m = {-x - room_m, -y - room_m, -bed.depth_m - 2 * bed.largest_diameter_m()};
  s.high_m = {x + room_m, y + room_m, 3 * bed.depth_m};
  s.periodic = {bed.periodic_sides, bed.periodic_sides, false};
  s.walls = {{Eigen::Vector3d::UnitZ(), -bed.depth_m}};
  if (!bed.periodic_sides) {
    s.walls.push_back({Eigen::Vector3d::UnitX(), -x});
    s.walls.push_back({-Eigen::Vector3d::UnitX(), -x});
    s.walls.push_back({Eigen::Vector3d::UnitY(), -y});
    s.walls.push_back({-Eigen::Vector3d::UnitY(), -y});
  }
  // A lid for what a foot throws up: without it a grain would leave the domain, and with it the
  // bed. Above it, room as outside of the walls, but in beds of a few grains.
  const double lid_m = std::max(2 * bed.depth_m, 3 * bed.depth_m - 4 * bed.largest_diameter_m());
  s.walls.push_back({-Eigen::Vector3d::UnitZ(), -lid_m});
  s.grain_material = elastic(materials.sand);
  s.wall_material = elastic(materials.abs);
  s.grain_grain = coefficients(materials.sand_sand);
  s.grain_wall = coefficients(materials.sand_abs);
  s.coulomb_cap = bed.coulomb_cap;
  s.rolling_law = bed.rolling_law;
  s.dt_s = bed.step_s();
  s.skin_m = bed.skin_m;
  s.precision = bed.precision;
  s.threads = threads;
  return s;
}

}  // namespace hoof::sim
