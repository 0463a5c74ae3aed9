// Faults of recordings planted one by one: each is found, and nothing else is cried out.
#include "tools/diagnose/quality.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>

#include "tests/tools/diagnose/bench.h"
#include "tools/diagnose/series.h"

using namespace hoof::tools;
using namespace hoof::tests;

namespace {

std::string listed(const std::vector<QualityNote>& notes) {
  std::string text;
  for (const QualityNote& n : notes) {
    text += (n.serious ? "! " : "  ") + n.recording + " [" + n.channel + "] " + n.text + "\n";
  }
  return text;
}

struct Planted {
  const char* what;
  std::function<void(DataSet&)> plant;
  const char* channel;
  const char* said;
  bool serious;
};

/// The fault is said, of its channel, and no other serious thing is.
void check_planted(const DataSet& clean, const std::vector<Planted>& cases) {
  for (const Planted& c : cases) {
    DataSet set = clean;
    c.plant(set);
    const auto notes = check_quality(set);
    INFO(c.what << "\n" << listed(notes));
    bool found = false;
    for (const QualityNote& n : notes) {
      const bool it = n.channel == c.channel && n.text.find(c.said) != std::string::npos;
      if (it) CHECK(n.serious == c.serious);
      if (!it) CHECK_FALSE(n.serious);
      found = found || it;
    }
    CHECK(found);
  }
}

Series& channel(DataSet& set, const std::string& name) {
  return set.recordings[0].channels.at(name);
}

void scale(DataSet& set, const std::string& name, double factor) {
  for (double& value : channel(set, name)) value *= factor;
}

void cut(DataSet& set, std::size_t first, std::size_t last) {
  const auto erase = [&](Series& x) {
    x.erase(x.begin() + std::ptrdiff_t(first), x.begin() + std::ptrdiff_t(last));
  };
  erase(set.recordings[0].time_s);
  for (auto& [name, x] : set.recordings[0].channels) erase(x);
}

void keep(DataSet& set, std::size_t count) {
  cut(set, count, set.recordings[0].time_s.size());
}

constexpr double kDegrees = 180 / std::numbers::pi;

}  // namespace

TEST_CASE("Clean recordings of a servo raise nothing") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    PendulumBench bench;
    bench.seed = seed;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    bench.kp = std::exp(std::log(1.0) + uniform(random) * std::log(60.0));
    bench.kd = 0.02 * bench.kp + 0.05 * uniform(random);
    bench.speed_factor = 0.3 + 1.5 * uniform(random);
    bench.position_noise = std::exp(std::log(1e-5) + uniform(random) * std::log(300.0));
    bench.velocity_noise = 10 * bench.position_noise;
    bench.torque_noise = 0.2 * uniform(random);
    bench.step_s = seed % 3 == 0 ? 0.002 : seed % 3 == 1 ? 0.005 : 0.01;
    bench.encoder_step_rad = seed % 2 == 0 ? 2 * std::numbers::pi / 4096 : 0;
    const DataSet set = pendulum_bench(bench);
    const auto notes = check_quality(set);
    INFO("seed " << seed << " kp " << bench.kp << " kd " << bench.kd << "\n" << listed(notes));
    CHECK(notes.empty());
  }
}

TEST_CASE("Clean presses raise nothing") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DataSet set = sand_bench(seed);
    INFO("seed " << seed << "\n" << listed(check_quality(set)));
    CHECK(check_quality(set).empty());
    set.rig = RigKind::kRigidPress;
    CHECK(check_quality(set).empty());
  }
}

