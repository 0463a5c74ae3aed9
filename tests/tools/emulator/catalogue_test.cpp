// Every fault of the catalogue that `hoof study faults` puts into the loop in process, put into the
// image in a walking foot: the same frames, byte for byte, the bits and the time to the safe state
// that the catalogue states, and a reset that brings it back.
#include <set>

#include "tests/tools/emulator/golden.h"
#include "tools/faults/matrix_cases.h"

using namespace hoof;
using firmware::control::Mode;
using test::RunRecord;
using tools::Expectation;
using tools::MatrixCase;

namespace {

constexpr std::uint32_t kMostTicks = 4'000;

tools::RunSettings walk() {
  return test::rigid_run("traction", {"experiment.frequency_Hz=1", "experiment.toe_deg=20"});
}

/// When the leg is on its way: its gait has run for 0.3 s.
double walking_s() {
  const tools::RunSettings run = walk();
  const auto experiment = test::rigid_bench(run);
  const auto wires = bridge::in_process_wires([](int, const hal::CanFrame&) {});
  double begin_s = 0;
  bridge::run_session(*experiment, bridge::local_firmware(run.parameters), *wires,
                      tools::session_settings(run), [&](const bridge::TickRecord& record) {
                        begin_s = record.plant.time_s;
                        return record.firmware.mode != Mode::kRunning;
                      });
  return begin_s + 0.3;
}

/// Of the foot itself: in every run.
const std::set<std::string> kOfTheFoot = {"drop: commands of the knee",
                                          "drop: a tenth of bus 1",
                                          "drop: heartbeat",
                                          "bus_off: foot",
                                          "node_silent: foot",
                                          "brown_out: 12 V",
                                          "node_restart: foot, power on",
                                          "node_restart: foot, watchdog"};

/// A controller that is off its bus comes back by its driver's back-off, the bus in process at
/// once: the same until the fault ends; after it the reaction is compared.
const std::set<std::string> kFramesDiffer = {"bus_off: foot"};

/// What was on the wire before.
RunRecord until(RunRecord record, double time_s) {
  std::erase_if(record.frames, [time_s](const test::SeenFrame& seen) {
    return double(seen.frame.stamp_ns) * 1e-9 > time_s;
  });
  return record;
}

/// @param what the catalogue expects of a walking foot
void check_reaction(const MatrixCase& fault, const RunRecord& record) {
  const Expectation& expected = fault.expected(Mode::kRunning);
  REQUIRE(record.result.reaction);
  const bridge::Reaction& reaction = *record.result.reaction;
  CAPTURE(reaction.faults, bridge::fault_bit_names(reaction.faults), reaction.mode);
  // Without frames a board looks once a millisecond, not every 50 us: when it finds that SYNC is
  // lost the drives' last replies are too old as well.
  const bool sync = (expected.bits & firmware::control::fault::kSyncLost) != 0;
  const std::uint32_t allowed = expected.bits | (sync ? firmware::control::fault::kDriveLost : 0);
  CHECK((reaction.faults & ~allowed) == 0);
  if (expected.bits == 0 && expected.safe_s == 0) return;  // the test may end while it goes on
  if (expected.bits != 0 && !expected.idle && !fault.gap) CHECK(reaction.faults != 0);
  if (reaction.faults == 0) return;
  REQUIRE(reaction.safe_s);
  REQUIRE(record.result.faults.at(0).began_s);
  // A conversion of the supply is two ticks old at most.
  CHECK(*reaction.safe_s - *record.result.faults[0].began_s <= expected.safe_s + 0.002);
  CHECK(reaction.reset_s);
}

}  // namespace

TEST_CASE("catalogue: faults in a walking foot, host and image") {
  static const double begin_s = walking_s();
  std::size_t number = 0;
  for (const MatrixCase& fault : tools::matrix_cases()) {
    const bool by_reaction = kFramesDiffer.count(fault.name) != 0;
    const bool always = kOfTheFoot.count(fault.name) != 0;
    if (!test::full() && !always && number++ % 6 != 0) continue;
    DYNAMIC_SECTION(fault.name) {
      tools::RunSettings run = walk();
      run.faults = {fault.fault};
      run.faults[0].at_s = begin_s;
      const RunRecord board = test::record_run(run, test::image(run), kMostTicks);
      check_reaction(fault, board);
      const RunRecord host = test::record_run(run, test::host_at_board_pace(run), kMostTicks);
      check_reaction(fault, host);
      CHECK(board.result.reaction->faults == host.result.reaction->faults);
      CHECK(board.result.reaction->reset_s.has_value() ==
            host.result.reaction->reset_s.has_value());
      if (!by_reaction) {
        test::require_same(host, board, host.result.ticks / 2);
      } else {
        const double until_s = *board.result.faults.at(0).ended_s;
        test::require_same_frames(until(host, until_s), until(board, until_s),
                                  std::size_t(begin_s * 1e3) / 2);
      }
    }
  }
}
