#include "tools/reproduce/cost.h"

#include <catch2/catch.hpp>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
namespace fs = std::filesystem;

namespace {

PlannedRun sinkage(const std::string& id, const std::string& speed) {
  return {id,
          "sinkage",
          {"use.bed=demo", "experiment.terrain=dem", "experiment.speed_m_s=" + speed},
          ""};
}

void finished(const RunStore& store, const std::string& id, double run_s, int threads) {
  fs::create_directories(store.place(id));
  write_file(store.place(id) / "timing.json",
             "{\"build_s\": 99, \"run_s\": " + std::to_string(run_s) +
                 ", \"threads\": " + std::to_string(threads) + "}");
  write_file(store.place(id) / "samples.csv", std::string(1000000, 'x'));
}

}  // namespace

TEST_CASE("costs: of the same condition, else of the same speed, else of the same kind") {
  const hoof::tests::ScratchFolder scratch;
  const RunStore store(scratch.path());
  const std::vector<PlannedRun> all = {sinkage("a-bed1", "0.1"), sinkage("a-bed2", "0.1"),
                                       sinkage("b-bed1", "0.1"), sinkage("c-bed1", "0.4")};
  CHECK(CostModel(store, all).source().find("first guess") != std::string::npos);
  finished(store, "a-bed1", 10, 2);
  finished(store, "b-bed1", 40, 1);
  const CostModel model(store, all);
  CHECK(model.of(all[1]).core_s == Approx(20));                    // its own condition
  CHECK(model.of(sinkage("d-bed1", "0.1")).core_s == Approx(30));  // that speed
  CHECK(model.of(all[3]).core_s == Approx(30));                    // that kind
  CHECK(model.of(all[1]).disk_bytes == Approx(1e6).epsilon(1e-3));
  CHECK(model.source() == "by 2 finished runs of this folder");
  CHECK(model.of({"e-bed1", "traction", {"use.bed=demo", "experiment.terrain=dem"}, ""}).core_s >
        0);  // by the table
  const std::string text = cost_text(model, {all[1], all[3]}, 2, 1);
  CHECK_THAT(text, Catch::Contains("2 runs missing: about 25 s with 2 at once"));
  CHECK(cost_text(model, {}, 2, 1) == "nothing is missing\n");
}
