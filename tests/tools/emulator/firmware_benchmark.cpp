// hoof benchmark firmware: how fast the emulated image runs, with the rig on the rigid floor, and
// what its control ticks cost on the board.
#include <chrono>
#include <cstdio>
#include <iostream>

#include "tests/firmware/cost/cycle_rule.h"
#include "tests/tools/emulator/cost_run.h"
#include "tests/tools/emulator/image_bench.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds(const hoof::tools::RunSettings& run, const hoof::test::FirmwareOn& firmware,
               std::uint32_t& ticks) {
  const auto start = Clock::now();
  ticks = hoof::test::record_run(run, firmware).result.ticks;
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double us(double cycles) {
  return cycles / hoof::tests::cost::kClockHz * 1e6;
}

void print_cost(const char* kind, const hoof::test::CostSummary& c) {
  std::printf(
      "{\"case\": \"%s\", \"cost_of\": %llu, \"mean_instructions\": %.0f, \"most_instructions\": "
      "%llu, "
      "\"most_cycles\": %llu, \"most_planning_cycles\": %llu, \"mean_us\": %.1f, "
      "\"most_us\": %.1f, \"most_planning_us\": %.1f, \"planning_ticks\": %llu, "
      "\"mean_planning_instructions\": %.0f, \"mean_planning_us\": %.1f}\n",
      kind, static_cast<unsigned long long>(c.ticks), c.mean_instructions,
      static_cast<unsigned long long>(c.most_instructions),
      static_cast<unsigned long long>(c.most_cycles),
      static_cast<unsigned long long>(c.most_planning_cycles), us(c.mean_cycles),
      us(double(c.most_cycles)), us(double(c.most_planning_cycles)),
      static_cast<unsigned long long>(c.planning_ticks), c.mean_planning_instructions,
      us(c.mean_planning_cycles));
  const auto print = [](const char* what, const char* name, const hoof::test::MeanAndMost& m) {
    std::printf("  {\"%s\": \"%s\", \"mean_instructions\": %.0f, \"most_instructions\": %llu}\n",
                what, name, m.mean, static_cast<unsigned long long>(m.most));
  };
  for (std::size_t i = 0; i < hoof::test::kStages; ++i) {
    print("stage", hoof::test::kStageNames[i], c.stages[i]);
  }
  for (std::size_t i = 0; i < hoof::test::kParts; ++i) {
    print("part", hoof::test::kPartNames[i], c.parts[i]);
  }
}

}  // namespace

int main() {
  try {
    for (const char* kind : {"sinkage", "traction"}) {
      const auto run = hoof::test::rigid_run(kind);
      std::uint32_t ticks = 0;
      const double host_s = seconds(run, hoof::test::host(run), ticks);
      const double image_s = seconds(run, hoof::test::image(run), ticks);
      std::cout << "{\"case\": \"" << kind << "\", \"ticks\": " << ticks
                << ", \"host_ticks_per_s\": " << int(ticks / host_s)
                << ", \"image_ticks_per_s\": " << int(ticks / image_s)
                << ", \"image_alone_us_per_tick\": " << (image_s - host_s) / ticks * 1e6 << "}\n";
    }
    std::cout << std::flush;
    print_cost("sinkage", hoof::test::measure_sinkage_cost());
    print_cost("traction", hoof::test::measure_traction_cost());
  } catch (const std::exception& error) {
    std::cerr << "hoof benchmark firmware: " << error.what() << "\n";
    return 3;
  }
}
