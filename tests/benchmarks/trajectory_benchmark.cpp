// Time of one plan: position, jerk-limited, time-synchronised, over random moving starts and
// targets (a fifth of them at rest), so that no branch predictor learns one case by heart.
//
// Each of 4,096 cases is planned 40 times, in turn, each plan timed by itself (less what reading
// the clock takes); a case's time is the median of its 40. Printed: median and 99th percentile over
// the cases, beside the bar (issue 4: medians of 0.59, 2.91 and 7.72 us for 1, 3 and 7 joints in
// double; 1.03, 4.65 and 10.8 us are what the other generator's 99th percentiles were). The mean
// that google-benchmark prints of itself counts interruptions too.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <random>
#include <vector>

#include "firmware/trajectory/generator.h"

namespace {

using hoof::firmware::trajectory::Generator;
using hoof::firmware::trajectory::Input;

constexpr int kInputs = 4096;
constexpr int kPasses = 40;
constexpr unsigned kSeed = 20240601;

template <typename Real, int kJoints>
std::vector<Input<Real, kJoints>> random_inputs() {
  std::mt19937_64 random(kSeed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Input<Real, kJoints>> inputs(kInputs);
  for (auto& input : inputs) {
    for (int i = 0; i < kJoints; ++i) {
      const double v = uniform(0.5, 10);
      const double a = uniform(0.5, 10);
      const double j = uniform(1, 20);
      input.set_limits(i, Real(v), Real(a), Real(j));
      input.position[i] = Real(uniform(-3, 3));
      input.target_position[i] = Real(uniform(-3, 3));
      if (uniform(0, 1) < 0.2) continue;
      // Half the limits keep every state admissible: v/2 + (a/2)^2 / (2 j) may not exceed v.
      const double swing = a * a / 8 / j;
      const double scale = swing > v / 2 ? v / 2 / swing : 1;
      input.velocity[i] = Real(uniform(-v, v) / 2);
      input.acceleration[i] = Real(uniform(-a, a) / 2 * scale);
      input.target_velocity[i] = Real(uniform(-v, v) / 2);
      input.target_acceleration[i] = Real(uniform(-a, a) / 2 * scale);
    }
  }
  return inputs;
}

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

double clock_reading_s() {
  double least = 1;
  for (int i = 0; i < 10'000; ++i) {
    const Clock::time_point begin = Clock::now();
    least = std::min(least, seconds(Clock::now() - begin));
  }
  return least;
}

// The value that the share `rank` of all is not above.
double percentile(std::vector<double> values, double rank) {
  const auto at = static_cast<std::ptrdiff_t>(rank * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

template <typename Real, int kJoints>
void plan(benchmark::State& state, double bar_us) {
  const auto inputs = random_inputs<Real, kJoints>();
  const auto generator = std::make_unique<Generator<Real, kJoints>>(Real(0.001));
  const double reading_s = clock_reading_s();
  std::vector<std::vector<double>> times_us(inputs.size());
  std::size_t next = 0;
  for (auto _ : state) {
    const Clock::time_point begin = Clock::now();
    benchmark::DoNotOptimize(generator->plan(inputs[next]));
    const double time_s = std::max(0.0, seconds(Clock::now() - begin) - reading_s);
    state.SetIterationTime(time_s);
    times_us[next].push_back(time_s * 1e6);
    next = (next + 1) % inputs.size();
  }
  std::vector<double> cases_us;
  for (auto& of_case : times_us) cases_us.push_back(percentile(std::move(of_case), 0.5));
  state.counters["median_us"] = percentile(cases_us, 0.5);
  state.counters["p99_us"] = percentile(cases_us, 0.99);
  if (bar_us > 0) state.counters["bar_us"] = bar_us;
}

template <typename Real, int kJoints>
void add(const char* name, double bar_us) {
  benchmark::RegisterBenchmark(name, plan<Real, kJoints>, bar_us)
      ->UseManualTime()
      ->Iterations(kInputs * kPasses)
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace

int main(int argc, char** argv) {
  add<double, 1>("plan/double/joints:1", 0.59);
  add<double, 3>("plan/double/joints:3", 2.91);
  add<double, 7>("plan/double/joints:7", 7.72);
  add<float, 1>("plan/float/joints:1", 0);
  add<float, 3>("plan/float/joints:3", 0);
  add<float, 7>("plan/float/joints:7", 0);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
