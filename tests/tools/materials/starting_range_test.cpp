// Starting ranges: members of the set give the asked angle back, on a surface of known form and on
// both stored ones; the card is one that a run takes.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "sim/config/settings.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/calibrate/paper_tables.h"
#include "tools/calibrate/repose_table.h"
#include "tools/diagnose/csv_table.h"
#include "tools/materials/material_shelf.h"
#include "tools/materials/starting_card.h"
#include "tools/materials/starting_text.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof;
using namespace hoof::tools;

namespace {

namespace fs = std::filesystem;

const fs::path kHeaps = default_materials_dir() / "repose_heaps.csv";

StartingRequest asked(double repose_deg, double bulk_density_kg_m3 = 1550) {
  StartingRequest r;
  r.bulk_density_kg_m3 = bulk_density_kg_m3;
  r.repose_deg = repose_deg;
  return r;
}

/// angle = 30 + 10 mu_r coded + 5 mu_s coded, whatever e: a plane of known form.
ReposeSurface plane() {
  Runs runs;
  runs.source = "plane";
  for (const double e : {0.1, 0.45, 0.8}) {
    for (const double r : {0.1, 0.25, 0.4}) {
      for (const double s : {0.2, 0.55, 0.9}) {
        runs.factors.push_back({e, r, s});
        runs.response.push_back(30 + 10 * (r - 0.25) / 0.15 + 5 * (s - 0.55) / 0.35);
      }
    }
  }
  const std::vector<Factor> box = {{"e", 0.1, 0.8}, {"mu_r", 0.1, 0.4}, {"mu_s", 0.2, 0.9}};
  return {"a plane", "27 points", ResponseSurface(box, runs, SurfaceModel::kQuadratic), 15, 45};
}

}  // namespace

TEST_CASE("starting range: on a plane the set is the strip that the closed form says") {
  const ReposeSurface s = plane();
  const StartingRange r = starting_range(s, asked(38), usual_doubts(s));
  // 38 +- 1 at mu_s coded -1..1: mu_r coded from (7 - 5) / 10 to 1, and mu_s from -0.6 on.
  const double grid = 2.0 / 60;  // coded, of the valley's points
  CHECK(r.valley.low[0] == Approx(0.1));
  CHECK(r.valley.high[0] == Approx(0.8));
  CHECK(r.valley.low[1] == Approx(0.25 + 0.15 * 0.2).margin(0.15 * grid));
  CHECK(r.valley.high[1] == Approx(0.4));
  CHECK(r.valley.low[2] == Approx(0.55 - 0.35 * 0.6).margin(0.35 * grid));
  CHECK(r.covered);
  REQUIRE(r.members.size() == 3);
  // e tells nothing of the plane: knowing it leaves all of the others; mu_r narrows mu_s, as
  // they are bound to each other.
  CHECK(r.valley.left[0].width[1] == Approx(1).margin(0.02));
  CHECK(r.valley.left[0].width[2] == Approx(1).margin(0.02));
  CHECK(r.valley.left[1].width[2] < 0.6);
}

TEST_CASE("starting range: each member gives the angle back by its surface and lies in the box") {
  for (const ReposeSurface& s : {plane(), surface_of_paper(), surface_of_heaps(kHeaps)}) {
    for (const double angle_deg : {12.0, 20.0, 28.0, 33.0, 37.8, 42.0}) {
      INFO(s.name << " at " << angle_deg);
      const StartingRange r = starting_range(s, asked(angle_deg), usual_doubts(s));
      if (!r.covered) continue;
      REQUIRE(r.members.size() == 3);
      for (const StartingRange::Member& m : r.members) {
        const std::vector<Factor>& f = s.surface.factors();
        const std::vector<double> coded = {f[0].coded(m.restitution),
                                           f[1].coded(m.rolling_friction),
                                           f[2].coded(m.static_friction)};
        // By the printed coefficients, not by what was kept.
        CHECK(s.surface.at(coded) == Approx(angle_deg).margin(0.01));
        CHECK(m.angle_deg == Approx(angle_deg).margin(0.01));
        for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(coded[i]) <= 1 + 1e-9);
      }
    }
  }
}

TEST_CASE("starting range: the paper's surface is the paper's fit") {
  const ReposeSurface s = surface_of_paper();
  for (const auto& [e, r, m] : {std::tuple(0.54, 0.34, 0.52), {0.2, 0.15, 0.3}, {0.7, 0.38, 0.8}}) {
    const std::vector<Factor>& f = s.surface.factors();
    // Printed to five digits: 0.02 degrees over the box.
    CHECK(s.surface.at({f[0].coded(e), f[1].coded(r), f[2].coded(m)}) ==
          Approx(paper_repose_fit_deg(e, r, m)).margin(0.02));
  }
  CHECK(s.lowest_deg == 1.18);
  CHECK(s.highest_deg == 55.2);
}

