#include "tools/design_of_experiments/design.h"

#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

namespace hoof::tools {
namespace {

void add_centres(Design& design, int factors, int centres) {
  for (int i = 0; i < centres; ++i) design.emplace_back(factors, 0.0);
}

void check(int factors, int low, int high, int centres) {
  if (factors < low || factors > high || centres < 0) {
    throw std::invalid_argument("number of factors or of centre runs");
  }
}

}  // namespace

Design box_behnken(int factors, int centres) {
  check(factors, 3, 5, centres);
  Design design;
  for (int a = 0; a < factors; ++a) {
    for (int b = a + 1; b < factors; ++b) {
      for (const double first : {-1.0, 1.0}) {
        for (const double second : {-1.0, 1.0}) {
          design.emplace_back(factors, 0.0);
          design.back()[a] = first;
          design.back()[b] = second;
        }
      }
    }
  }
  add_centres(design, factors, centres);
  return design;
}

Design central_composite(int factors, int centres, double axis) {
  check(factors, 2, 6, centres);
  Design design;
  for (int corner = 0; corner < (1 << factors); ++corner) {
    design.emplace_back(factors, 0.0);
    for (int f = 0; f < factors; ++f) design.back()[f] = (corner >> f) & 1 ? 1.0 : -1.0;
  }
  for (int f = 0; f < factors; ++f) {
    for (const double side : {-axis, axis}) {
      design.emplace_back(factors, 0.0);
      design.back()[f] = side;
    }
  }
  add_centres(design, factors, centres);
  return design;
}

double rotatable_axis(int factors) {
  return std::pow(2.0, 0.25 * factors);
}

std::vector<int> run_order(int runs, unsigned long long seed) {
  std::vector<int> order(runs);
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(seed);
  // Not std::shuffle, whose draws are the library's own.
  for (int i = runs - 1; i > 0; --i) {
    std::swap(order[i], order[static_cast<int>(random() % static_cast<unsigned long long>(i + 1))]);
  }
  return order;
}

}  // namespace hoof::tools
