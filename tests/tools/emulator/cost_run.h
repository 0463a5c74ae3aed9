// The cost of the control ticks of whole tests on the rigid floor.
#pragma once

#include <algorithm>
#include <string>

#include "tests/tools/emulator/image_bench.h"
#include "tests/tools/emulator/tick_cost.h"

namespace hoof::test {

/// Instructions a tick.
struct MeanAndMost {
  double mean = 0;
  std::uint64_t most = 0;

  void add(std::uint64_t instructions, std::size_t ticks) {
    mean += double(instructions) / double(ticks);
    most = std::max(most, instructions);
  }
};

struct CostSummary {
  std::uint64_t ticks = 0;
  double mean_instructions = 0, mean_cycles = 0;
  std::uint64_t most_instructions = 0;
  std::uint64_t most_cycles = 0;  // of a tick that does not plan
  std::uint64_t planning_ticks = 0;
  double mean_planning_instructions = 0, mean_planning_cycles = 0;
  std::uint64_t most_planning_cycles = 0;
  std::array<MeanAndMost, kParts> parts{};
  std::array<MeanAndMost, kStages> stages{};
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
    for (std::size_t i = 0; i < kParts; ++i) {
      s.parts[i].add(tick.part_instructions[i], ticks.size());
    }
    for (std::size_t i = 0; i < kStages; ++i) {
      s.stages[i].add(tick.stage_instructions[i], ticks.size());
    }
    if (!tick.plans) continue;
    ++s.planning_ticks;
    s.mean_planning_instructions += double(tick.instructions);
    s.mean_planning_cycles += double(tick.cycles);
  }
  if (s.planning_ticks > 0) {
    s.mean_planning_instructions /= double(s.planning_ticks);
    s.mean_planning_cycles /= double(s.planning_ticks);
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
