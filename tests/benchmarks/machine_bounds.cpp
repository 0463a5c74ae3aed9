#include "tests/benchmarks/machine_bounds.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

namespace hoof::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

/// Seconds that job(member) takes on all members together, the best of a few tries.
template <typename Job>
double best_time_s(int threads, const Job& job) {
  double best_s = 1e9;
  for (int attempt = 0; attempt < 5; ++attempt) {
    const auto start = Clock::now();
    std::vector<std::thread> team;
    for (int m = 1; m < threads; ++m) team.emplace_back([&, m] { job(m); });
    job(0);
    for (std::thread& t : team) t.join();
    best_s = std::min(best_s, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return best_s;
}

typedef float Vector __attribute__((vector_size(64)));

/// Eight independent chains of one multiplication and one addition; compiled for each instruction
/// set, the machine's best is taken when the program starts.
__attribute__((target_clones("default", "avx2", "avx512f"))) float chains(long rounds) {
  Vector x[8];
  for (int i = 0; i < 8; ++i) x[i] = Vector{} + float(i);
  for (long r = 0; r < rounds; ++r) {
#pragma GCC unroll 8
    for (int i = 0; i < 8; ++i) x[i] = x[i] * 0.999f + 0.001f;
  }
  Vector sum{};
  for (const Vector& v : x) sum += v;
  return sum[0] + sum[15];
}

}  // namespace

double copy_bandwidth_B_s(int threads) {
  const std::size_t bytes = std::size_t(256) << 20;
  std::vector<std::unique_ptr<char[]>> from, to;
  for (int m = 0; m < threads; ++m) {
    from.push_back(std::make_unique<char[]>(bytes));
    to.push_back(std::make_unique<char[]>(bytes));
    std::memset(from.back().get(), m + 1, bytes);
  }
  const double s = best_time_s(threads, [&](int m) {
    std::memcpy(to[std::size_t(m)].get(), from[std::size_t(m)].get(), bytes);
  });
  return 2.0 * double(bytes) * threads / s;
}

double float_rate_flop_s(int threads) {
  constexpr long kRounds = 3'000'000;
  std::vector<float> keep(std::size_t(threads) * 16);  // a cache line each
  const double s = best_time_s(
      threads, [&](int m) { keep[std::size_t(m) * 16] = chains(kRounds + long(keep[0])); });
  return double(kRounds) * 8 * 16 * 2 * threads / s;
}

}  // namespace hoof::benchmarks
