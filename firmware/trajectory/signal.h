// A piecewise constant command: jerk, or acceleration where the jerk is unlimited.
#pragma once

#include <array>

#include "firmware/trajectory/scalar.h"

namespace hoof::firmware::trajectory {

// An extremal profile has at most seven phases; those of no length are left out.
template <typename Real>
class Signal {
 public:
  static constexpr int kMaxPhases = 7;

  void clear() { count_ = 0; }

  void append(Real duration_s, Real value) {
    if (!(duration_s > 0)) return;
    duration_s_[count_] = duration_s;
    value_[count_] = value;
    ++count_;
  }

  int count() const { return count_; }
  Real duration_s(int phase) const { return duration_s_[phase]; }
  Real value(int phase) const { return value_[phase]; }

 private:
  std::array<Real, kMaxPhases> duration_s_;
  std::array<Real, kMaxPhases> value_;
  int count_ = 0;
};

// The motion of one axis: the mix weight * upper + (1 - weight) * lower of two signals of equal
// duration. By convexity it keeps every limit both of them keep.
template <typename Real>
struct Mix {
  Signal<Real> upper;
  Signal<Real> lower;
  Real weight = 1;  // 1 or 0: one signal alone
};

}  // namespace hoof::firmware::trajectory
