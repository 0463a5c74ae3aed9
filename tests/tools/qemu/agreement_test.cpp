// Host build, our emulator, QEMU: the same test, the same frames. QEMU is a second opinion on what
// our emulator takes the core and the serial lines to be, by people who have not seen ours.
#include "tests/tools/qemu/agreement.h"

#include <catch2/catch.hpp>

#include "tests/tools/qemu/qemu_bench.h"

using namespace hoof;
using test::RunRecord;

namespace {

/// Sinkage to its end; of traction, whose hip and knee begin to move after 300.
constexpr std::uint32_t kTicks = 700;
/// The toes open by then.
constexpr std::uint32_t kOpening = 300;

}  // namespace

TEST_CASE("700 ticks of sinkage and traction: host, emulator and QEMU send the same frames") {
  if (!test::qemu_is_here()) return;
  const std::string kind = GENERATE("sinkage", "traction");
  const tools::RunSettings run = test::rigid_run(kind);
  const RunRecord host = test::record_run(run, test::host(run), kTicks);
  const RunRecord emulator = test::record_run(run, test::image(run), kTicks);
  const RunRecord qemu = test::record_run(run, test::in_qemu(run), kTicks);
  for (const int bus : {0, 1}) {
    CAPTURE(kind, bus);
    const test::Commands expected = test::commands(host, bus);
    // Sinkage moves the toes alone, on bus 0; traction all three joints.
    if (bus == 0 || kind == "traction") {
      CHECK(expected.size() >= std::min(kTicks, host.result.ticks) - 5);
      CHECK(test::different(expected) > 100);
    }
    CHECK(test::commands(emulator, bus) == expected);
    CHECK(test::commands(qemu, bus) == expected);
  }
  // Beyond the commands: whatever anybody sent, and when, to the nanosecond.
  CAPTURE(kind);
  CHECK(test::agreed_frames(host, qemu) == host.frames.size());
  CHECK(qemu.frames.size() == host.frames.size());
}

TEST_CASE("QEMU: a gain of the board's flash changes what is on the bus") {
  if (!test::qemu_is_here()) return;
  const tools::RunSettings run = test::rigid_run("sinkage");
  const tools::RunSettings other = test::rigid_run("sinkage", {"control.toe_kp_Nm_rad=249"});
  const RunRecord a = test::record_run(run, test::in_qemu(run), kOpening);
  const RunRecord b = test::record_run(other, test::in_qemu(other), kOpening);
  CHECK(test::command_count(a) == test::command_count(b));
  CHECK(test::agreed_commands(a, b) < test::command_count(a));
}
