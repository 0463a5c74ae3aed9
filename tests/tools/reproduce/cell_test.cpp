#include "tools/reproduce/cell.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "sim/experiments/resolution.h"
#include "tools/experiment/run_settings.h"
#include "tools/reproduce/campaign.h"
#include "tools/reproduce/ground.h"
#include "tools/reproduce/paper.h"

using namespace hoof::tools;

namespace {

std::set<Part> all_parts() {
  std::set<Part> parts;
  for (const auto& [name, part] : part_names()) parts.insert(part);
  return parts;
}

}  // namespace

TEST_CASE("plan: each run once, bed after bed, and every number of the paper has one") {
  for (const Design design : {Design::kStated, Design::kFull}) {
    const std::vector<Cell> cells = plan_cells(all_parts(), design, 3, 7);
    std::set<std::string> ids, conditions;
    for (const Cell& cell : cells) {
      CHECK(ids.insert(cell.id()).second);
      conditions.insert(cell.condition());
    }
    CHECK(cells.size() == 3 * conditions.size());
    CHECK(std::is_sorted(cells.begin(), cells.end(),
                         [](const Cell& a, const Cell& b) { return a.bed < b.bed; }));
    CHECK(cells.front().bed == 7);
    CHECK(cells.back().bed == 9);
    for (const PaperSinkage& row : paper_sinkages()) CHECK(conditions.count(row.condition) == 1);
    for (const PaperTraction& row : paper_tractions()) CHECK(conditions.count(row.condition) == 1);
  }
  // 3 feet x 2 loads x 2 speeds, 5 openings x 2 x 2 less two that are there, 3 feet x 2 steps,
  // 5 openings x 2 less two.
  CHECK(plan_cells(all_parts(), Design::kStated, 1, 1).size() == 12 + 18 + 6 + 8);
  // 3 x 6 x 2, 5 x 6 x 2 less the closed ones that are there.
  CHECK(plan_cells(all_parts(), Design::kFull, 1, 1).size() == 36 + 48 + 6 + 8);
}

TEST_CASE("ground: bench is a night of two cores, and its step is said to every run") {
  const Ground demo, bench{"bench", "dem"}, paper{"paper", "dem"}, quick{"bench", "rft"};
  CHECK(demo.design() == Design::kStated);
  CHECK(bench.design() == Design::kNight);
  CHECK(paper.design() == Design::kStated);
  CHECK(quick.design() == Design::kStated);
  CHECK(demo.folder() == "runs/reproduce-demo");
  CHECK(quick.folder() == "runs/reproduce-bench-rft");
  const auto step_s = [](const Ground& ground) {
    return read_run_settings("sinkage", ground.settings().of("sinkage")).bed.step_s();
  };
  CHECK(step_s(bench) == Approx(5.6e-6).epsilon(0.01));                    // 1 ms / 180
  CHECK(step_s(Ground{"medium", "dem"}) == Approx(8.3e-6).epsilon(0.01));  // 1 ms / 120
  CHECK(step_s(paper) == Approx(2.8e-6).epsilon(0.01));
}

TEST_CASE("ground: a foot that is pulled has room before the walls, on bench in grains of medium") {
  for (const char* bed : {"demo", "medium", "bench", "paper"}) {
    INFO(bed);
    const Ground ground{bed, "dem"};
    const auto run = read_run_settings("traction", ground.settings().of("traction"));
    CHECK(hoof::sim::wall_warning(run.bed, reach_m(run), run.traction.ellipse) == "");
  }
  const auto tree = [](const char* bed) {
    return read_run_settings("traction", Ground{bed, "dem"}.settings().of("traction")).tree;
  };
  CHECK(settings_hash(tree("bench")) == settings_hash(tree("medium")));
  // The user has the last word there too.
  CampaignSettings finer = Ground{"bench", "dem"}.settings();
  finer.asked = {"bed.grain_scale_ratio=1", "bed.steps_per_ms=180"};
  const auto asked = read_run_settings("traction", finer.of("traction")).bed;
  CHECK(asked.grain_scale == 1);
  CHECK(asked.box_length_m == Approx(0.53));
}

