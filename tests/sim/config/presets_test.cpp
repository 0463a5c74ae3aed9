// The shipped settings files, read by the code that uses them where that is in sim/config itself.
#include <catch2/catch.hpp>
#include <filesystem>

#include "sim/config/config_error.h"
#include "sim/config/materials.h"

using namespace hoof::sim;

TEST_CASE("the paper's materials are as printed there") {
  Settings run;
  run.merge(Settings::load_file(default_config_dir() / "materials/paper.toml"), "materials");
  const Materials m = read_materials(Reader(run).section("materials"));
  CHECK(m.sand.young_Pa.value == 178.5e6);
  CHECK(m.sand.poisson.value == 0.25);
  CHECK(m.sand.density_kg_m3.value == 2650.0);
  CHECK(m.abs.young_Pa.value == 2.02e9);
  CHECK(m.abs.poisson.value == 0.37);
  CHECK(m.abs.density_kg_m3.value == 1050.0);
  CHECK(m.sand_sand.restitution.value == 0.54);
  CHECK(m.sand_sand.static_friction.value == 0.52);
  CHECK(m.sand_sand.rolling_friction.value == 0.34);
  CHECK(m.sand_abs.restitution.value == 0.5636);
  CHECK(m.sand_abs.static_friction.value == 0.5929);
  CHECK(m.sand_abs.rolling_friction.value == 0.0408);
  CHECK_FALSE(m.sand_abs.rolling_friction.source.empty());
}

TEST_CASE("every shipped file is TOML") {
  int files = 0;
  for (const auto& item : std::filesystem::recursive_directory_iterator(default_config_dir())) {
    if (item.path().extension() != ".toml") continue;
    INFO(item.path());
    CHECK_NOTHROW(Settings::load_file(item.path()));
    ++files;
  }
  CHECK(files >= 11);
}
