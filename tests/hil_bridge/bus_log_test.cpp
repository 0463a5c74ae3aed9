#include "hil_bridge/bus_log.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "hil_bridge/candump.h"
#include "hil_bridge/recording.h"
#include "tests/hil_bridge/temporary_file.h"

namespace hoof::bridge {
namespace {

using test::TemporaryFile;

hal::CanFrame frame_at(std::int64_t stamp_ns, std::uint32_t id) {
  hal::CanFrame frame;
  frame.id = id;
  frame.length = 2;
  frame.data[0] = static_cast<std::uint8_t>(id);
  frame.stamp_ns = stamp_ns;
  return frame;
}

void write_thousand(const std::string& path) {
  BusLogWriter log({path, {"can0", "can1"}});
  for (int i = 0; i < 1'000; ++i) log.write(i % 2, frame_at(i * 111'111, static_cast<unsigned>(i)));
  log.close();
}

}  // namespace

TEST_CASE("bus.log has a line per frame, from the simulated epoch, by bus name", "[bus_log]") {
  const TemporaryFile file("bus.log");
  BusLogWriter log({file.path(), {"can0", "can1"}});
  log.write(0, frame_at(130'000, 0x10));
  log.write(1, frame_at(1'234'567'890, 0x211));
  CHECK(log.frames() == 2);
  log.close();
  log.close();
  CHECK(file.bytes() ==
        "(1767225600.000130) can0 010#1000\n"
        "(1767225601.234568) can1 211#1100\n");
}

TEST_CASE("the log is read back by the one parser, and is the same every time", "[bus_log]") {
  const TemporaryFile first("first.log");
  const TemporaryFile second("second.log");
  write_thousand(first.path());
  write_thousand(second.path());
  CHECK(first.bytes() == second.bytes());
  std::ifstream input(first.path());
  CandumpReader reader(input, "first.log");
  int count = 0;
  while (const auto record = reader.next()) {
    REQUIRE(record->frame == frame_at(0, static_cast<unsigned>(count)));
    REQUIRE(record->interface == (count % 2 == 0 ? "can0" : "can1"));
    // Half a microsecond is what the format's resolution takes away.
    REQUIRE(std::abs(record->stamp_ns - kSimulatedEpoch_ns - count * 111'111) <= 500);
    ++count;
  }
  CHECK(count == 1'000);
}

TEST_CASE("a run that is killed leaves whole lines, up to its last 10 ms", "[bus_log]") {
  const TemporaryFile file("killed.log");
  BusLogWriter log({file.path(), {"can0"}});
  const std::int64_t last_ns = 1'000'000'000;
  for (std::int64_t t_ns = 0; t_ns <= last_ns; t_ns += 250'000) log.write(0, frame_at(t_ns, 1));
  // Not closed, not flushed: what is on disk now is what a kill would leave.
  const std::string bytes = file.bytes();
  REQUIRE_FALSE(bytes.empty());
  CHECK(bytes.back() == '\n');
  std::istringstream input(bytes);
  CandumpReader reader(input, "killed.log");
  std::int64_t read_until_ns = 0;
  while (const auto record = reader.next()) read_until_ns = record->stamp_ns - kSimulatedEpoch_ns;
  CHECK(read_until_ns >= last_ns - kRecordingFlush_ns);
}

TEST_CASE("a full disk and an impossible path are errors that name the file", "[bus_log]") {
  BusLogWriter log({"/dev/full", {"can0"}});
  const auto fill = [&] {
    for (int i = 0; i < 100'000; ++i) log.write(0, frame_at(i * 100'000, 1));
  };
  CHECK_THROWS_WITH(fill(), "cannot write /dev/full: No space left on device");
  CHECK_THROWS_WITH(log.close(), "cannot write /dev/full: No space left on device");
  log.close();  // is closed by now
  CHECK_THROWS_WITH(BusLogWriter({"/nowhere/bus.log", {"can0"}}),
                    "cannot create /nowhere/bus.log: No such file or directory");
}

TEST_CASE("a bus without a name is refused", "[bus_log]") {
  const TemporaryFile file("names.log");
  BusLogWriter log({file.path(), {"can0"}});
  CHECK_THROWS_AS(log.write(1, frame_at(0, 1)), std::out_of_range);
  CHECK_THROWS_AS(log.write(-1, frame_at(0, 1)), std::out_of_range);
}

}  // namespace hoof::bridge
