// What a control tick costs on the board, against what it cost when it was last looked at.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/firmware/cost/cycle_rule.h"
#include "tests/tools/emulator/cost_run.h"

using namespace hoof;
using test::CostSummary;

namespace {

// Room for changes that nobody needs to argue about.
constexpr double kRoom = 1.1;
// At 168 MHz: 20 us of an ordinary tick, 50 of one that plans.
constexpr std::uint64_t kOrdinary_cycles = 20 * 168, kPlanning_cycles = 50 * 168;

void require_within(const char* what, double stored, double now) {
  CAPTURE(what, now, stored);
  CHECK(now <= kRoom * stored);
  // Much less than stored: the stored value no longer guards anything.
  CHECK(now >= stored / kRoom);
}

void require_within(const nlohmann::json& stored, const CostSummary& now) {
  const auto gate = [&](const char* key, double value) {
    require_within(key, stored.at(key), value);
  };
  gate("mean_instructions", now.mean_instructions);
  gate("most_instructions", double(now.most_instructions));
  gate("most_cycles", double(now.most_cycles));
  gate("most_planning_cycles", double(now.most_planning_cycles));
  for (std::size_t i = 0; i < test::kStages; ++i) {
    const auto& pair = stored.at("stages").at(test::kStageNames[i]);
    require_within(test::kStageNames[i], pair.at(0), now.stages[i].mean);
    require_within(test::kStageNames[i], pair.at(1), double(now.stages[i].most));
  }
}

}  // namespace

TEST_CASE(
    "a tick costs what it cost, give or take a tenth (tick_cost.json; hoof benchmark firmware)") {
  std::ifstream file(HOOF_STORED_COST);
  const nlohmann::json stored = nlohmann::json::parse(file);
  SECTION("sinkage") {
    require_within(stored.at("sinkage"), test::measure_sinkage_cost());
  }
  SECTION("traction") {
    require_within(stored.at("traction"), test::measure_traction_cost());
  }
}

TEST_CASE("the parts of a tick are all of it") {
  const CostSummary cost = test::measure_cost("traction", {}, 300);
  double sum = 0;
  for (const test::MeanAndMost& part : cost.parts) sum += part.mean;
  CHECK(sum == Approx(cost.mean_instructions));
  sum = 0;
  for (std::size_t i = 0; i < test::kStages; ++i) {
    CAPTURE(test::kStageNames[i]);
    CHECK(cost.stages[i].mean > 0);  // its function was merged into another, or has another name
    sum += cost.stages[i].mean;
  }
  CHECK(sum == Approx(cost.mean_instructions));
  CHECK(cost.ticks > 290);
  CHECK(cost.planning_ticks > 0);
  CHECK(cost.mean_cycles > cost.mean_instructions);
  WARN("largest ordinary tick " << cost.most_cycles << " cycles of " << kOrdinary_cycles
                                << ", planning " << cost.most_planning_cycles << " of "
                                << kPlanning_cycles);
}
