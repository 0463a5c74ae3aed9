// Material constants and what follows from a pair of them. Symbols as in contact_law.h.
#pragma once

#include "sim/dem/contact_law.h"

namespace hoof::sim {

struct ElasticMaterial {
  double young_modulus_Pa = 0;
  double poisson_ratio = 0;
  double density_kg_m3 = 0;
};

/// How two materials meet.
struct PairCoefficients {
  double restitution = 1;       // e, 0 < e <= 1
  double static_friction = 0;   // mu_s
  double rolling_friction = 0;  // mu_r
};

/// The constants of contact_law.h for materials a and b, computed in double.
PairLaw<double> make_pair_law(const ElasticMaterial& a, const ElasticMaterial& b,
                              const PairCoefficients& pair);

template <typename Real>
PairLaw<Real> cast_pair_law(const PairLaw<double>& law) {
  return {Real(law.E_eff_Pa),  Real(law.G_eff_Pa), Real(law.dashpot_n),
          Real(law.dashpot_t), Real(law.mu_s),     Real(law.mu_r)};
}

/// Rayleigh time of a grain, s: the usual bound of a DEM step, pi R sqrt(rho/G) / (0.1631 nu +
/// 0.8766) (Thornton and Randall 1988; the paper's 4.17e-6 s is 20 % of it at R = 1 mm).
double rayleigh_time_s(const ElasticMaterial& material, double radius_m);

}  // namespace hoof::sim
