// Hip and knee: hold, move to the start of the stance path, follow the path. Joint impedance with
// torque feed-forward of gravity, inertia and friction.
#pragma once

#include "firmware/control/leg_dynamics.h"
#include "firmware/control/settings.h"
#include "firmware/control/stance_path.h"
#include "firmware/control/types.h"
#include "firmware/trajectory/generator.h"

namespace hoof::firmware::control {

struct LegCommand {
  JointCommand hip;
  JointCommand knee;
};

class LegMotion {
 public:
  LegMotion(const Settings& settings, float period_s);

  /// Begins by holding the measured posture.
  void start(LegAngles measured);

  /// From holding: a synchronised jerk-limited move of both joints to the start of the path.
  void go_to_path();

  /// Takes effect on the path; 0 stops where the foot then is.
  void set_frequency(float frequency_Hz) { path_.set_frequency(frequency_Hz); }

  LegCommand step();

  bool on_path() const { return stage_ == Stage::kPath; }
  bool at_rest() const { return path_.at_rest(); }
  /// False once a point of the path lay beyond the reach: the command is then not to be trusted.
  bool reachable() const { return reachable_; }

  /// The foot is fixed to the shank so that it is level at the deepest point of the path. Positive:
  /// its front points up.
  float foot_pitch_rad(LegAngles q) const {
    return LegKinematics::shank_angle_rad(q) - level_shank_rad_;
  }

  LegAngles acceleration_rad_s2() const { return acceleration_; }  // commanded
  LegAngles set_point_rad() const { return position_; }
  /// Of the last step().
  const LegPosture& set_point() const { return set_point_; }
  const StancePath& path() const { return path_; }
  const LegKinematics& kinematics() const { return kinematics_; }
  const LegDynamics& dynamics() const { return dynamics_; }

 private:
  enum class Stage : std::uint8_t { kHold, kMove, kPath };
  using Generator = trajectory::Generator<float, 2>;

  void advance_move();
  void advance_path();
  JointCommand command(float position, float velocity, float torque) const;

  LegSettings settings_;
  float period_s_;
  LegKinematics kinematics_;
  LegDynamics dynamics_;
  StancePath path_;
  float level_shank_rad_;
  Generator generator_;
  Generator::InputType input_;
  Generator::OutputType move_;
  Stage stage_ = Stage::kHold;
  bool reachable_ = true;
  LegAngles position_;
  LegPosture set_point_;
  LegAngles velocity_;
  LegAngles acceleration_;
};

}  // namespace hoof::firmware::control