TEST_CASE("starting range: the stored heaps are the design's, each combination and seed once") {
  const CsvTable t = read_csv(
      kHeaps, {"e_ratio", "mu_r_ratio", "mu_s_ratio", "seed_count", "grains_count", "outlet_mm"});
  std::map<std::tuple<double, double, double>, std::set<double>> seeds;
  for (std::size_t i = 0; i < t.lines.size(); ++i) {
    const auto at = [&](const char* name) { return t.columns[std::size_t(t.find(name))][i]; };
    CHECK(
        seeds[{at("e_ratio"), at("mu_r_ratio"), at("mu_s_ratio")}].insert(at("seed_count")).second);
    CHECK(at("grains_count") == HeapTest{}.grains);
    CHECK(at("outlet_mm") == Approx(1e3 * HeapTest{}.outlet_m));
  }
  CHECK(seeds.size() == repose_combinations().size());
  for (const auto& [combination, of] : seeds) CHECK(of.size() == seeds.begin()->second.size());
}

TEST_CASE("starting range: grain density is the bulk's over the solid share of our beds") {
  CHECK(asked(33, 1550).grain_density_kg_m3() == Approx(1550 / 0.598));
  CHECK_THAT(density_text(asked(33, 1550)),
             Catch::Contains("Grain density 2592 kg/m3") && !Catch::Contains("Warning"));
  CHECK_THAT(density_text(asked(33, 1100)), Catch::Contains("Warning: hardly a mineral's"));
  StartingRequest fine = asked(33);
  fine.d50_m = 0.4e-3;
  CHECK_THAT(density_text(fine), Catch::Contains("stand for yours of 0.4 mm"));
}

TEST_CASE("starting range: an angle that no heap had is warned of, one that nothing gives too") {
  const ReposeSurface s = surface_of_paper();
  const StartingRange steep = starting_range(s, asked(58), usual_doubts(s));
  CHECK_FALSE(steep.covered);
  CHECK_THAT(range_text(s, asked(58), steep), Catch::Contains("Warning: 58 degrees lie outside"));
  const StartingRange none = starting_range(s, asked(80), usual_doubts(s));
  CHECK(none.members.empty());
  CHECK_THAT(range_text(s, asked(80), none), Catch::Contains("nothing with e 0.1 to 0.8"));
  CHECK_THROWS_AS(starting_card("x", "hoof", s, asked(80), none), UserError);
  CHECK_THROWS_WITH(asked(95).validate(), "--repose = 95 deg, must be from 1 to 89 deg");
  CHECK_THROWS_WITH(asked(33, 1.55).validate(),
                    "--bulk-density = 1.55 kg/m3, must be from 300 to 5000 kg/m3");
}

TEST_CASE("starting range: the card is one that a run takes, with the set as its ranges") {
  const tests::ScratchFolder scratch;
  const fs::path file = scratch.path() / "mine.toml";
  const ReposeSurface s = surface_of_paper();
  StartingRequest request = asked(33);
  request.d50_m = 0.4e-3;
  const StartingRange r = starting_range(s, request, usual_doubts(s));
  const std::string command = "hoof material suggest --bulk-density 1550 --repose 33";
  write_file(file, starting_card("mine", command, s, request, r));
  const sim::MaterialCard c = sim::read_material_card(sim::Settings::load_file(file));
  CHECK(c.name == "mine");
  CHECK(c.status == "starting range");
  CHECK(c.materials.sand.density_kg_m3.value == Approx(1550 / 0.598).epsilon(1e-5));
  CHECK(c.materials.sand_sand.rolling_friction.value ==
        Approx(r.members[0].rolling_friction).epsilon(1e-5));
  CHECK(c.materials.sand_sand.static_friction.source.find(command) != std::string::npos);
  CHECK(*c.ranges.at("sand_sand.restitution").low == Approx(0.1));
  CHECK(*c.ranges.at("card.repose_deg").high == Approx(34));
  const std::vector<std::string> use = {"use.materials=" + file.string()};
  const sim::Settings run = sim::Settings::load_experiment("sinkage", use);
  const sim::Materials m = sim::read_materials(sim::Reader(run).section("materials"));
  CHECK(m.sand_sand.restitution.value == c.materials.sand_sand.restitution.value);
  CHECK(m.sand_abs.static_friction.value == 0.5929);
}

TEST_CASE("starting range: sands like it are told") {
  const Shelf shelf = read_shelf();
  CHECK_THAT(alike_text(shelf, asked(33)), Catch::Contains("dune"));
  CHECK_THAT(alike_text(shelf, asked(80, 4000)), Catch::Contains("none"));
}
