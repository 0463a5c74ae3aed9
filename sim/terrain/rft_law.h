// Three-dimensional resistive force theory: the stress of flowing sand on a plate, and Bekker's
// pressure over depth. Formulas only, without memory: what stands still is RftTerrain's matter.
//
// [A] Agarwal, Goldman, Kamrin: A mechanistic framework for reduced-order models in soft
//     materials: application to three-dimensional granular intrusion. PNAS 120 (2023) e2214017120,
//     main text and supplement S3, S4, S7.
// [B] Bekker: Introduction to terrain-vehicle systems. University of Michigan Press, 1969.
//
// Symbol     Meaning                                                                     Unit
// n          unit normal of the facet, out of the body                                   1
// v          unit velocity of the facet                                                  1
// beta, psi  tilt and twist of n; n = (sin beta cos psi, sin beta sin psi, -cos beta)    rad
//            with r along the horizontal part of v, z up, theta = z x r
// gamma      v = (cos gamma, 0, -sin gamma): 90 deg is straight down                     rad
// x1 x2 x3   sin gamma, cos beta, n . v                                                  1
// f1 f2 f3   functions of x1 x2 x3, polynomials of third order                           1
// alpha      stress over xi_n times depth                                                1
// xi_n       the sand's scale                                                            N/m^3
// mu_surf    friction between facet and sand                                             1
// k_c k_phi  Bekker's moduli                                              N/m^(n+1), N/m^(n+2)
// n          Bekker's exponent (there is no other n where it is used)                    1
#pragma once

#include <Eigen/Core>

namespace hoof::sim::rft {

/// alpha of the reference medium and a rough plate, world axes. [A] eq. 7 and S3.
/// @param n, v unit vectors
Eigen::Vector3d generic_alpha(const Eigen::Vector3d& n, const Eigen::Vector3d& v);

/// alpha of a leading facet (n . v above rounding) with friction mu_surf; zero else. Never pulls at
/// the facet (alpha . n <= 0) and never drives it (tangential part against v), so it never gives
/// work.
Eigen::Vector3d alpha(const Eigen::Vector3d& n, const Eigen::Vector3d& v, double mu_surf);

/// alpha_z of a flat plate going straight down, all coefficients summed.
double flat_plate_alpha();

/// xi_n from the sand's own numbers. [A] eq. S4, a fit to their simulations for mu_int up to 0.9.
/// @param rho_c_kg_m3 critical bulk density  @param mu_int internal friction, tan of its angle
double predicted_xi_n_N_m3(double rho_c_kg_m3, double mu_int);

/// Bekker's pressure of a flat plate of smaller width b at depth z. [B]
double bekker_pressure_Pa(double k_c, double k_phi, double n, double b_m, double z_m);

}  // namespace hoof::sim::rft
