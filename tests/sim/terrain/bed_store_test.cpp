#include "sim/terrain/bed_store.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <set>

#include "tests/sim/terrain/small_bed.h"
#include "tests/sim/terrain/temporary_folder.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

TEST_CASE("a bed is made once, found afterwards, and made anew when its file is damaged") {
  const TemporaryFolder folder("bed-store");
  const BedStore store(folder.path() / "beds");
  const BedSettings bed = small_bed();
  const Materials materials = shipped_materials();
  int calls = 0;
  const BedProgress count = [&calls](double) {
    ++calls;
    return true;
  };

  const StoredBed first = store.get(bed, materials, 1, 1, count);
  CHECK(first.made);
  CHECK(first.discarded.empty());
  CHECK(first.file == store.file(bed, materials, 1));
  CHECK(std::filesystem::exists(first.file));
  CHECK(calls > 0);

  calls = 0;
  const StoredBed second = store.get(bed, materials, 1, 1, count);
  CHECK_FALSE(second.made);
  CHECK(calls == 0);
  CHECK(numbers(second.state) == numbers(first.state));

  const std::string whole = read_bytes(first.file);
  std::string damaged = whole;
  damaged[damaged.size() / 2] ^= 1;
  write_bytes(first.file, damaged);
  const StoredBed third = store.get(bed, materials, 1, 1, count);
  CHECK(third.made);
  CHECK(third.discarded ==
        first.file.string() + " is damaged or truncated: its checksum does not match");
  CHECK(read_bytes(first.file) == whole);
}

TEST_CASE("a bed that is stopped while it is made leaves no file") {
  const TemporaryFolder folder("bed-stopped");
  const BedStore store(folder.path());
  CHECK_THROWS_WITH(store.get(small_bed(), shipped_materials(), 1, 1, [](double) { return false; }),
                    "stopped");
  CHECK(folder.count() == 0);
}

TEST_CASE("a store that cannot be written says so before the bed is made") {
  const TemporaryFolder folder("bed-closed");
  write_bytes(folder.path() / "file", "x");
  int calls = 0;
  CHECK_THROWS_WITH(BedStore(folder.path() / "file")
                        .get(small_bed(), shipped_materials(), 1, 1,
                             [&calls](double) {
                               ++calls;
                               return true;
                             }),
                    Catch::StartsWith("cannot write " + (folder.path() / "file").string()));
  CHECK(calls == 0);
}

TEST_CASE("every setting that can change a bed changes its key and its file") {
  using Change = void (*)(BedSettings&, Materials&);
  const Change changes[] = {
      [](BedSettings&, Materials&) {},
      [](BedSettings& b, Materials&) { b.box_length_m += 1e-9; },
      [](BedSettings& b, Materials&) { b.box_width_m += 1e-9; },
      [](BedSettings& b, Materials&) { b.depth_m += 1e-9; },
      [](BedSettings& b, Materials&) { b.periodic_sides = true; },
      [](BedSettings& b, Materials&) { b.sieve[0].low_m -= 1e-9; },
      [](BedSettings& b, Materials&) { b.sieve[0].high_m += 1e-9; },
      [](BedSettings& b, Materials&) { b.sieve[0].mass_share -= 1e-9; },
      [](BedSettings& b, Materials&) {
        b.sieve.push_back({3e-3, 4e-3, 0});
      },
      [](BedSettings& b, Materials&) { b.grain_scale = 2.000001; },
      [](BedSettings& b, Materials&) { b.steps_per_ms = 161; },
      [](BedSettings& b, Materials&) { b.settling_steps_per_ms = 81; },
      [](BedSettings& b, Materials&) { b.skin_m *= 2; },
      [](BedSettings& b, Materials&) { b.packing_friction = 0.31; },
      [](BedSettings& b, Materials&) { b.packing_rolling_friction = 0.01; },
      [](BedSettings& b, Materials&) { b.rain_share = 0.31; },
      [](BedSettings& b, Materials&) { b.overfill = 1.11; },
      [](BedSettings& b, Materials&) { b.coulomb_cap = CoulombCap::kElasticNormal; },
      [](BedSettings& b, Materials&) { b.rolling_law = RollingLaw::kRelativeSpin; },
      [](BedSettings& b, Materials&) { b.precision = Precision::kDouble; },
      [](BedSettings&, Materials& m) { m.sand.young_Pa.value += 1; },
      [](BedSettings&, Materials& m) { m.sand.poisson.value += 1e-6; },
      [](BedSettings&, Materials& m) { m.sand.density_kg_m3.value += 1; },
      [](BedSettings&, Materials& m) { m.abs.young_Pa.value += 1; },
      [](BedSettings&, Materials& m) { m.abs.poisson.value += 1e-6; },
      [](BedSettings&, Materials& m) { m.sand_sand.restitution.value += 1e-6; },
      [](BedSettings&, Materials& m) { m.sand_sand.static_friction.value += 1e-6; },
      [](BedSettings&, Materials& m) { m.sand_sand.rolling_friction.value += 1e-6; },
      [](BedSettings&, Materials& m) { m.sand_abs.restitution.value += 1e-6; },
      [](BedSettings&, Materials& m) { m.sand_abs.static_friction.value += 1e-6; },
      [](BedSettings&, Materials& m) { m.sand_abs.rolling_friction.value += 1e-6; },
  };
  const BedStore store("beds");
  std::set<std::string> keys, files;
  for (const Change change : changes) {
    BedSettings bed = small_bed();
    Materials materials = shipped_materials();
    change(bed, materials);
    keys.insert(BedStore::key(bed, materials, 1));
    files.insert(store.file(bed, materials, 1).string());
  }
  CHECK(keys.size() == std::size(changes));
  CHECK(files.size() == std::size(changes));
  const std::string other_seed = BedStore::key(small_bed(), shipped_materials(), 2);
  CHECK(keys.count(other_seed) == 0);
  CHECK(other_seed.find('\n') == std::string::npos);
  CHECK(BedStore::key(small_bed(), shipped_materials(), 1) ==
        BedStore::key(small_bed(), shipped_materials(), 1));
}
