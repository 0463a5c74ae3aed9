// The numeric part of the gate: one joint's command against one joint's ceilings.
#pragma once

#include "firmware/control/types.h"
#include "firmware/safety/limits.h"
#include "firmware/safety/torque_gate.h"

namespace hoof::firmware::safety {

/// False when any number of the command is not finite.
bool is_finite(const control::JointCommand& command);

/// No stiffness, no target speed, no feed-forward: can only take energy out of the joint.
bool is_pure_damping(const control::JointCommand& command);

/// Limits gains, target speed, travel and distance from the measured position. Position limits
/// apply where there is stiffness, travel where the joint's zero is known.
LimitBits limit_targets(const JointLimits& limits, const control::JointState& state,
                        control::JointCommand& command);

/// Limits the torque that the drive will make of the command at the measured state: the
/// feed-forward to what the wire carries, the whole to limits.torque_Nm and to `ceiling_Nm` (no
/// more than that; less where the winding is warm), its change against `previous_Nm` to the rate.
/// Pure damping may set in at any rate.
LimitBits limit_torque(const JointLimits& limits, float ceiling_Nm,
                       const control::JointState& state, float previous_Nm,
                       control::JointCommand& command);

/// Changes the command so that its torque at the measured state changes by delta_Nm: by the
/// feed-forward as far as the wire carries, the rest by moving the position target, then the
/// speed target, towards the measured values. The stiffness stays, so the joint stays as firm.
void shift_torque(const JointLimits& limits, const control::JointState& state, float delta_Nm,
                  control::JointCommand& command);

}  // namespace hoof::firmware::safety