TEST_CASE("Faults of time are found") {
  const DataSet clean = pendulum_bench({});
  check_planted(clean, {{"a short gap", [](DataSet& s) { cut(s, 300, 320); }, "time",
                         "1 gap(s) of together 0.105 s", false},
                        {"a long gap", [](DataSet& s) { cut(s, 300, 500); }, "time",
                         "gap(s) of together 1 s", true},
                        {"two gaps",
                         [](DataSet& s) {
                           cut(s, 900, 920);
                           cut(s, 300, 320);
                         },
                         "time", "2 gap(s)", false},
                        {"the clock is set while the link moves",
                         [](DataSet& s) {
                           for (std::size_t i = 700; i < s.recordings[0].time_s.size(); ++i) {
                             s.recordings[0].time_s[i] += 2;
                           }
                         },
                         "time", "the clock jumps by 2 s at 3.5 s", true},
                        {"half the rate from the middle on",
                         [](DataSet& s) {
                           for (std::size_t i = 800; i < s.recordings[0].time_s.size(); ++i)
                             cut(s, i, i + 1);
                         },
                         "time", "the rate changes from 200 Hz to 100 Hz", false},
                        {"milliseconds",
                         [](DataSet& s) {
                           for (double& t : s.recordings[0].time_s) t *= 1000;
                           s.recordings[0].channels.erase("velocity");
                         },
                         "time", "milliseconds or microseconds", true},
                        {"times of arrival",
                         [](DataSet& s) {
                           auto& t = s.recordings[0].time_s;
                           for (std::size_t i = 0; i + 4 < t.size(); i += 4) {
                             for (std::size_t j = 1; j < 4; ++j) t[i + j] = t[i] + 1e-4 * double(j);
                           }
                         },
                         "time", "steps of time are uneven", false}});
}

TEST_CASE("Faults of single channels are found") {
  PendulumBench bench;
  bench.torque_noise = 0.001;
  const DataSet clean = pendulum_bench(bench);
  check_planted(clean, {{"a few missing samples",
                         [](DataSet& s) {
                           for (std::size_t i = 10; i < 60; ++i) channel(s, "torque")[i * 20] = NAN;
                         },
                         "torque", "% of the samples are missing", false},
                        {"many missing samples",
                         [](DataSet& s) {
                           for (std::size_t i = 1; i < 800; ++i) channel(s, "torque")[2 * i] = NAN;
                         },
                         "torque", "% of the samples are missing", true},
                        {"nothing but missing samples",
                         [](DataSet& s) {
                           for (double& x : channel(s, "torque")) x = NAN;
                         },
                         "torque", "no sample at all", true},
                        {"no start", [](DataSet& s) { channel(s, "position")[0] = NAN; },
                         "position", "the first sample is missing", true},
                        {"dead position",
                         [](DataSet& s) {
                           for (double& x : channel(s, "position")) x = 0.1;
                         },
                         "position", "never changes from 0.1 rad", true},
                        {"dead torque", [](DataSet& s) { scale(s, "torque", 0); }, "torque",
                         "never changes from 0", true},
                        {"dead velocity", [](DataSet& s) { scale(s, "velocity", 0); }, "velocity",
                         "never changes from 0", true},
                        {"torque freezes",
                         [](DataSet& s) {
                           for (std::size_t i = 200; i < 400; ++i)
                             channel(s, "torque")[i] = channel(s, "torque")[200];
                         },
                         "torque", "is frozen at", true},
                        {"velocity at the end of its range",
                         [](DataSet& s) {
                           for (double& x : channel(s, "velocity")) x = std::min(x, 1.5);
                         },
                         "velocity", "stays at exactly 1.5 rad/s", true},
                        {"velocity at the other end",
                         [](DataSet& s) {
                           for (double& x : channel(s, "velocity")) x = std::max(x, -1.5);
                         },
                         "velocity", "stays at exactly -1.5 rad/s", true},
                        {"torque at a limit",
                         [](DataSet& s) {
                           for (double& x : channel(s, "torque")) x = std::min(x, 1.0);
                         },
                         "torque", "stays at exactly 1 Nm", false},
                        {"coarse velocity",
                         [](DataSet& s) {
                           for (double& x : channel(s, "velocity")) x = 0.5 * std::round(x / 0.5);
                         },
                         "velocity", "comes in coarse steps of 0.5 rad/s", false},
                        {"noise stated too small", [](DataSet& s) { s.noise["position"] = 0.0002; },
                         "position", "noise is stated as 0.0002 rad", false},
                        {"noise stated too large", [](DataSet& s) { s.noise["position"] = 0.005; },
                         "position", "noise is stated as 0.005 rad", false},
                        {"half enabled",
                         [](DataSet& s) { s.recordings[0].channels["enable"] = Series(1600, 0.5); },
                         "enable", "it must be 0 or 1", true}});
}

