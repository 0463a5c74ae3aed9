// The cost of the control ticks of whole tests on the rigid floor.
#pragma once

#include <algorithm>
#include <string>

#include "tests/tools/emulator/image_bench.h"
#include "tests/tools/emulator/tick_cost.h"

namespace hoof::test {

struct CostSummary {
  std::uint64_t ticks = 0;
  double mean_instructions = 0, mean_cycles = 0;
  std::uint64_t most_instructions = 0;
  std::uint64_t most_cycles = 0;  // of a tick that does not plan
  std::uint64_t planning_ticks = 0;
  std::uint64_t most_planning_cycles = 0;
  std::array<double, kParts> part_mean{};
  std::array<std::uint64_t, kParts> part_most{};
};

inline CostSummary summarise(const std::vector<TickCost>& ticks) {
  CostSummary s;
  s.ticks = ticks.size();
  for (const TickCost& tick : ticks) {
    s.mean_instructions += double(tick.instructions) / double(ticks.size());
    s.mean_cycles += double(tick.cycles) / double(ticks.size());
    s.most_instructions = std::max(s.most_instructions, tick.instructions);
    std::uint64_t& most = tick.plans ? s.most_planning_cycles : s.most_cycles;
    most = std::max(most, tick.cycles);
    s.planning_ticks += tick.plans ? 1 : 0;
    for (std::size_t p = 0; p < kParts; ++p) {
      s.part_mean[p] += double(tick.part_instructions[p]) / double(ticks.size());
      s.part_most[p] = std::max(s.part_most[p], tick.part_instructions[p]);
    }
  }
  return s;
}

inline CostSummary measure_cost(const std::string& kind, const std::vector<std::string>& set,
                                std::uint32_t most_ticks) {
  const tools::RunSettings run = rigid_run(kind, set);
  std::unique_ptr<TickCostCounter> counter;
  const auto image = tools::emulator::read_elf_file(image_file());
  const FirmwareOn counted = [&](bridge::Wires& wires) {
    return [&](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
      using tools::emulator::EmulatedFirmware;
      auto node = std::make_unique<EmulatedFirmware>(
          image, tools::emulator::flash_with(run.parameters), EmulatedFirmware::Buses{&bus0, &bus1},
          EmulatedFirmware::Buses{&wires.attach(0, "recorder"), &wires.attach(1, "recorder")},
          clock);
      counter = std::make_unique<TickCostCounter>(node->emulated_board());
      return node;
    };
  };
  record_run(run, counted, most_ticks);
  return summarise(counter->ticks());
}

/// What is measured, for the benchmark and the gate alike.
inline CostSummary measure_sinkage_cost() {
  return measure_cost("sinkage", {"experiment.toe_deg=20"}, UINT32_MAX);
}
inline CostSummary measure_traction_cost() {
  return measure_cost("traction", {"experiment.frequency_Hz=1", "experiment.toe_deg=20"}, 4'000);
}

}  // namespace hoof::test
