#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tools/conceal/hidden_effect.h"
#include "tools/conceal/servo_machine.h"

namespace hoof::tools::conceal {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// The hidden effects as flat numbers; each is off as it stands here. SI units.
struct ServoTerms {
  // Section 4 of the contract.
  double stribeck_extra = 0, stribeck_speed = 1;
  double load_coefficient = 0;
  double asymmetry = 0;
  double gap = 0, stiffness = 0;
  double cogging = 0, cogging_order = 0, cogging_phase = 0;
  double ceiling = kNever;
  double sag_resistance = 0;
  double derating = 0, heat_time = 1, heat_reference = 1;
  double lag_time = 0;
  double delay = 0;
  double eccentricity = 0, eccentricity_phase = 0;
  double spring = 0, spring_rest = 0;
  double loss_probability = 0, loss_burst = 0;
  // Not in the contract.
  double drag = 0;                                     ///< Nm s2/rad2, against w |w|
  double rough = 0, rough_order = 0, rough_phase = 0;  ///< share of Coulomb, by angle
  double bristle_slip = 0;                             ///< rad, presliding (LuGre)
  double dead_zone = 0;                                ///< Nm of motor torque lost about zero
  double slide_at = kNever, slide_by = 0;              ///< the payload slides outwards, m
  double drop_at = kNever, drop_by = 0;                ///< part of the payload falls off, kg
  double hardening = 0, hardening_rest = 0;            ///< Nm/rad3
  double hum = 0, hum_frequency = 0;                   ///< Nm, Hz: a disturbance in time
  double wear_in = 0, wear_time = 1;                   ///< Coulomb grows by a share with time
  double uneven = 0;                                   ///< motor stronger one way, share
  double fast_loss = 0, fast_speed = 1;                ///< torque lost over a speed, share
  double stop_at = kNever, stop_stiffness = 0;         ///< end stop, rad, Nm/rad
  double ripple = 0, ripple_order = 0;                 ///< share of the torque, by angle
  double swing_share = 0, swing_frequency = 1;         ///< part of the load hangs on a spring
  double detent = 0, detent_at = 0, detent_width = 1;  ///< Nm, rad, rad
  double late_sensor = 0;                              ///< s, the drive's position is late

  bool two_masses() const { return gap > 0 || stiffness > 0; }
};

ServoTerms terms_of(const std::vector<HiddenEffect>& hidden);

/// What the strength of an effect at one moment is reckoned from.
struct ServoMoment {
  double t_s = 0;
  double position = 0, velocity = 0;            ///< motor side
  double link_position = 0, link_velocity = 0;  ///< the same where there is one mass
  double acceleration = 0, link_acceleration = 0;
  double commanded_Nm = 0;  ///< torque of the law, with the supply as it is
  double unsagged_Nm = 0;   ///< the same at the full supply
  double delivered_Nm = 0;  ///< what the motor makes
  double outer_Nm = 0;      ///< gravity and springs on the link
  double goal = 0, seen_goal = 0;
  double heat = 0;  ///< over the reference, 1 at the rms current
  double swing_Nm = 0, friction_Nm = 0;
};

/// Size of the effect's own torque (Nm), or of the change it makes where it is no torque: the
/// number by which a moment is said to matter for it.
double strength(const std::string& effect, const ServoTerms& terms, const ServoMachine& machine,
                const ServoMoment& moment);

}  // namespace hoof::tools::conceal
