#include "sim/effects/drive_effect.h"

#include <cmath>

namespace hoof::sim {

DriveEffect::DriveEffect(DriveEffectKind kind, double amount, std::uint64_t seed)
    : kind_(kind), amount_(amount), random_(seed) {}

void DriveEffect::start() {
  active_ = begun_ = true;
  if (kind_ == DriveEffectKind::kEncoderJump) shift_rad_ += amount_;
}

double DriveEffect::note(double value, double without) {
  if (value != without) ++changed_;
  return value;
}

/// Sum of twelve uniform numbers less its mean: variance 1, none beyond 6, and unlike the standard
/// library's normal distribution the same on every platform.
double DriveEffect::normal() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += double(random_() >> 11) * 0x1p-53;
  return sum;
}

double DriveEffect::encoder_rad(double reading_rad, double dt_s) {
  const bool begins = begun_;
  begun_ = false;
  switch (kind_) {
    case DriveEffectKind::kEncoderJump:
      return note(reading_rad + shift_rad_, reading_rad);
    case DriveEffectKind::kEncoderDrift:
      if (active_) shift_rad_ += amount_ * dt_s;
      return note(reading_rad + shift_rad_, reading_rad);
    case DriveEffectKind::kEncoderStuck:
      if (begins) stuck_rad_ = reading_rad;
      return active_ ? note(stuck_rad_, reading_rad) : reading_rad;
    case DriveEffectKind::kEncoderNoise:
      return active_ ? note(reading_rad + amount_ * normal(), reading_rad) : reading_rad;
    case DriveEffectKind::kEncoderOffset:
    case DriveEffectKind::kTorqueLoss:
    case DriveEffectKind::kStall:
      break;
  }
  return reading_rad;
}

double DriveEffect::zero_shift_rad() {
  if (!active_ || kind_ != DriveEffectKind::kEncoderOffset) return 0.0;
  return note(amount_, 0.0);
}

double DriveEffect::motor_torque_Nm(double torque_Nm) {
  if (!active_ || kind_ != DriveEffectKind::kTorqueLoss) return torque_Nm;
  return note(amount_ * torque_Nm, torque_Nm);
}

double DriveEffect::friction_Nm() const {
  return active_ && kind_ == DriveEffectKind::kStall ? amount_ : 0.0;
}

void DriveEffect::note_friction(double friction_Nm, double own_Nm) {
  if (this->friction_Nm() > 0.0 && std::abs(friction_Nm) > own_Nm) ++changed_;
}

}  // namespace hoof::sim
