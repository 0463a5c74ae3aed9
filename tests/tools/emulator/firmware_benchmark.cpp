// hoof benchmark firmware: how fast the emulated image runs, with the rig on the rigid floor, and
// what its control ticks cost on the board; whether host, emulator and QEMU agree.
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>

#include "hil_bridge/lock_step.h"
#include "tests/benchmarks/lockstep_rigs.h"
#include "tests/firmware/cost/cycle_rule.h"
#include "tests/tools/emulator/cost_run.h"
#include "tests/tools/emulator/image_bench.h"
#include "tests/tools/qemu/agreement.h"
#include "tests/tools/qemu/qemu_bench.h"

namespace {

using namespace hoof;

/// By the wall's clock, which QEMU's own threads need.
template <typename Run>
double seconds_of(const Run& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Of this thread's processor: what else the machine does is left out.
double own_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// The whole test, with the rig.
double seconds(const tools::RunSettings& run, const test::FirmwareOn& firmware,
               std::uint32_t& ticks) {
  const double start_s = own_s();
  ticks = test::record_run(run, firmware).result.ticks;
  return own_s() - start_s;
}

/// Ticks a second of control and bus alone: the joints are held, nothing moves.
double held_rate(const tools::RunSettings& run, const test::FirmwareOn& firmware) {
  constexpr int kTicks = 5'000;
  const auto experiment = benchmarks::held(run);
  const auto wires = bridge::in_process_wires({});
  bridge::LockStep lock_step(*experiment, firmware(*wires), *wires);
  lock_step.supervisor().order(firmware::protocol::Order::kReady, 0.0);
  for (int i = 0; i < 100; ++i) lock_step.tick();
  const double start_s = own_s();
  for (int i = 0; i < kTicks; ++i) lock_step.tick();
  return kTicks / (own_s() - start_s);
}

/// Commands of the three runners over the whole test, byte for byte, and QEMU's speed once it runs.
void print_agreement(const tools::RunSettings& run) {
  using namespace test;
  const RunRecord by_host = record_run(run, host(run)), by_emulator = record_run(run, image(run));
  std::printf(
      "{\"case\": \"%s\", \"agreement_of\": %u, \"commands\": %zu, \"same_in_emulator\": %zu",
      run.kind.c_str(), by_host.result.ticks, command_count(by_host),
      agreed_commands(by_host, by_emulator));
  if (qemu_is_here()) {
    RunRecord by_qemu;
    const double start_s = seconds_of([&] { record_run(run, in_qemu(run), 1); });
    const double whole_s = seconds_of([&] { by_qemu = record_run(run, in_qemu(run)); });
    std::printf(", \"same_in_qemu\": %zu, \"qemu_ticks_per_s\": %.0f, \"qemu_start_s\": %.2f",
                agreed_commands(by_host, by_qemu), by_qemu.result.ticks / (whole_s - start_s),
                start_s);
  }
  std::printf("}\n");
  std::fflush(stdout);
}

double us(double cycles) {
  return cycles / tests::cost::kClockHz * 1e6;
}

void print_cost(const char* kind, const test::CostSummary& c) {
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
  const auto print = [](const char* what, const char* name, const test::MeanAndMost& m) {
    std::printf("  {\"%s\": \"%s\", \"mean_instructions\": %.1f, \"most_instructions\": %llu}\n",
                what, name, m.mean, static_cast<unsigned long long>(m.most));
  };
  for (std::size_t i = 0; i < test::kStages; ++i) {
    print("stage", test::kStageNames[i], c.stages[i]);
  }
  for (std::size_t i = 0; i < test::kParts; ++i) {
    print("part", test::kPartNames[i], c.parts[i]);
  }
}

}  // namespace

int main() {
  try {
    for (const char* kind : {"sinkage", "traction"}) {
      const auto run = test::rigid_run(kind);
      std::uint32_t ticks = 0;
      const double host_s = seconds(run, test::host(run), ticks);
      const double image_s = seconds(run, test::image(run), ticks);
      std::cout << "{\"case\": \"" << kind << "\", \"ticks\": " << ticks
                << ", \"host_ticks_per_s\": " << int(ticks / host_s)
                << ", \"image_ticks_per_s\": " << int(ticks / image_s)
                << ", \"image_alone_us_per_tick\": " << (image_s - host_s) / ticks * 1e6
                << ", \"held_host_ticks_per_s\": " << int(held_rate(run, test::host(run)))
                << ", \"held_image_ticks_per_s\": " << int(held_rate(run, test::image(run))) << "}"
                << std::endl;
      print_agreement(run);
    }
    std::cout << std::flush;
    print_cost("sinkage", test::measure_sinkage_cost());
    print_cost("traction", test::measure_traction_cost());
  } catch (const std::exception& error) {
    std::cerr << "hoof benchmark firmware: " << error.what() << "\n";
    return 3;
  }
}
