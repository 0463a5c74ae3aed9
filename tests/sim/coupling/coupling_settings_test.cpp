#include "sim/coupling/coupling_settings.h"

#include <catch2/catch.hpp>

#include "tests/sim/coupling/shipped_plant.h"

using namespace hoof::sim;

TEST_CASE("20 exchanges make a control tick") {
  CHECK(shipped_coupling().exchange_s * 20 == Approx(1e-3).epsilon(1e-15));
  CHECK(shipped_coupling().sleep_margin_m > 0.0032);  // largest grain radius
}

TEST_CASE("a coupling without an interval is refused") {
  CouplingSettings settings = shipped_coupling();
  settings.exchange_s = 0.0;
  CHECK_THROWS_WITH(settings.validate(), "exchange_s = 0: must be above 0");
}

TEST_CASE("the shipped experiments are complete but for the bed, which is read elsewhere") {
  for (const char* name : {"sinkage", "traction"}) {
    INFO(name);
    Settings experiment =
        Settings::load_file(default_config_dir() / "experiments" / (std::string(name) + ".toml"));
    for (const char* part : {"foot", "materials", "drives", "coupling", "rigid_terrain"}) {
      INFO(part);
      CHECK(experiment.find(std::string("use.") + part) != nullptr);
    }
    CHECK(experiment.find("experiment.seed") != nullptr);
  }
}
