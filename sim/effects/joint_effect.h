// Where optional physics acts on a driven joint: goals, drive, friction, link, encoder.
#pragma once

#include <cstdint>

namespace hoof::sim {

/// What friction depends on; torques at the joint side of the gear.
struct JointMotion {
  double velocity_rad_s = 0;
  double motor_torque_Nm = 0;
  /// What gravity and springs put on the link.
  double external_torque_Nm = 0;
  double coulomb_Nm = 0;  // of the nominal model
  double position_rad = 0;
  double time_s = 0;
};

/// The stages at which an effect is asked; a plant asks only those that an effect declares.
enum JointStage : unsigned {
  kGoalStage = 1,      // goal_delay_s, goal_lost
  kSupplyStage = 2,    // supply_V
  kMotorStage = 4,     // motor_torque_Nm
  kFrictionStage = 8,  // friction_Nm
  kLinkStage = 16,     // link_torque_Nm
  kGearStage = 32,     // gap_rad, stiffness_Nm_rad
  kSensorStage = 64,   // reading_rad, reading_slope
};

class JointEffect {
 public:
  virtual ~JointEffect() = default;

  /// The JointStage bits at which this effect does something.
  virtual unsigned stages() const = 0;

  /// Before a recording or run: forgets what went before.
  /// @param current_rms_A over the data; effects of heat are scaled by it
  virtual void reset(double /*current_rms_A*/, double /*torque_rms_Nm*/) {}

  /// Goals reach the drive this much late.
  virtual double goal_delay_s() const { return 0; }
  /// Asked once per period of the goals: true where this one does not arrive.
  virtual bool goal_lost() { return false; }

  virtual double supply_V(double supply_V, double /*current_A*/, double /*duty*/) const {
    return supply_V;
  }
  /// What the motor makes of the torque its law asks for; called once per step of dt_s.
  virtual double motor_torque_Nm(double torque_Nm, double /*velocity_rad_s*/, double /*dt_s*/) {
    return torque_Nm;
  }
  /// Added to the Coulomb torque; may be negative.
  virtual double friction_Nm(const JointMotion& /*motion*/) const { return 0; }
  /// Torque on the link; called once per step, time from the start of the recording or run.
  virtual double link_torque_Nm(double /*q_rad*/, double /*w_rad_s*/, double /*time_s*/) {
    return 0;
  }
  /// Full gap between motor side and link.
  virtual double gap_rad() const { return 0; }
  /// Of a spring between motor side and link; 0: as the nominal model has it.
  virtual double stiffness_Nm_rad() const { return 0; }
  /// What the encoder reads at q, and its slope.
  virtual double reading_rad(double q_rad) const { return q_rad; }
  virtual double reading_slope(double /*q_rad*/) const { return 1; }
};

}  // namespace hoof::sim
