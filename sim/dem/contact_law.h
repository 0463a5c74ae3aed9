// Hertz-Mindlin contact (no slip) with Coulomb cap, and the standard rolling friction.
//
// Source: Ji et al., Actuators 2026, 15(6), 330, section 2.2 (Hertz 1882, Mindlin 1949, Tsuji et
// al. 1992 for the damping); lost minus signs and roots restored. Two choices the text leaves open
// are named where they are made: the Coulomb cap and the spin that rolling friction works on.
//
// symbol    meaning                                                     unit
// delta     overlap                                                     m
// R_eff     1/R* = 1/R_A + 1/R_B (a wall has R = infinity)              m
// m_eff     1/m* = 1/m_A + 1/m_B (a wall has m = infinity)              kg
// E_eff     1/E* = (1-nu_A^2)/E_A + (1-nu_B^2)/E_B                      Pa
// G_eff     1/G* = (2-nu_A)/G_A + (2-nu_B)/G_B, G = E/(2(1+nu))         Pa
// S_n       2 E* sqrt(R* delta), normal stiffness                       N/m
// S_t       8 G* sqrt(R* delta), tangential stiffness                   N/m
// beta      ln e / sqrt(ln^2 e + pi^2), negative for e < 1              1
// n         unit normal, from the partner to this grain                 1
// v_n       normal part of the relative velocity, negative on approach  m/s
// v_t       tangential relative velocity at the contact point           m/s
// xi_t      tangential displacement since the contact began             m
//
// Works on scalars and on lanes: T needs + - * /, lane_sqrt and lane_select.
#pragma once

#include "sim/dem/vec3.h"

namespace hoof::sim {

/// Which normal force caps friction. The paper's text prints the elastic part; LIGGGHTS, and EDEM
/// as far as known, take the whole. The whole is the default: it is the force that presses the
/// faces.
enum class CoulombCap { kTotalNormal, kElasticNormal };

/// Which spin rolling friction works against. kOwnSpin: tau_i = -mu_r F_n R_i unit(omega_i), as the
/// paper (and EDEM's standard model). kRelativeSpin: LIGGGHTS 'cdt', on omega_i - omega_j with
/// R_eff and without its part along the normal; for cross checks.
enum class RollingLaw { kOwnSpin, kRelativeSpin };

/// Constants of one pair of materials. Made by make_pair_law() in contact_material.h.
template <typename Real>
struct PairLaw {
  Real E_eff_Pa;
  Real G_eff_Pa;
  // -2 sqrt(5/6) beta sqrt(S m*) with S_n = 2 E* a and S_t = 8 G* a, a the contact radius: both
  // dashpots are a constant times sqrt(a m*), one root instead of two.
  Real dashpot_n;  // -2 sqrt(5/6) beta sqrt(2 E*)
  Real dashpot_t;  // -2 sqrt(5/6) beta sqrt(8 G*)
  Real mu_s;
  Real mu_r;
};

// Square root, choice and magnitude for scalars and for vectors of lanes alike. The lanes' root is
// specialised where the instruction set is known (step_kernel_lanes.h).
template <typename T>
T lane_sqrt(T a);
template <>
HOOF_INLINE float lane_sqrt<float>(float a) {
  return __builtin_sqrtf(a);
}
template <>
HOOF_INLINE double lane_sqrt<double>(double a) {
  return __builtin_sqrt(a);
}
template <typename Mask, typename T>
HOOF_INLINE T lane_select(Mask mask, T a, T b) {
  return mask ? a : b;
}
template <typename T>
HOOF_INLINE T lane_abs(T a) {
  return lane_select(a < T{}, T{} - a, a);
}
/// True where any lane of the mask is.
template <typename Mask>
bool any_lane(Mask mask);
template <>
HOOF_INLINE bool any_lane<bool>(bool mask) {
  return mask;
}

/// Geometry and motion of one touching pair, seen from grain i.
template <typename T>
struct Touch {
  T delta;
  Vec3<T> n;      // from the partner to i
  Vec3<T> v_rel;  // velocity of i's centre minus the partner's (centre or wall point)
  Vec3<T> w_arm;  // c_i omega_i + c_j omega_j, c = centre to contact point; m/s
};

template <typename T>
struct TouchForce {
  Vec3<T> f_normal;      // on i, N
  Vec3<T> f_tangential;  // on i, acting at the contact point, N
  T F_n_elastic;         // N, the force rolling friction uses
  // For the energy account.
  T S_t;        // N/m
  T v_n;        // m/s
  T dashpot_n;  // Ns/m
  Vec3<T> v_t;  // m/s
};

/// The force of one touch on grain i. Call only where delta > 0.
/// @param a contact radius sqrt(R_eff delta), m  @param root sqrt(a m_eff)
/// @param xi_t tangential displacement, m: read, advanced by dt and cut back where friction slips.
/// The pull at the end of a contact (damping above the elastic force) is kept: cutting it off would
/// turn e = 0.54 into 0.583.
template <typename T, typename Real>
HOOF_INLINE TouchForce<T> touch_force(const PairLaw<Real>& law, CoulombCap cap, Real dt_s,
                                      const Touch<T>& c, T a, T root, Vec3<T>& xi_t) {
  const T S_t = Real(8) * law.G_eff_Pa * a;

  const T v_n = dot(c.v_rel, c.n);
  const T F_n_elastic = Real(4.0 / 3.0) * law.E_eff_Pa * a * c.delta;
  const T dashpot_n = law.dashpot_n * root;
  const T F_n = F_n_elastic - dashpot_n * v_n;

  const Vec3<T> v_t = c.v_rel - v_n * c.n - cross(c.w_arm, c.n);
  const T dt = T{} + dt_s;
  xi_t = xi_t + dt * v_t;
  xi_t = xi_t - dot(xi_t, c.n) * c.n;  // turn the spring with the contact plane

  const T limit = law.mu_s * lane_abs(cap == CoulombCap::kTotalNormal ? F_n : F_n_elastic);
  const T spring2 = S_t * S_t * dot(xi_t, xi_t);
  const auto slips = spring2 > limit * limit;
  // Sticking: spring + dashpot. Sliding: the spring is cut back to the limit and the dashpot is
  // off.
  T dashpot = law.dashpot_t * root;
  {
    const T one = T{} + Real(1);
    const T keep = lane_select(slips, limit / lane_sqrt(lane_select(slips, spring2, one)), one);
    xi_t = keep * xi_t;
    dashpot = lane_select(slips, T{}, dashpot);
  }
  const Vec3<T> f_t = (T{} - S_t) * xi_t - dashpot * v_t;
  return {F_n * c.n, f_t, F_n_elastic, S_t, v_n, dashpot_n, v_t};
}

/// The same where the roots are not at hand. Call only where delta > 0.
template <typename T, typename Real>
HOOF_INLINE TouchForce<T> touch_force_of(const PairLaw<Real>& law, CoulombCap cap, Real dt_s,
                                         const Touch<T>& c, T R_eff, T m_eff, Vec3<T>& xi_t) {
  const T a = lane_sqrt(R_eff * c.delta);
  return touch_force(law, cap, dt_s, c, a, lane_sqrt(a * m_eff), xi_t);
}

}  // namespace hoof::sim
