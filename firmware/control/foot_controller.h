// The foot's mind: modes, and what each drive should do next. One call per tick.
#pragma once

#include <optional>

#include "firmware/control/adaptive_opening.h"
#include "firmware/control/ground_contact.h"
#include "firmware/control/homing.h"
#include "firmware/control/leg_motion.h"
#include "firmware/control/settings.h"
#include "firmware/control/toe_opening.h"
#include "firmware/control/types.h"

namespace hoof::firmware::control {

enum class Acceptance : std::uint8_t {
  kAccepted = 0,
  kOutOfRange,
  kWrongMode,
  kNoLeg,
  kNotCalibrated
};

/// Pure: no bus, no clock, no heap. Modes and their changes: firmware/README.md.
class FootController {
 public:
  /// @param period_s length of a tick in control time
  FootController(const Settings& settings, JointPresence presence, float period_s = kTick_s);

  /// New settings, as if constructed anew with them; only in mode off, where nothing moves. The
  /// toe's zero stays known unless how it is found, or whether there is a toe, has changed.
  /// @return false in any other mode, with nothing changed
  bool configure(const Settings& settings, JointPresence presence);

  // ---- orders; each says whether it is taken and, if not, changes nothing --------------------
  // What moves is refused as not calibrated where an absolute encoder in use has no zero.

  /// Home where needed, open the toes to the angle (per side), take the leg to the start of its
  /// path. While running: stops the gait where the foot then is.
  Acceptance order_ready(float toe_angle_rad);
  /// As ready, then follow the path.
  Acceptance order_run(float toe_angle_rad, float frequency_Hz);
  /// Let everything down by damping, then off.
  Acceptance order_stop();
  /// Clears latched faults. Only from emergency off, fault or off.
  Acceptance order_reset();

  // ---- what others found ---------------------------------------------------------------------

  /// Latches faults; a moving foot begins its damped stop.
  void trip(FaultBits faults);
  /// Torque off at once, from any mode.
  void emergency_stop();

  // ---- the tick ------------------------------------------------------------------------------

  [[gnu::noinline]] const Wish& step(const PerJoint<JointState>& joints);

  /// Set in the tick in which homing found the toe's zero: the shift of all later toe angles.
  std::optional<float> new_toe_zero_rad() const { return new_toe_zero_rad_; }

  Mode mode() const { return mode_; }
  FaultBits faults() const { return faults_; }
  /// The toe's zero is known: found at its stop, or told by a calibrated absolute encoder.
  bool homed() const { return homed_ || !presence_.toe; }
  const ToeOpening& toe() const { return parts_->toe; }
  const LegMotion& leg() const { return parts_->leg; }
  /// Of the leg, as measured in the last step().
  const LegPosture& posture() const { return posture_; }
  const GroundEstimate& ground() const { return parts_->contact.estimate(); }
  const Wish& wish() const { return wish_; }
  const JointPresence& presence() const { return presence_; }
  float hip_above_sand_m() const { return settings_.path.hip_above_sand_m; }

 private:
  using States = PerJoint<JointState>;

  /// All that is made of the settings, and made anew with them.
  struct Parts {
    Homing homing;
    ToeOpening toe;
    LegMotion leg;
    GroundContact contact;
    AdaptiveOpening adaptive;

    Parts(const Settings& settings, float period_s);
  };

  Acceptance accept(float toe_angle_rad, float frequency_Hz);
  bool calibrated() const;
  void order_toe(float toe_angle_rad);
  void enter(Mode mode);
  bool active() const;
  void step_homing(const States& joints);
  void enter_drives(const States& joints);
  void seek_toe_zero(const States& joints);
  void become_ready(const States& joints);
  void step_ready(const States& joints);
  void step_running(const States& joints);
  void step_damped_stop(const States& joints);
  void command_toe(const States& joints);
  void command_leg(const States& joints);
  void command(Joint joint, const JointCommand& command);
  void wish_all(DriveAction action);
  void feel_ground(const States& joints);
  void adapt_toe();

  Settings settings_;
  JointPresence presence_;
  float period_s_;
  std::optional<Parts> parts_;  // always there; optional, for it can be made anew without a heap
  LegPosture posture_;

  Mode mode_ = Mode::kOff;
  float mode_s_ = 0.0f;  // time in this mode
  FaultBits faults_ = 0;
  bool homed_ = false;
  bool drives_entered_ = false;
  bool run_ordered_ = false;
  float toe_angle_rad_ = 0.0f;
  float frequency_Hz_ = 0.0f;
  float rest_s_ = 0.0f;
  std::optional<float> new_toe_zero_rad_;
  Wish wish_;
};

}  // namespace hoof::firmware::control
