#include "sim/dem/contact_material.h"

#include <cmath>
#include <numbers>

namespace hoof::sim {
namespace {

double shear_modulus_Pa(const ElasticMaterial& m) {
  return m.young_modulus_Pa / (2 * (1 + m.poisson_ratio));
}

}  // namespace

PairLaw<double> make_pair_law(const ElasticMaterial& a, const ElasticMaterial& b,
                              const PairCoefficients& pair) {
  const auto plane_compliance = [](const ElasticMaterial& m) {
    return (1 - m.poisson_ratio * m.poisson_ratio) / m.young_modulus_Pa;
  };
  const auto shear_compliance = [](const ElasticMaterial& m) {
    return (2 - m.poisson_ratio) / shear_modulus_Pa(m);
  };
  const double ln_e = std::log(pair.restitution);
  const double beta = ln_e / std::sqrt(ln_e * ln_e + std::numbers::pi * std::numbers::pi);
  const double E_eff_Pa = 1 / (plane_compliance(a) + plane_compliance(b));
  const double G_eff_Pa = 1 / (shear_compliance(a) + shear_compliance(b));
  const double damping = -2 * std::sqrt(5.0 / 6.0) * beta;
  return {E_eff_Pa,
          G_eff_Pa,
          damping * std::sqrt(2 * E_eff_Pa),
          damping * std::sqrt(8 * G_eff_Pa),
          pair.static_friction,
          pair.rolling_friction};
}

double rayleigh_time_s(const ElasticMaterial& m, double radius_m) {
  return std::numbers::pi * radius_m * std::sqrt(m.density_kg_m3 / shear_modulus_Pa(m)) /
         (0.1631 * m.poisson_ratio + 0.8766);
}

}  // namespace hoof::sim
