#include "firmware/app/parameters.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>

using namespace hoof::firmware::app;

TEST_CASE("Every default lies in its range, every name is used once and ends in its unit") {
  std::set<std::string_view> names;
  for (const ParameterEntry& entry : parameter_table()) {
    INFO(entry.name);
    CHECK(names.insert(entry.name).second);
    CHECK(entry.default_value() >= entry.minimum);
    CHECK(entry.default_value() <= entry.maximum);
    CHECK_FALSE(entry.description.empty());
    if (entry.unit == "bool") continue;
    std::string suffix = "_";
    for (const char c : entry.unit) suffix += c == '/' || c == ' ' ? '_' : c;
    CHECK(std::string(entry.name).ends_with(suffix));
  }
}

TEST_CASE("Every parameter sets a number of its own, at both bounds") {
  Parameters parameters;
  float mark = 0.0f;
  for (const ParameterEntry& entry : parameter_table()) {
    INFO(entry.name);
    REQUIRE(set(parameters, entry.name, entry.maximum) == SetResult::kOk);
    REQUIRE(set(parameters, entry.name, entry.minimum) == SetResult::kOk);
    // A value nobody else has.
    mark += 1e-3f;
    entry.value(parameters) = mark;
  }
  mark = 0.0f;
  for (const ParameterEntry& entry : parameter_table()) {
    INFO(entry.name);
    mark += 1e-3f;
    CHECK(entry.value(parameters) == mark);
  }
}

TEST_CASE("Values beyond the bounds, not-a-number and unknown names change nothing") {
  Parameters parameters;
  CHECK(set(parameters, "toe_kp_Nm_rad", -0.1f) == SetResult::kOutOfRange);
  CHECK(set(parameters, "toe_kp_Nm_rad", 500.1f) == SetResult::kOutOfRange);
  CHECK(set(parameters, "toe_kp_Nm_rad", std::nanf("")) == SetResult::kOutOfRange);
  CHECK(set(parameters, "toe_kp", 1.0f) == SetResult::kUnknownName);
  CHECK(parameters.control.toe.kp_Nm_rad == 250.0f);
  CHECK(find_parameter("nonsense") == nullptr);
}

TEST_CASE("The leg may be absent") {
  Parameters parameters;
  CHECK(parameters.presence().leg);
  REQUIRE(set(parameters, "leg_present", 0.0f) == SetResult::kOk);
  CHECK_FALSE(parameters.presence().leg);
  CHECK(parameters.presence().toe);
}
