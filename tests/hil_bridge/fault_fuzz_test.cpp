// What is written as a fault either becomes one within its bounds, or is refused by file and line.

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "hil_bridge/fault_timeline.h"
#include "sim/config/config_error.h"
#include "tests/hil_bridge/fault_bench.h"

using namespace hoof;
using bridge::FaultKind;
using bridge::FaultSpec;

namespace {

class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t count) { return std::size_t(random_() % count); }
  bool one_in(std::size_t count) { return below(count) == 0; }

  /// Mostly what belongs together, and now and then anything.
  std::string faults() {
    std::string toml;
    for (std::size_t i = 0, n = one_in(3) ? 2 : 1; i < n; ++i) toml += fault();
    return toml;
  }

  /// A few bytes changed, lost or put in.
  std::string scratched(std::string toml) {
    for (std::size_t i = 0, n = 1 + below(4); i < n && !toml.empty(); ++i) {
      const std::size_t place = below(toml.size());
      switch (below(3)) {
        case 0:
          toml[place] = char(below(256));
          break;
        case 1:
          toml.erase(place, 1 + below(8));
          break;
        default:
          toml.insert(place, 1, char(32 + below(95)));
      }
    }
    return toml;
  }

 private:
  template <std::size_t kCount>
  std::string pick(const char* const (&words)[kCount]) {
    return words[below(kCount)];
  }

  std::string number() {
    static const char* const kNumbers[] = {
        "0",    "1",     "-1",   "0.5",   "1e-9", "3601", "1e300", "-0.0", "nan",
        "inf",  "-inf",  "2",    "64",    "65",   "2048", "9e18",  "0x10", "12",
        "true", "\"1\"", "0.02", "0.001", "100",  "[1]",  "{a=1}"};
    return pick(kNumbers);
  }

  std::string mostly(const std::string& good) { return one_in(3) ? number() : good; }

  std::string condition() {
    static const char* const kSignals[] = {"time_s", "depth_m", "mode", "toe_rad", "frob", ""};
    static const char* const kComparisons[] = {">", ">=", "<", "==", "!=", "=>", ""};
    static const char* const kValues[] = {"0.1", "ready", "-1e3", "nan", "x", "1 2", ""};
    return pick(kSignals) + " " + pick(kComparisons) + " " + pick(kValues);
  }

  std::string target() {
    static const char* const kTargets[] = {"toe",  "hip",  "foot",      "sync",     "supervisor",
                                           "can0", "can1", "can2",      "ToeReply", "HipReply",
                                           "Sync", "line", "Heartbeat", "frob",     ""};
    return "\"" + pick(kTargets) + "\"";
  }

  std::string fault() {
    static const char* const kKeys[] = {
        "probability", "delay_ms", "jitter_ms",  "copies",    "bits",        "id",
        "rate_Hz",     "jump_deg", "offset_deg", "noise_deg", "drift_deg_s", "left_ratio",
        "friction_Nm", "supply_V", "seed",       "until_s",   "for_s",       "frob"};
    static const char* const kCauses[] = {"\"watchdog\"", "\"frob\"", "3"};
    std::string toml = one_in(40) ? "[fault]\n" : "[[fault]]\n";
    if (!one_in(30)) {
      const auto& names = bridge::kFaultKindNames;
      toml += "kind = \"" + std::string(one_in(20) ? "frob" : names[below(names.size())]) + "\"\n";
    }
    if (!one_in(10)) toml += "target = " + (one_in(30) ? number() : target()) + "\n";
    if (!one_in(8)) toml += (one_in(2) ? "at_s = " : "at_tick = ") + mostly("2") + "\n";
    if (one_in(8)) toml += "when = \"" + condition() + "\"\n";
    if (one_in(2)) toml += "for_s = " + mostly("0.1") + "\n";
    for (std::size_t i = 0, n = below(3); i < n; ++i) {
      toml += pick(kKeys) + " = " + mostly("1") + "\n";
    }
    if (one_in(20)) toml += "cause = " + pick(kCauses) + "\n";
    return toml;
  }

  std::mt19937_64 random_;
};

bool within_bounds(const FaultSpec& f) {
  const bool time = std::isfinite(f.at_s) && f.at_s >= 0 && f.at_s <= 3600 &&
                    (!f.for_s || (*f.for_s > 0 && *f.for_s <= 3600));
  const bool amounts = f.probability > 0 && f.probability <= 1 && std::isfinite(f.amount) &&
                       f.delay_s >= 0 && f.delay_s <= 10 && f.count >= 1 && f.count <= 64 &&
                       f.id >= 0 && f.id <= 0x7FF && f.rate_Hz >= 0 && f.rate_Hz <= 20000;
  return time && amounts && !f.target.empty();
}

/// @return true where it was taken
bool read(const std::string& toml) {
  try {
    const std::vector<FaultSpec> faults = test::parse_faults(toml);
    for (const FaultSpec& f : faults) CHECK(within_bounds(f));
    bridge::FaultTimeline(faults, {true, false, false});
    return !faults.empty();
  } catch (const sim::ConfigError& error) {
    CHECK_THAT(error.what(), Catch::Contains("faults.toml"));
    CHECK_THAT(error.what(), !Catch::Contains("\n"));
    return false;
  }
}

}  // namespace

TEST_CASE("random faults are taken within their bounds or refused by name") {
  int taken = 0;
  for (std::uint64_t seed = 1; seed <= 20000; ++seed) {
    Writer writer(seed);
    const std::string toml = writer.faults();
    CAPTURE(seed, toml);
    taken += read(toml);
  }
  // Both ways are walked.
  CHECK(taken > 300);
  CHECK(taken < 15000);
}

TEST_CASE("faults whose file was scratched are taken or refused, and nothing else happens") {
  const std::string good =
      "[[fault]]\nkind = \"delay\"\ntarget = \"ToeReply\"\nat_s = 0.5\nfor_s = 0.1\ndelay_ms = 3\n"
      "[[fault]]\nkind = \"estop\"\ntarget = \"line\"\nwhen = \"mode == ready\"\nfor_s = 0.02\n"
      "[[fault]]\nkind = \"encoder_jump\"\ntarget = \"toe\"\nat_tick = 700\njump_deg = -5\n";
  REQUIRE(read(good));
  for (std::uint64_t seed = 1; seed <= 20000; ++seed) {
    Writer writer(seed);
    const std::string toml = writer.scratched(good);
    CAPTURE(seed, toml);
    read(toml);
  }
}
