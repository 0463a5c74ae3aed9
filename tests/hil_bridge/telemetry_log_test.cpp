#include "hil_bridge/telemetry_log.h"

#include <catch2/catch.hpp>
#include <hoof/run_t.hpp>
#include <hoof/sample_t.hpp>
#include <lcm/lcm-cpp.hpp>
#include <random>
#include <system_error>

#include "hil_bridge/recording.h"
#include "tests/hil_bridge/temporary_file.h"

namespace hoof::bridge {
namespace {

using test::TemporaryFile;

TelemetryRun run() {
  return {"sinkage", "bionic", "0.1.0", "cafe", 0.001};
}

TelemetryRow row(std::int64_t tick, unsigned seed) {
  std::mt19937_64 random(seed * 100'000U + static_cast<unsigned>(tick));
  std::uniform_real_distribution<double> value(-300.0, 300.0);
  TelemetryRow out;
  out.time_ns = tick * 1'000'000;
  out.tick = tick;
  out.depth_m = value(random);
  out.sink_speed_m_s = value(random);
  for (std::size_t i = 0; i < 3; ++i) {
    out.foot_force_N[i] = value(random);
    out.foot_torque_Nm[i] = value(random);
    out.desired[i] = {value(random), value(random), value(random)};
    out.measured[i] = {value(random), value(random), value(random)};
  }
  out.mode = static_cast<std::int32_t>(tick % 7);
  out.fault_bits = random();
  out.limit_bits = random();
  return out;
}

void write_log(const std::string& path, int rows, unsigned seed) {
  TelemetryLog log({path, false, ""});
  log.write(run());
  for (int tick = 0; tick < rows; ++tick) log.write(row(tick, seed));
  CHECK(log.rows() == static_cast<std::uint64_t>(rows));
  log.close();
}

bool same(const hoof::sample_t& read, const TelemetryRow& row) {
  bool ok = read.utime == kSimulatedEpoch_ns / 1000 + row.time_ns / 1000 && read.tick == row.tick &&
            read.time_s == static_cast<double>(row.time_ns) * 1e-9 && read.depth_m == row.depth_m &&
            read.sink_speed_m_s == row.sink_speed_m_s && read.mode == row.mode &&
            static_cast<std::uint64_t>(read.fault_bits) == row.fault_bits &&
            static_cast<std::uint64_t>(read.limit_bits) == row.limit_bits;
  for (std::size_t i = 0; i < 3; ++i) {
    ok = ok && read.foot_force_N[i] == row.foot_force_N[i] &&
         read.foot_torque_Nm[i] == row.foot_torque_Nm[i] &&
         read.desired_position_rad[i] == row.desired[i].position_rad &&
         read.desired_velocity_rad_s[i] == row.desired[i].velocity_rad_s &&
         read.desired_torque_Nm[i] == row.desired[i].torque_Nm &&
         read.measured_position_rad[i] == row.measured[i].position_rad &&
         read.measured_velocity_rad_s[i] == row.measured[i].velocity_rad_s &&
         read.measured_torque_Nm[i] == row.measured[i].torque_Nm;
  }
  return ok;
}

/// Reads a log with LCM itself. @return number of samples that agree with row(tick, seed)
int count_agreeing(const std::string& path, unsigned seed) {
  lcm::LogFile file(path, "r");
  REQUIRE(file.good());
  int samples = 0;
  std::int64_t events = 0;
  while (const lcm::LogEvent* event = file.readNextEvent()) {
    REQUIRE(event->eventnum == events++);
    if (event->channel == kRunChannel) {
      hoof::run_t read;
      REQUIRE(read.decode(event->data, 0, event->datalen) == event->datalen);
      CHECK(read.experiment == "sinkage");
      CHECK(read.foot == "bionic");
      CHECK(read.code_version == "0.1.0");
      CHECK(read.firmware_hash == "cafe");
      CHECK(read.control_period_s == 0.001);
      CHECK(event->timestamp == kSimulatedEpoch_ns / 1000);
      continue;
    }
    REQUIRE(event->channel == kSampleChannel);
    hoof::sample_t read;
    REQUIRE(read.decode(event->data, 0, event->datalen) == event->datalen);
    REQUIRE(event->timestamp == read.utime);
    REQUIRE(same(read, row(samples, seed)));
    ++samples;
  }
  return samples;
}

}  // namespace

TEST_CASE("LCM reads back every event as it was written", "[telemetry_log]") {
  const TemporaryFile file("telemetry.lcm");
  const unsigned seed = 3;
  write_log(file.path(), 2'000, seed);
  CHECK(count_agreeing(file.path(), seed) == 2'000);
}

TEST_CASE("the same rows give the same bytes", "[telemetry_log]") {
  const TemporaryFile first("first.lcm");
  const TemporaryFile second("second.lcm");
  const TemporaryFile other("other.lcm");
  write_log(first.path(), 300, 1);
  write_log(second.path(), 300, 1);
  write_log(other.path(), 300, 2);
  CHECK(first.bytes() == second.bytes());
  CHECK(first.bytes() != other.bytes());
}

TEST_CASE("a run that is killed leaves a log up to its last 10 ms", "[telemetry_log]") {
  const TemporaryFile file("killed.lcm");
  const unsigned seed = 8;
  TelemetryLog log({file.path(), false, ""});
  log.write(run());
  constexpr int kRows = 505;
  for (int tick = 0; tick < kRows; ++tick) log.write(row(tick, seed));
  const int readable = count_agreeing(file.path(), seed);  // the file is still open
  CHECK(readable <= kRows);
  CHECK(readable >= kRows - 10);
}

TEST_CASE("live listeners get the events that the log has", "[telemetry_log]") {
  // LCM's file provider stands in for the network: what would be sent is written there.
  const TemporaryFile file("log.lcm");
  const TemporaryFile sent("sent.lcm");
  const unsigned seed = 4;
  {
    TelemetryLog log({file.path(), true, "file://" + sent.path() + "?mode=w"});
    log.write(run());
    for (int tick = 0; tick < 50; ++tick) log.write(row(tick, seed));
    log.close();
    CHECK(log.live_failures() == 0);
  }
  lcm::LogFile log_events(file.path(), "r");
  lcm::LogFile sent_events(sent.path(), "r");
  int events = 0;
  while (const lcm::LogEvent* event = log_events.readNextEvent()) {
    const lcm::LogEvent* live = sent_events.readNextEvent();
    REQUIRE(live != nullptr);
    REQUIRE(live->channel == event->channel);
    REQUIRE(std::string(static_cast<const char*>(live->data),
                        static_cast<std::size_t>(live->datalen)) ==
            std::string(static_cast<const char*>(event->data),
                        static_cast<std::size_t>(event->datalen)));
    ++events;
  }
  CHECK(events == 51);
}

TEST_CASE("impossible places are errors that name them", "[telemetry_log]") {
  CHECK_THROWS_WITH(TelemetryLog({"/nowhere/telemetry.lcm", false, ""}),
                    "cannot create /nowhere/telemetry.lcm: No such file or directory");
  const TemporaryFile file("unused.lcm");
  CHECK_THROWS_WITH(TelemetryLog({file.path(), true, "nonsense://x"}),
                    Catch::Contains("nonsense://x"));
  CHECK(file.bytes().empty());
  TelemetryLog full({"/dev/full", false, ""});
  const auto fill = [&] {
    for (int tick = 0; tick < 10'000; ++tick) full.write(row(tick, 1));
  };
  CHECK_THROWS_WITH(fill(), "cannot write /dev/full: No space left on device");
}

}  // namespace hoof::bridge
