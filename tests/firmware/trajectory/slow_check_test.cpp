// The judge is tested first: durations known in closed form, a hair shorter, a hair longer.
#include "tools/trajectory/slow_check.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace hoof::tools::trajectory {
namespace {

AxisProblem rest_to_rest(double distance, double v, double a, double j) {
  return {distance, 0, 0, 0, 0, {v, -v, a, -a, j}};
}

bool feasible(const AxisProblem& axis, double duration_s, double slack) {
  return slowly_feasible(axis, duration_s, relative_slack(axis, duration_s, slack));
}

TEST_CASE("the slow check knows the textbook durations") {
  for (const double sign : {1.0, -1.0}) {
    const struct {
      AxisProblem axis;
      double duration_s;
    } cases[] = {{rest_to_rest(sign * 0.01, 5, 5, 10), 4 * std::cbrt(0.01 / 20)},
                 {rest_to_rest(sign * 7, 1.5, 2, 20), 7 / 1.5 + 1.5 / 2 + 0.1}};
    for (const auto& [axis, duration_s] : cases) {
      CHECK(feasible(axis, duration_s * (1 + 1e-6), -1e-12));
      CHECK(feasible(axis, duration_s * 3, -1e-12));
      CHECK_FALSE(feasible(axis, duration_s * (1 - 1e-6), -1e-12));
      CHECK_FALSE(feasible(axis, duration_s / 2, -1e-12));
    }
  }
}

TEST_CASE("the slow check sees a blocked interval") {
  // Both accelerations upwards and nothing to do: 0, or at least the time to turn round and back.
  AxisProblem axis = rest_to_rest(0, 2, 1, 1);
  axis.acceleration = axis.target_acceleration = 0.5;
  CHECK(feasible(axis, 0, 1e-12));
  CHECK_FALSE(feasible(axis, 0.5, -1e-12));
  CHECK(feasible(axis, 20, -1e-12));
}

}  // namespace
}  // namespace hoof::tools::trajectory