TEST_CASE("Units and signs are suspected and said") {
  const DataSet clean = pendulum_bench({});
  const auto without_velocity = [](DataSet& s) { s.recordings[0].channels.erase("velocity"); };
  check_planted(
      clean,
      {{"velocity in degrees", [](DataSet& s) { scale(s, "velocity", kDegrees); }, "velocity",
        "suspected: velocity is in degrees per second", true},
       {"velocity in rpm", [](DataSet& s) { scale(s, "velocity", 30 / std::numbers::pi); },
        "velocity", "suspected: velocity is in turns per minute", true},
       {"velocity is half", [](DataSet& s) { scale(s, "velocity", 0.5); }, "velocity",
        "times the derivative of position", true},
       {"velocity upside down", [](DataSet& s) { scale(s, "velocity", -1); }, "velocity",
        "opposite sign", true},
       {"velocity late",
        [](DataSet& s) {
          Series& v = channel(s, "velocity");
          std::rotate(v.begin(), v.end() - 5, v.end());
        },
        "velocity", "lags the derivative of position by 2", false},
       {"goal in degrees",
        [&](DataSet& s) {
          without_velocity(s);
          s.recordings[0].channels.erase("torque");
          scale(s, "position_goal", kDegrees);
        },
        "position_goal", "suspected: degrees", true},
       {"position upside down",
        [&](DataSet& s) {
          without_velocity(s);
          s.recordings[0].channels.erase("torque");
          scale(s, "position", -1);
        },
        "position", "goes against its goal", true},
       {"goal copied", [](DataSet& s) { channel(s, "position") = channel(s, "position_goal"); },
        "position", "one column for both?", true},
       {"torque upside down", [](DataSet& s) { scale(s, "torque", -1); }, "torque",
        "opposite sign of what the drive's law", true},
       {"torque in mNm", [](DataSet& s) { scale(s, "torque", 1000); }, "torque",
        "suspected: thousandths (mNm)", true},
       {"supply in mV",
        [](DataSet& s) {
          s.recordings[0].setup.values["supply_voltage"] = {7.4, 0};
          s.recordings[0].channels["supply_voltage"] = Series(1600, 7300);
        },
        "supply_voltage", "suspected: mV", true}});
  DataSet degrees = clean;
  without_velocity(degrees);
  degrees.recordings[0].channels.erase("torque");
  for (const char* name : {"position", "position_goal"}) scale(degrees, name, kDegrees);
  const auto notes = check_quality(degrees);
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes[0].text, Catch::Contains("more than two turns: suspected: degrees"));
}

TEST_CASE("Faults of presses are found") {
  check_planted(sand_bench(1), {{"position in mm", [](DataSet& s) { scale(s, "position", 1000); },
                                 "position", "suspected: mm where m is meant", true},
                                {"force in mN", [](DataSet& s) { scale(s, "force", 1000); },
                                 "force", "suspected: mN", true},
                                {"force in kN", [](DataSet& s) { scale(s, "force", 0.001); },
                                 "force", "suspected: kN", true},
                                {"pull for push", [](DataSet& s) { scale(s, "force", -1); },
                                 "force", "must be positive in compression", true},
                                {"never in the sand",
                                 [](DataSet& s) {
                                   s.recordings[0].setup.values["surface_height"] = {-0.05, 0};
                                 },
                                 "position", "hardly gets below surface_height", true},
                                {"load cell at its end",
                                 [](DataSet& s) {
                                   for (double& x : channel(s, "force")) x = std::min(x, 60.0);
                                 },
                                 "force", "stays at exactly 60 N", true},
                                {"dead load cell",
                                 [](DataSet& s) {
                                   for (double& x : channel(s, "force")) x = 0.5;
                                 },
                                 "force", "never changes from 0.5 N", true}});
}

TEST_CASE("What is too little to learn from is said") {
  const DataSet clean = pendulum_bench({});
  check_planted(clean,
                {{"too short", [](DataSet& s) { keep(s, 100); }, "", "is only 0.495 s long", true},
                 {"too few samples",
                  [](DataSet& s) {
                    for (std::size_t i = 1; i < s.recordings[0].time_s.size(); ++i) {
                      cut(s, i, std::min(i + 39, s.recordings[0].time_s.size()));
                    }
                    s.recordings[0].channels.erase("velocity");
                  },
                  "", "has only 40 samples", true}});
  // Nothing moves: the same place and goal for all time.
  DataSet still = clean;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (double& x : channel(still, "position_goal")) x = 0.2;
  for (double& x : channel(still, "position")) x = 0.2 + 0.001 * normal(random);
  for (double& x : channel(still, "velocity")) x = 0.02 * normal(random);
  for (double& x : channel(still, "torque")) x = 0.1 + 0.02 * normal(random);
  const auto notes = check_quality(still);
  INFO(listed(notes));
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].serious);
  CHECK_THAT(notes[0].text, Catch::StartsWith("nothing moves"));
}

