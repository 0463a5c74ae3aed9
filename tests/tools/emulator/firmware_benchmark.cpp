// hoof benchmark firmware: how fast the emulated image runs, with the rig on the rigid floor.
#include <chrono>
#include <iostream>

#include "tests/tools/emulator/image_bench.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds(const hoof::tools::RunSettings& run, const hoof::test::FirmwareOn& firmware,
               std::uint32_t& ticks) {
  const auto start = Clock::now();
  ticks = hoof::test::record_run(run, firmware).result.ticks;
  return std::chrono::duration<double>(Clock::now() - start).count();
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
  } catch (const std::exception& error) {
    std::cerr << "hoof benchmark firmware: " << error.what() << "\n";
    return 3;
  }
}
