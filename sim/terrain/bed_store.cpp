#include "sim/terrain/bed_store.h"

#include <cstdio>
#include <stdexcept>

#include "sim/terrain/bed_file.h"

namespace hoof::sim {
namespace {

// Raised whenever the same settings would give another bed: a change of the recipe in bed_maker.cpp
// or of what a step of the engine computes.
constexpr int kRecipe = 3;

std::string text(double value) {
  return to_text(Value(value));
}

}  // namespace

std::string BedStore::key(const BedSettings& bed, const Materials& materials, std::uint64_t seed) {
  std::string k = "recipe=" + std::to_string(kRecipe) + " seed=" + std::to_string(seed);
  const auto add = [&](const char* name, double value) {
    k += std::string(" ") + name + "=" + text(value);
  };
  add("box_length_m", bed.box_length_m), add("box_width_m", bed.box_width_m);
  add("depth_m", bed.depth_m), add("periodic", bed.periodic_sides);
  for (const SieveClass& c : bed.sieve) {
    add("low_m", c.low_m), add("high_m", c.high_m), add("mass_share", c.mass_share);
  }
  add("scale", bed.grain_scale), add("steps_per_ms", bed.steps_per_ms);
  add("settling_steps_per_ms", bed.settling_steps_per_ms);
  add("skin_m", bed.skin_m), add("packing_friction", bed.packing_friction);
  add("packing_rolling", bed.packing_rolling_friction);
  add("rain_share", bed.rain_share);
  add("overfill", bed.overfill), add("cap", int(bed.coulomb_cap));
  add("rolling", int(bed.rolling_law)), add("precision", int(bed.precision));
  for (const Material* m : {&materials.sand, &materials.abs}) {
    add("young_Pa", m->young_Pa.value), add("poisson", m->poisson.value);
    add("density_kg_m3", m->density_kg_m3.value);
  }
  for (const ContactPair* p : {&materials.sand_sand, &materials.sand_abs}) {
    add("e", p->restitution.value), add("mu_s", p->static_friction.value);
    add("mu_r", p->rolling_friction.value);
  }
  return k;
}

std::filesystem::path BedStore::file(const BedSettings& bed, const Materials& materials,
                                     std::uint64_t seed) const {
  const std::string k = key(bed, materials, seed);
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(fnv1a(k.data(), k.size())));
  return folder_ / (bed.name + "-" + std::to_string(seed) + "-" + hash + ".bed");
}

StoredBed BedStore::get(const BedSettings& bed, const Materials& materials, std::uint64_t seed,
                        int threads, const BedProgress& progress) const {
  StoredBed stored;
  stored.file = file(bed, materials, seed);
  const std::string k = key(bed, materials, seed);
  if (std::filesystem::exists(stored.file)) {
    try {
      stored.state = read_bed_file(stored.file, k);
      return stored;
    } catch (const std::runtime_error& e) {
      stored.discarded = e.what();  // said by the caller; the bed is made anew
    }
  }
  require_writable(stored.file);
  stored.state = make_bed(bed, materials, seed, threads, progress);
  stored.made = true;
  write_bed_file(stored.file, k, stored.state);
  return stored;
}

}  // namespace hoof::sim