TEST_CASE("The same samples twice are found, and a leak into what is held out is serious") {
  DataSet set = pendulum_bench({});
  set.recordings.push_back(set.recordings[0]);
  set.recordings[1].name = set.recordings[1].path = "copy.csv";
  auto notes = check_quality(set);
  REQUIRE(notes.size() == 1);
  CHECK_FALSE(notes[0].serious);
  CHECK_THAT(notes[0].text, Catch::Contains("copy.csv: they count twice"));
  set.recordings[1].holdout = true;
  notes = check_quality(set);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].serious);
  // Windows of one file: apart they are two recordings, overlapping they are not.
  DataSet windows = pendulum_bench({});
  windows.recordings.push_back(windows.recordings[0]);
  windows.recordings[1].holdout = true;
  cut(windows, 800, 1600);
  std::swap(windows.recordings[0], windows.recordings[1]);
  CHECK(check_quality(windows).size() == 1);
  cut(windows, 0, 800);
  CHECK(check_quality(windows).empty());
}

TEST_CASE("What many recordings have alike is said once") {
  DataSet set;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    PendulumBench bench;
    bench.seed = seed;
    DataSet one = pendulum_bench(bench);
    scale(one, "velocity", -1);
    one.recordings[0].name = one.recordings[0].path = "run" + std::to_string(seed) + ".csv";
    if (seed == 1) set = one;
    if (seed > 1) set.recordings.push_back(one.recordings[0]);
  }
  const auto notes = check_quality(set);
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes[0].text, Catch::Contains("(worst of 4 recordings where it is so)"));
}

TEST_CASE("Of the real recordings only what is so is said") {
  const std::filesystem::path data = std::filesystem::path(HOOF_TEST_DATA_DIR) / "diagnose";
  CHECK(check_quality(read_data_set(data / "sand_plates/dataset.toml")).empty());
  const auto notes = check_quality(read_data_set(data / "servo_pendulum_xl330/dataset.toml"));
  INFO(listed(notes));
  // The servo's own velocity is filtered; its logger is faster once the torque is off, at 2 s; and
  // velocity comes in steps of 0.024 rad/s, which is coarse where the arm is slow.
  REQUIRE(notes.size() == 3);
  for (const QualityNote& n : notes) CHECK_FALSE(n.serious);
  CHECK_THAT(notes[0].text, Catch::Contains("lags the derivative of position by 20.9 ms") &&
                                Catch::Contains("worst of 16 recordings"));
  CHECK_THAT(notes[1].text, Catch::Contains("changes from 184 Hz to 286 Hz at about 2 s"));
  CHECK_THAT(notes[2].text, Catch::Contains("coarse steps of 0.024 rad/s"));
}

TEST_CASE("Series: slopes and relations of known signals") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Series time_s, x, y;
  for (int i = 0; i < 4000; ++i) {
    time_s.push_back(0.005 * i);
    x.push_back(std::sin(3 * time_s.back()) + 0.01 * normal(random));
    y.push_back(-2 * std::sin(3 * time_s.back()));
  }
  CHECK(deviation(y) == Approx(2 / std::sqrt(2.0)).epsilon(0.01));
  const Series slope = derivative(time_s, y, 0.02);
  CHECK(slope[1000] == Approx(-6 * std::cos(3 * time_s[1000])).epsilon(0.01));
  const Relation relation = relate(y, x);
  CHECK(relation.r == Approx(-1).margin(0.001));
  CHECK(relation.ratio == Approx(-2).epsilon(0.01));
  x[7] = x[8] = NAN;
  CHECK(relate(y, x).count == 3998);
  CHECK(relate(Series(10, 1.0), Series(10, 2.0)).r == 0);
  CHECK(std::isnan(median({NAN, NAN})));
  CHECK(median({3, NAN, 1, 2}) == 2);
}
