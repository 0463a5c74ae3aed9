// One thing that is wrong with a drive: its encoder, its motor or its gear. Off until started.
#pragma once

#include <cstdint>
#include <random>

namespace hoof::sim {

enum class DriveEffectKind {
  kEncoderJump,    // amount, rad: counts slip at the start, and stay slipped
  kEncoderOffset,  // amount, rad: the zero is shifted while active; no speed is seen
  kEncoderStuck,   // the encoder stays at its reading of the start
  kEncoderDrift,   // amount, rad/s: the reading creeps while active, and stays where it crept to
  kEncoderNoise,   // amount, rad: standard deviation of each sample, white
  kTorqueLoss,     // amount: share of the motor's torque that is left, 0 to 1
  kStall,          // amount, Nm: Coulomb friction more on the rotor; large: it stands
};

/// Angles and torques at the joint side of the gear, as all of a drive. Same seed, same noise.
class DriveEffect {
 public:
  DriveEffect(DriveEffectKind kind, double amount, std::uint64_t seed);

  void start();
  void stop() { active_ = false; }
  bool active() const { return active_; }

  /// What the encoder reads instead of `reading_rad`; once per sample, dt_s after the last.
  double encoder_rad(double reading_rad, double dt_s);
  /// What is added to position readings without being seen as speed, rad.
  double zero_shift_rad();
  /// What the motor makes of the torque that its law asks for.
  double motor_torque_Nm(double torque_Nm);
  /// Coulomb friction beside the drive's own, Nm.
  double friction_Nm() const;
  /// Told after each sub-step: what the rotor's friction took, against what the drive's own could.
  void note_friction(double friction_Nm, double own_Nm);

  /// Samples and torques that came out otherwise than without the effect.
  std::uint64_t changed() const { return changed_; }

 private:
  double normal();
  double note(double value, double without);

  DriveEffectKind kind_;
  double amount_;
  std::mt19937_64 random_;
  bool active_ = false;
  bool begun_ = false;  // started in the present sample
  double shift_rad_ = 0.0;
  double stuck_rad_ = 0.0;
  std::uint64_t changed_ = 0;
};

}  // namespace hoof::sim
