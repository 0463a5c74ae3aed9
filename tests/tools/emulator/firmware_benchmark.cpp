// hoof benchmark firmware: how fast the emulated image runs, with the rig on the rigid floor, and
// what its control ticks cost on the board; whether host, emulator and QEMU agree.
#include <CLI/CLI.hpp>
#include <algorithm>
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

struct Held {
  double start_s = 0;  // for an image: boot loader, check of the signature, 1.6 s of board time
  double ticks_per_s = 0;
};

/// Control and bus alone: the joints are held, nothing moves. The best of some rounds: what else
/// the machine does only ever makes one slower.
Held held(const tools::RunSettings& run, const test::FirmwareOn& firmware, int rounds) {
  constexpr int kTicks = 5'000;
  Held held;
  const auto experiment = benchmarks::held(run);
  const auto wires = bridge::in_process_wires({});
  const double power_on_s = own_s();
  bridge::LockStep lock_step(*experiment, firmware(*wires), *wires);
  held.start_s = own_s() - power_on_s;
  lock_step.supervisor().order(firmware::protocol::Order::kReady, 0.0);
  for (int i = 0; i < 100; ++i) lock_step.tick();
  for (int round = 0; round < rounds; ++round) {
    const double start_s = own_s();
    for (int i = 0; i < kTicks; ++i) lock_step.tick();
    held.ticks_per_s = std::max(held.ticks_per_s, kTicks / (own_s() - start_s));
  }
  return held;
}

void print_held(const tools::RunSettings& run, int rounds) {
  const Held by_host = held(run, test::host(run), rounds);
  const Held by_image = held(run, test::image(run), rounds);
  std::printf(
      "{\"case\": \"%s\", \"rounds\": %d, \"held_host_ticks_per_s\": %.0f, "
      "\"held_image_ticks_per_s\": %.0f, \"image_start_s\": %.3f}\n",
      run.kind.c_str(), rounds, by_host.ticks_per_s, by_image.ticks_per_s, by_image.start_s);
  std::fflush(stdout);
}

void print_run(const tools::RunSettings& run) {
  std::uint32_t ticks = 0;
  const double host_s = seconds(run, test::host(run), ticks);
  const double image_s = seconds(run, test::image(run), ticks);
  std::printf(
      "{\"case\": \"%s\", \"ticks\": %u, \"host_ticks_per_s\": %.0f, "
      "\"image_ticks_per_s\": %.0f, \"image_alone_us_per_tick\": %.1f}\n",
      run.kind.c_str(), ticks, ticks / host_s, ticks / image_s, (image_s - host_s) / ticks * 1e6);
  std::fflush(stdout);
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

constexpr char kAbout[] =
    "How fast the board's image runs in the emulator, whether host, emulator and QEMU agree, and "
    "what a control tick costs on the board. One JSON line a case, times of this thread's "
    "processor.\n\nExamples:\n"
    "  hoof benchmark firmware                     all of it, a minute\n"
    "  hoof benchmark firmware held --rounds 10    control and bus alone, the best of ten rounds\n"
    "  hoof benchmark firmware cost                instructions and cycles of a tick, by stage\n";

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(kAbout, "hoof benchmark firmware");
  const std::vector<std::string> all = {"held", "run", "agreement", "cost"};
  std::vector<std::string> what = all;
  int rounds = 5;
  app.add_option("what", what,
                 "held: joints held, nothing but firmware, buses, drive models and supervisor; "
                 "run: the whole test on rigid ground; agreement; cost")
      ->check(CLI::IsMember(all));
  app.add_option("--rounds", rounds, "of 5,000 ticks each, of held; the best is printed")
      ->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  const auto asked = [&](const char* one) { return std::ranges::count(what, one) != 0; };
  try {
    for (const char* kind : {"sinkage", "traction"}) {
      const auto run = test::rigid_run(kind);
      if (asked("held")) print_held(run, rounds);
      if (asked("run")) print_run(run);
      if (asked("agreement")) print_agreement(run);
    }
    if (!asked("cost")) return 0;
    print_cost("sinkage", test::measure_sinkage_cost());
    print_cost("traction", test::measure_traction_cost());
  } catch (const std::exception& error) {
    std::cerr << "hoof benchmark firmware: " << error.what() << "\n";
    return 3;
  }
}
