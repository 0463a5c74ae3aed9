// The root finder on the functions it is used for, against halving in extended precision, and how
// many steps it takes: the board's time per update rests on their bound.
#include "firmware/trajectory/increment_solver.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace hoof::firmware::trajectory {
namespace {

// gain(s) = b1 s + b2 s^2 + b3 s^3 + b4 s^4, the growth of the displacement while a limit is held.
struct Quartic {
  long double b1, b2, b3, b4;

  template <typename Real>
  ValueAndSlope<Real> at(Real s) const {
    const Real c1 = Real(b1), c2 = Real(b2), c3 = Real(b3), c4 = Real(b4);
    return {s * (c1 + s * (c2 + s * (c3 + s * c4))), c1 + s * (2 * c2 + s * (3 * c3 + s * 4 * c4))};
  }
};

// The single crossing, by halving.
long double halved(const Quartic& gain, long double wanted, long double high) {
  long double low = 0;
  for (int i = 0; i < 300; ++i) {
    const long double middle = (low + high) / 2;
    (gain.at(middle).value < wanted ? low : high) = middle;
  }
  return high;
}

class RandomGains {
 public:
  explicit RandomGains(unsigned seed) : random_(seed) {}

  double log_uniform(double low, double high) {
    return std::exp(std::uniform_real_distribution<>(std::log(low), std::log(high))(random_));
  }

  // Coefficients over many orders of magnitude, some of them missing.
  Quartic next() {
    const auto coefficient = [&]() -> long double {
      return std::bernoulli_distribution(0.3)(random_) ? 0 : log_uniform(1e-8, 1e4);
    };
    return {coefficient(), coefficient(), coefficient(), coefficient()};
  }

 private:
  std::mt19937_64 random_;
};

template <typename Real>
void find_roots(double tolerance) {
  constexpr unsigned kSeed = 20240611;
  RandomGains random(kSeed);
  int most_calls = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Quartic gain = random.next();
    const double high = random.log_uniform(1e-3, 1e3);
    const Real at_high = gain.at(Real(high)).value;
    if (!(at_high > 0)) continue;
    const Real wanted = at_high * Real(random.log_uniform(1e-12, 1));
    int calls = 0;
    const Real root = solve_increment(
        [&](Real s) {
          ++calls;
          return gain.at(s);
        },
        wanted, Real(high));
    most_calls = std::max(most_calls, calls);
    const auto expected = static_cast<double>(halved(gain, wanted, high));
    INFO("seed " << kSeed << ", case " << i << ": " << double(gain.b1) << " " << double(gain.b2)
                 << " " << double(gain.b3) << " " << double(gain.b4) << ", high " << high
                 << ", wanted " << wanted);
    REQUIRE(std::fabs(root - expected) <= tolerance * expected);
  }
  INFO("most steps " << most_calls - 1);
  // The first call is the slope at zero. Two steps are kept in hand.
  CHECK(most_calls - 1 <= kMostSolverSteps<Real> - 2);
}

TEST_CASE("roots of convex gains, in few steps") {
  // Rounding of the value, divided by a slope of at least value / s.
  SECTION("float") {
    find_roots<float>(2e-6);
  }
  SECTION("double") {
    find_roots<double>(4e-15);
  }
}

TEST_CASE("a gain that first falls") {
  // Below zero up to s = 3, then up: 0.1 is reached just beyond.
  const Quartic gain{-9, 0, 1, 0};
  for (const double high : {4.0, 40.0, 1e4}) {
    const double root = solve_increment([&](double s) { return gain.at(s); }, 0.1, high);
    CHECK(gain.at(root).value == Approx(0.1).epsilon(1e-12));
  }
}

TEST_CASE("a root at the very end of the bracket") {
  const auto line = [](double s) { return ValueAndSlope<double>{s, 1}; };
  CHECK(solve_increment(line, 0.7, 0.7) == 0.7);
  // Rounding may put it past the end by a hair.
  CHECK(solve_increment(line, std::nextafter(0.7, 1.0), 0.7) == Approx(0.7).epsilon(1e-15));
}

}  // namespace
}  // namespace hoof::firmware::trajectory
