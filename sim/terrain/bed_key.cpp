#include "sim/terrain/bed_key.h"

#include <charconv>
#include <functional>
#include <stdexcept>

namespace hoof::sim {
namespace {

// Raised whenever the same settings would give another bed: a change of the recipe in bed_maker.cpp
// or of what a step of the engine computes.
constexpr int kRecipe = 3;

/// Names and places of all that a key holds besides recipe, seed and sieve, in its order.
template <typename Visit>
void each_box_field(BedSettings& bed, Visit visit) {
  visit("box_length_m", bed.box_length_m), visit("box_width_m", bed.box_width_m);
  visit("depth_m", bed.depth_m), visit("periodic", bed.periodic_sides);
}

template <typename Visit>
void each_other_field(BedSettings& bed, Materials& materials, Visit visit) {
  visit("scale", bed.grain_scale), visit("steps_per_ms", bed.steps_per_ms);
  visit("settling_steps_per_ms", bed.settling_steps_per_ms), visit("skin_m", bed.skin_m);
  visit("packing_friction", bed.packing_friction);
  visit("packing_rolling", bed.packing_rolling_friction);
  visit("rain_share", bed.rain_share), visit("overfill", bed.overfill);
  visit("cap", bed.coulomb_cap), visit("rolling", bed.rolling_law);
  visit("precision", bed.precision);
  for (Material* m : {&materials.sand, &materials.abs}) {
    visit("young_Pa", m->young_Pa.value), visit("poisson", m->poisson.value);
    visit("density_kg_m3", m->density_kg_m3.value);
  }
  for (ContactPair* p : {&materials.sand_sand, &materials.sand_abs}) {
    visit("e", p->restitution.value), visit("mu_s", p->static_friction.value);
    visit("mu_r", p->rolling_friction.value);
  }
}

class KeyWriter {
 public:
  explicit KeyWriter(std::string start) : key_(std::move(start)) {}
  template <typename T>
  void operator()(const char* name, const T& value) {
    key_ += std::string(" ") + name + "=" + to_text(Value(static_cast<double>(value)));
  }
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

class KeyReader {
 public:
  explicit KeyReader(std::string_view key) : rest_(key) {}

  bool next_is(std::string_view name) const {
    return rest_.starts_with(name) && rest_.substr(name.size()).starts_with('=');
  }

  template <typename T>
  void operator()(const char* name, T& value) {
    double number = 0;
    get(name, number);
    value = static_cast<T>(number);
  }
  void operator()(const char* name, std::uint64_t& value) { get(name, value); }

  bool at_end() const { return rest_.empty(); }

 private:
  template <typename T>
  void get(std::string_view name, T& value) {
    if (!next_is(name)) fail(name);
    rest_.remove_prefix(name.size() + 1);
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) fail(name);
    rest_.remove_prefix(std::size_t(end - rest_.data()));
    if (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }
  [[noreturn]] void fail(std::string_view name) const {
    throw std::runtime_error("says '" + std::string(rest_.substr(0, 30)) + "' where its " +
                             std::string(name) + " should be");
  }

  std::string_view rest_;
};

}  // namespace

std::string bed_key(const BedSettings& bed, const Materials& materials, std::uint64_t seed) {
  BedOrigin origin{bed, materials, seed};
  KeyWriter write("recipe=" + std::to_string(kRecipe) + " seed=" + std::to_string(seed));
  each_box_field(origin.bed, std::ref(write));
  for (const SieveClass& c : bed.sieve) {
    write("low_m", c.low_m), write("high_m", c.high_m), write("mass_share", c.mass_share);
  }
  each_other_field(origin.bed, origin.materials, std::ref(write));
  return write.key();
}

BedOrigin parse_bed_key(std::string_view key) {
  BedOrigin origin;
  KeyReader read(key);
  std::uint64_t recipe = 0;
  read("recipe", recipe);
  if (recipe != kRecipe) {
    throw std::runtime_error("was made by recipe " + std::to_string(recipe) +
                             ", this program has recipe " + std::to_string(kRecipe));
  }
  read("seed", origin.seed);
  each_box_field(origin.bed, std::ref(read));
  while (read.next_is("low_m")) {
    SieveClass c;
    read("low_m", c.low_m), read("high_m", c.high_m), read("mass_share", c.mass_share);
    origin.bed.sieve.push_back(c);
  }
  each_other_field(origin.bed, origin.materials, std::ref(read));
  if (!read.at_end()) throw std::runtime_error("says more than this program knows");
  origin.bed.validate();
  return origin;
}

}  // namespace hoof::sim
