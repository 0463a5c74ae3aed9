// Time of one plan: position, jerk-limited, time-synchronised, over random moving starts and
// targets (a fifth of them at rest), so that no branch predictor learns one case by heart. Bars
// (issue 4): medians of 0.59, 2.91 and 7.72 us for 1, 3 and 7 joints in double.
#include <benchmark/benchmark.h>

#include <memory>
#include <random>
#include <vector>

#include "firmware/trajectory/generator.h"

namespace {

using hoof::firmware::trajectory::Generator;
using hoof::firmware::trajectory::Input;

constexpr int kInputs = 4096;
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

template <typename Real, int kJoints>
void plan(benchmark::State& state) {
  const auto inputs = random_inputs<Real, kJoints>();
  const auto generator = std::make_unique<Generator<Real, kJoints>>(Real(0.001));
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(generator->plan(inputs[next]));
    next = (next + 1) % inputs.size();
  }
}

BENCHMARK(plan<double, 1>)->Unit(benchmark::kMicrosecond);
BENCHMARK(plan<double, 3>)->Unit(benchmark::kMicrosecond);
BENCHMARK(plan<double, 7>)->Unit(benchmark::kMicrosecond);
BENCHMARK(plan<float, 1>)->Unit(benchmark::kMicrosecond);
BENCHMARK(plan<float, 3>)->Unit(benchmark::kMicrosecond);
BENCHMARK(plan<float, 7>)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
