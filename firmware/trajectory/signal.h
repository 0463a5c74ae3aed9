// A motion as a sequence of phases of constant jerk.
#pragma once

#include <array>

#include "firmware/trajectory/scalar.h"

namespace hoof::firmware::trajectory {

// The acceleration at the start is stored, not summed up: held accelerations and cruises are exact,
// and it may jump between phases where the jerk is unlimited.
template <typename Real>
struct Phase {
  Real duration_s;
  Real acceleration;
  Real jerk;
};

// An extremal profile has at most seven phases; those of no length are left out.
template <typename Real>
class Signal {
 public:
  static constexpr int kMaxPhases = 7;

  void clear() { count_ = 0; }

  void append(Real duration_s, Real acceleration, Real jerk) {
    append({duration_s, acceleration, jerk});
  }

  void append(const Phase<Real>& phase) {
    if (phase.duration_s > 0) phases_[count_++] = phase;
  }

  int count() const { return count_; }
  const Phase<Real>& phase(int i) const { return phases_[i]; }

 private:
  std::array<Phase<Real>, kMaxPhases> phases_;
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
