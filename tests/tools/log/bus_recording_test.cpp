#include "tools/log/bus_recording.h"

#include <catch2/catch.hpp>

#include "hil_bridge/recording.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/log/cut.h"
#include "tools/log/export.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
using hoof::tests::ScratchFolder;

namespace {

BusRecording read(const std::string& text) {
  const ScratchFolder scratch;
  write_file(scratch.path() / "x.log", text);
  return read_bus_log(scratch.path() / "x.log");
}

/// SYNC of ticks 0 to 9 on both buses, each a millisecond behind the other, from `second` on.
std::string syncs(const std::string& second) {
  std::string text;
  for (int tick = 0; tick < 10; ++tick) {
    for (const char* bus : {"can0", "can1"}) {
      text += "(" + second + ".00" + std::to_string(tick) + "095) " + bus + " 010#0000000" +
              std::to_string(tick) + "\n";
    }
  }
  return text;
}

}  // namespace

TEST_CASE("a log of other tools: directions, FD frames, comments, names of interfaces") {
  const BusRecording r = read(
      "# captured by hand\n"
      "\n"
      "(1700000000.000100) vcan1 123#0102 R\n"
      "(1700000000.000200) vcan0 123##1AABB T\r\n"
      "(1700000000.000300) slcan 12345678#R4\n");
  REQUIRE(r.frames.size() == 3);
  CHECK(r.interfaces == std::vector<std::string>{"vcan0", "vcan1", "slcan"});
  CHECK(r.frames[0].bus == 1);
  CHECK(r.frames[1].bus == 0);
  CHECK(r.frames[1].frame.fd);
  CHECK(r.frames[2].frame.remote);
  CHECK(r.origin_ns == 1'700'000'000'000'100'000);  // the first frame
  CHECK(r.time_s(r.frames[2]) == Approx(200e-6));
}

TEST_CASE("times of a simulated run count from its start, as in samples.csv") {
  const BusRecording r = read("(1767225600.250000) can0 123#\n");
  CHECK(r.origin_ns == hoof::bridge::kSimulatedEpoch_ns);
  CHECK(r.time_s(r.frames[0]) == Approx(0.25));
}

TEST_CASE("a broken line is named by its number; a last one that is cut off is left out") {
  const std::string good = "(1767225600.250000) can0 123#00\n";
  CHECK_THROWS_WITH(read(good + "# remark\n" + good + "(17672256 can0 123#00\n" + good),
                    Catch::Contains("x.log:4: "));
  CHECK_THROWS_AS(read(good + "nonsense\n"), UserError);
  const BusRecording cut_off = read(good + good + "(1767225600.26");
  CHECK(cut_off.frames.size() == 2);
  REQUIRE(cut_off.notes.size() == 1);
  CHECK_THAT(cut_off.notes[0], Catch::Contains("x.log:3: "));
}

TEST_CASE("frames come by time, those of one time as the log has them") {
  const BusRecording r = read(
      "(1700000000.000200) can0 001#\n(1700000000.000100) can0 002#\n"
      "(1700000000.000200) can0 003#\n");
  REQUIRE(r.frames.size() == 3);
  CHECK(r.frames[0].frame.id == 2);
  CHECK(r.frames[1].frame.id == 1);
  CHECK(r.frames[2].frame.id == 3);
  CHECK(r.notes.size() == 1);
}

TEST_CASE("what is written as candump lines reads back as the same") {
  const std::string text = syncs("1767225600");
  const BusRecording r = read(text);
  std::ostringstream out;
  export_candump(r, out);
  CHECK(out.str() == text);
}

TEST_CASE("a cut by ticks starts with the SYNC of both buses and ends before the next") {
  const BusRecording r = read(syncs("1767225600"));
  CutRange range;
  range.from_tick = 3;
  range.to_tick = 5;
  const BusRecording part = cut(r, range);
  REQUIRE(part.frames.size() == 6);
  CHECK(part.frames.front().frame.data[3] == 3);
  CHECK(part.frames.back().frame.data[3] == 5);
  CHECK(part.origin_ns == r.origin_ns);  // absolute times stay

  range = {};
  range.from_s = 0.002095;  // included
  range.to_s = 0.004095;    // not included
  CHECK(cut(r, range).frames.size() == 4);
  range = {};
  range.from_tick = 10;
  CHECK_THROWS_WITH(cut(r, range), Catch::Contains("no SYNC of tick 10 or later"));
  range = {};
  range.from_s = 5;
  CHECK_THROWS_WITH(cut(r, range), Catch::Contains("no frames there"));
}