TEST_CASE("ground: a traction knows no rest, and what is asked for counts last") {
  CampaignSettings settings = Ground{"bench", "dem"}.settings();
  CHECK_NOTHROW(read_run_settings("traction", settings.of("traction")));
  CHECK(read_run_settings("sinkage", settings.of("sinkage")).sinkage.rest_speed_m_s == 0.020);
  // Variations are of the bed: they must not stumble over what a traction alone knows.
  settings.asked = {"experiment.cycles=2", "bed.depth_mm=80"};
  CHECK_THROWS(read_run_settings("sinkage", settings.of("sinkage")));
  CHECK(read_run_settings("sinkage", settings.ground_of("sinkage")).bed.depth_m == Approx(0.08));
  CHECK(read_run_settings("traction", settings.ground_of("traction")).bed.depth_m == Approx(0.08));
  // What the name of a run says is so, whatever the ground and the user say of all.
  Cell finer = cell_of("sinkage-bionic-toe0-10kg-0.1m_s");
  finer.variation = "fine-grains", finer.changes = {"bed.steps_per_ms=240"};
  settings.asked = {"experiment.load_kg=60"};
  const RunSettings fine = read_run_settings("sinkage", settings.of(finer));
  CHECK(fine.bed.steps_per_ms == 240);
  CHECK(fine.sinkage.load_N == Approx(98.1));
  settings.asked = {"experiment.rest_speed_mm_s=7"};
  CHECK(read_run_settings("sinkage", settings.of("sinkage")).sinkage.rest_speed_m_s == 0.007);
}

TEST_CASE("plan: the night's conditions are some of the stated, and both feet of each ratio") {
  std::set<std::string> stated, night;
  for (const Cell& c : plan_cells(all_parts(), Design::kStated, 1, 1)) stated.insert(c.id());
  for (const Cell& c : plan_cells(all_parts(), Design::kNight, 1, 1)) night.insert(c.id());
  CHECK(night.size() == 9 + 2 + 5);
  for (const std::string& id : night) CHECK(stated.count(id) == 1);
  for (std::string id : night) {
    const auto at = id.find("bionic-toe0");
    if (at == std::string::npos || id.find("60kg") != std::string::npos) continue;
    CHECK(night.count(id.replace(at, 11, "bionic-plain-toe0")) == 1);
  }
}

TEST_CASE("plan: a cell is what its name says") {
  const auto cells = plan_cells({Part::kOpening, Part::kTraction}, Design::kStated, 1, 4);
  const auto of = [&](const std::string& id) {
    const auto found =
        std::find_if(cells.begin(), cells.end(), [&](const Cell& cell) { return cell.id() == id; });
    REQUIRE(found != cells.end());
    return read_run_settings(found->kind(), found->overrides());
  };
  const RunSettings open = of("sinkage-bionic-toe30-60kg-0.4m_s-bed4");
  CHECK(open.is_sinkage());
  CHECK(open.foot_name == "bionic");
  CHECK(open.sinkage.toe_rad == Approx(30 * 3.14159265358979 / 180));
  CHECK(open.sinkage.load_N == Approx(60 * 9.81).epsilon(1e-3));
  CHECK(open.sinkage.speed_m_s == 0.4);
  CHECK(open.seed == 4);
  const RunSettings sole = of("traction-traditional-1.12Hz-bed4");
  CHECK_FALSE(sole.is_sinkage());
  CHECK(sole.foot_name == "traditional");
  CHECK(sole.traction.frequency_Hz == 1.12);
}

TEST_CASE("a campaign's hashes: threads change nothing, a setting does, a foot is its geometry") {
  const auto hash = [](std::vector<std::string> more) {
    return settings_hash(read_run_settings("sinkage", more).tree);
  };
  const std::string plain = hash({});
  CHECK(plain.size() == 64);
  CHECK(hash({"experiment.threads=7"}) == plain);
  CHECK(hash({"experiment.fields=none"}) == plain);
  CHECK(hash({"experiment.seed=2"}) != plain);
  CHECK(hash({"bed.depth_mm=110"}) != plain);
  const auto geometry = [](std::vector<std::string> more) {
    return geometry_hash(read_run_settings("sinkage", more).tree);
  };
  CHECK(geometry({"experiment.seed=2"}) == geometry({}));
  CHECK(geometry({"use.foot=traditional"}) != geometry({}));
  CHECK(geometry({"foot.spines.length_mm=9"}) != geometry({}));
}
