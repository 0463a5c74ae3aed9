// hoof terrain as a user calls it, and the runs on what it fitted.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/experiment/program.h"
#include "tests/tools/terrain/synthetic_pushes.h"
#include "tools/terrain/push_table.h"

using hoof::tests::Outcome;
using hoof::tests::run_program;
using hoof::tests::ScratchFolder;
using hoof::tools::read_file;
using hoof::tools::write_file;
namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

namespace {

void write_synthetic(const fs::path& file) {
  hoof::tools::write_pushes(file, hoof::tests::synthetic_pushes(
                                      hoof::tests::planted(hoof::sim::PressureLaw::kLinear), 0, 1));
}

/// 620 grains; plates of a quarter fit its box of 60 mm.
const char* const kSmallBed =
    "name = \"small\"\nbox_length_mm = 60\nbox_width_mm = 60\ndepth_mm = 30\nsides = \"walls\"\n"
    "sieve_low_mm = [2.5]\nsieve_high_mm = [3.0]\nmass_share_ratio = [1.0]\n"
    "grain_scale_ratio = 1.6\nsteps_per_ms = 120\nsettling_steps_per_ms = 80\nskin_um = 0\n"
    "packing_friction = 0.3\npacking_rolling_friction = 0\nrain_share_ratio = 0.30\n"
    "overfill_ratio = 1.1\ncoulomb_cap = \"total\"\nrolling_law = \"own_spin\"\n"
    "precision = \"mixed\"\n";

}  // namespace

TEST_CASE("a fit from a table gives the same bytes twice, and both tests run on it") {
  const ScratchFolder scratch;
  const fs::path pushes = scratch.path() / "pushes.csv";
  write_synthetic(pushes);
  for (const char* out : {"one", "two"}) {
    const Outcome fit = run_program({"terrain", "fit", "--quiet", "--from", pushes.string(),
                                     "--out", (scratch.path() / out).string()});
    CHECK(fit.errors.empty());
    REQUIRE(fit.status == 0);
    CHECK_THAT(fit.output, Catch::Contains("xi_n = 7.5") && Catch::Contains("on those held out"));
  }
  const fs::path soil = scratch.path() / "one/soil.toml";
  CHECK(read_file(soil) == read_file(scratch.path() / "two/soil.toml"));

  double depth_m = 0;
  for (const std::string experiment : {"sinkage", "traction"}) {
    CAPTURE(experiment);
    const fs::path first = scratch.path() / (experiment + "-1"),
                   second = scratch.path() / (experiment + "-2");
    for (const fs::path& out : {first, second}) {
      const Outcome run = run_program({experiment, "--terrain", "rft", "--soil", soil.string(),
                                       "--quiet", "--out", out.string()});
      CHECK(run.errors.empty());
      REQUIRE(run.status == 0);
      CHECK_THAT(run.output, Catch::Contains("fast soil 'pushes' ("));
    }
    for (const char* name : {"bus.log", "samples.csv", "result.json"}) {
      CHECK(read_file(first / name) == read_file(second / name));
    }
    const auto result = nlohmann::json::parse(read_file(first / "result.json"));
    CHECK(result.at("ground").at("terrain") == "rft");
    CHECK(result.at("ground").at("soil_hash").get<std::string>().size() == 16);
    CHECK(result.at("ground").at("fit_error_ratio").get<double>() < 0.01);
    CHECK(result.at("exchange_error_J").get<double>() < 0.5);
    CHECK_THAT(read_file(first / "report.html"), Catch::Contains("Hash of the soil"));
    if (experiment == "sinkage") {
      CHECK(result.at("rested").get<bool>());
      depth_m = result.at("max_depth_m");
      // A constant 392 N on 142 cm2 of sole in sand of 0.75 N/cm3 needs 35 mm and overshoots to
      // twice that; rounded edges carry less than flat ones, spines somewhat more.
      const double sole_m = result.at("max_sole_depth_m");
      CHECK(sole_m > 0.035);
      CHECK(sole_m < 1.2 * 0.070);
    } else {
      CHECK(result.at("fx_peak_N").get<double>() > 1);
    }
  }
  // A softer soil lets the foot in deeper.
  const fs::path deeper = scratch.path() / "deeper";
  REQUIRE(run_program({"sinkage", "--terrain", "rft", "--soil", soil.string(), "--set",
                       "rft_terrain.xi_n_N_m3=2e5", "--quiet", "--out", deeper.string()})
              .status == 0);
  CHECK(nlohmann::json::parse(read_file(deeper / "result.json")).at("max_depth_m") > depth_m);
}

TEST_CASE("plates are pushed into grains, kept, and fitted") {
  const ScratchFolder scratch;
  write_file(scratch.path() / "small.toml", kSmallBed);
  const fs::path out = scratch.path() / "fit";
  const Strings command = {
      "terrain", "fit",   "--bed",     (scratch.path() / "small.toml").string(),
      "--scale", "0.12",  "--speed",   "1",
      "--quiet", "--out", out.string()};
  const Outcome fit = run_program(command);
  CHECK(fit.errors.empty());
  REQUIRE(fit.status == 0);
  CHECK_THAT(fit.output, Catch::EndsWith("\n" + (out / "soil.toml").string() + "\n"));
  CHECK(hoof::tools::read_pushes(out / "pushes.csv").size() == 15);
  const std::string bytes = read_file(out / "pushes.csv");
  // One push lost: only that one is made again, with the same bytes.
  fs::remove(fs::directory_iterator(out / "cases")->path());
  REQUIRE(run_program(command).status == 0);
  CHECK(read_file(out / "pushes.csv") == bytes);
}

TEST_CASE("what hoof terrain cannot do is said in one line") {
  const ScratchFolder scratch;
  const fs::path pushes = scratch.path() / "pushes.csv";
  write_synthetic(pushes);
  const Outcome wide = run_program(
      {"terrain", "fit", "--quiet", "--scale", "3", "--out", (scratch.path() / "fit").string()});
  CHECK(wide.status == 2);
  CHECK_THAT(wide.errors, Catch::Contains("--scale"));
  CHECK(run_program({"terrain", "fit", "--from", pushes.string(), "--bed", "demo"}).status == 2);
  const Outcome soil = run_program({"sinkage", "--terrain", "rft", "--soil", "mud"});
  CHECK(soil.status == 2);
  CHECK_THAT(soil.errors, Catch::Contains("'mud' is none of demo and no file"));
  const Outcome show = run_program({"terrain", "show", "--plate", "100,50", "--depth", "20"});
  CHECK(show.status == 0);
  CHECK_THAT(show.output,
             Catch::Contains("flat plate of 100 x 50 mm") && Catch::Contains("20.0 mm"));
}
