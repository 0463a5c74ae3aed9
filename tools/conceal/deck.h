#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/conceal/case_request.h"
#include "tools/conceal/random_stream.h"

namespace hoof::tools::conceal {

/// A case's rig and what it is to hide.
struct DealtCase {
  std::string rig;  ///< "servo_pendulum" or "plate_sand"
  CaseRequest request;
};

/// Deals `count` cases by the contract's shares, each share met to the nearest whole case; effects
/// go round in shuffled order, so that a batch of some size has each. `rig` is one of the rigs, or
/// "all": four fifths servo_pendulum.
std::vector<DealtCase> deal(int count, const std::string& rig, RandomStream random);

/// How many of `count` fall to each of `shares`, which add up to one: largest remainders.
std::vector<int> apportion(int count, const std::vector<double>& shares);

}  // namespace hoof::tools::conceal
