#include "sim/terrain/rft_law.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/config/units.h"

namespace hoof::sim::rft {
namespace {

using Coefficients = std::array<double, 20>;

// [A] supplement S3, as two public implementations have them (a MATLAB one of a cone penetration
// study and one for reinforcement learning that cites S3). They agree in 58 of the 60. Where they
// differ the second is taken: c2 of x3 x2^2 is 0.18589 in the first, which changes nothing; c3 of
// x2 x3^2 is -0.02730 there, with which a flat plate would meet less resistance straight down than
// one tilted by 30 degrees, against all measurements; and our own pushes of plates are met a little
// worse (52.9 % off in place of 50.0 %).
constexpr Coefficients kC1 = {0.00212,  -0.02320, -0.20890, -0.43083, -0.00259, 0.48872, -0.00415,
                              0.07204,  -0.02750, -0.08772, 0.01992,  -0.45961, 0.40799, -0.10107,
                              -0.06576, 0.05664,  -0.09269, 0.01892,  0.01033,  0.15120};
constexpr Coefficients kC2 = {-0.06796, -0.10941, 0.04725, -0.06914, -0.05835, -0.65880, -0.11985,
                              -0.25739, -0.26834, 0.02692, -0.00736, 0.63758,  0.08997,  0.21069,
                              0.04748,  0.20406,  0.18519, 0.04934,  0.13527,  -0.33207};
constexpr Coefficients kC3 = {-0.02634, -0.03436, 0.45256, 0.00835,  0.02553, -1.31290, -0.05532,
                              0.06790,  -0.16404, 0.02287, 0.02927,  0.95406, -0.00131, -0.11028,
                              0.01487,  -0.20770, 0.10911, -0.04097, 0.07881, -0.27519};

/// The terms of a polynomial of third order in the order of the coefficients. [A] S3
Coefficients terms(double x1, double x2, double x3) {
  return {1,
          x1,
          x2,
          x3,
          x1 * x1,
          x2 * x2,
          x3 * x3,
          x1 * x2,
          x2 * x3,
          x3 * x1,
          x1 * x1 * x1,
          x2 * x2 * x2,
          x3 * x3 * x3,
          x1 * x2 * x2,
          x2 * x1 * x1,
          x2 * x3 * x3,
          x3 * x2 * x2,
          x3 * x1 * x1,
          x1 * x3 * x3,
          x1 * x2 * x3};
}

}  // namespace

Eigen::Vector3d generic_alpha(const Eigen::Vector3d& n, const Eigen::Vector3d& v) {
  // beta and psi describe a plate, not a side of it: the normal that looks down. [A] S7, eq. 5, 7
  const Eigen::Vector3d plate = n.z() > 0 ? Eigen::Vector3d(-n) : n;
  const Coefficients t = terms(-v.z(), -plate.z(), plate.dot(v));
  // Even and odd terms apart: two short chains of sums instead of a long one.
  double f1 = 0, f2 = 0, f3 = 0, odd1 = 0, odd2 = 0, odd3 = 0;
  for (std::size_t k = 0; k < t.size(); k += 2) {
    f1 += kC1[k] * t[k], odd1 += kC1[k + 1] * t[k + 1];
    f2 += kC2[k] * t[k], odd2 += kC2[k + 1] * t[k + 1];
    f3 += kC3[k] * t[k], odd3 += kC3[k + 1] * t[k + 1];
  }
  f1 += odd1, f2 += odd2, f3 += odd3;
  // alpha_r     = f1 sin beta cos psi + f2 cos gamma
  // alpha_theta = f1 sin beta sin psi
  // alpha_z     = -f1 cos beta - f2 sin gamma - f3                                [A] eq. 7
  // In components of the world these are f1 plate + f2 v - f3 z.
  return f1 * plate + f2 * v - f3 * Eigen::Vector3d::UnitZ();
}

Eigen::Vector3d alpha(const Eigen::Vector3d& n, const Eigen::Vector3d& v, double mu_surf) {
  // Rounding must not decide on which of two sides a wall that slides along itself leads.
  constexpr double kLeading = 1e-6;
  if (n.dot(v) <= kLeading) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d generic = generic_alpha(n, v);
  // alpha = alpha_n + min(mu_surf |alpha_n| / |alpha_t|, 1) alpha_t                    [A] S4
  const double normal = -generic.dot(n);
  // The polynomials are a fit and go a little below zero where the resistance vanishes.
  if (normal <= 0) return Eigen::Vector3d::Zero();
  Eigen::Vector3d tangential = generic + normal * n;
  if (tangential.dot(v) > 0) return -normal * n;
  const double size = tangential.norm();
  if (size > mu_surf * normal) tangential *= mu_surf * normal / size;
  return tangential - normal * n;
}

double flat_plate_alpha() {
  static const double value =
      generic_alpha(-Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ()).z();
  return value;
}

double predicted_xi_n_N_m3(double rho_c_kg_m3, double mu_int) {
  // xi_n = rho_c g (894 mu_int^3 - 386 mu_int^2 + 89 mu_int)                            [A] S4
  return rho_c_kg_m3 * kGravity_m_s2 * mu_int * (mu_int * (894 * mu_int - 386) + 89);
}

double bekker_pressure_Pa(double k_c, double k_phi, double n, double b_m, double z_m) {
  // p = (k_c / b + k_phi) z^n                                                              [B]
  return z_m > 0 ? (k_c / b_m + k_phi) * std::pow(z_m, n) : 0;
}

}  // namespace hoof::sim::rft
