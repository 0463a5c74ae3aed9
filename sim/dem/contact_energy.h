// Where the energy of contacts is and where it went.
#pragma once

namespace hoof::sim {

/// Sums over contacts. Stored: in the springs at the step it was taken; lost: since the counting
/// began, never negative in sum, though a single dashpot may give back within a step.
struct ContactEnergy {
  double stored_normal_J = 0;        // 8/15 E* sqrt(R*) delta^(5/2) = 2/5 F_n_elastic delta
  double stored_tangential_J = 0;    // 1/2 S_t xi_t^2
  double lost_normal_dashpot_J = 0;  // work of the damping part of F_n
  double lost_tangential_J = 0;      // tangential dashpot and sliding: work minus change in store
  double lost_rolling_J = 0;         // rolling friction

  double stored_J() const { return stored_normal_J + stored_tangential_J; }
  double lost_J() const { return lost_normal_dashpot_J + lost_tangential_J + lost_rolling_J; }

  ContactEnergy& operator+=(const ContactEnergy& e) {
    stored_normal_J += e.stored_normal_J;
    stored_tangential_J += e.stored_tangential_J;
    lost_normal_dashpot_J += e.lost_normal_dashpot_J;
    lost_tangential_J += e.lost_tangential_J;
    lost_rolling_J += e.lost_rolling_J;
    return *this;
  }
};

}  // namespace hoof::sim
