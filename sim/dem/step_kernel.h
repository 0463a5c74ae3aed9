// One time step of a range of windows: forces of all neighbours, then integration. Chosen at run
// time for the instruction set of the machine; every choice gives the same bytes, because each lane
// does the same IEEE operations in the same order and no fused multiply-add is used.
#pragma once

#include <cstdint>

#include "sim/dem/contact_energy.h"
#include "sim/dem/contact_law.h"
#include "sim/dem/grain_record.h"

namespace hoof::sim {

/// What one window did in a step.
struct WindowResult {
  double fastest_m_s = 0;  // largest speed after the step; infinite or NaN where a grain diverged
  // Only when asked for:
  ContactEnergy contacts;     // pairs counted from both sides; lost: in this step
  double viscous_loss_J = 0;  // in this step
  double deepest_ratio = 0;   // overlap over the smaller radius
  double stiffest_1_s2 = 0;   // sum of a grain's contact stiffnesses over its mass
};

template <typename Real>
struct StepArguments {
  const GrainRecord<Real>* in;
  GrainRecord<Real>* out;
  EllSlot<Real>* slots;
  std::uint16_t* touching;              // per slot: bit l set while lane l touched in the last step
  const std::uint32_t* slot_begin;      // per group, and one more
  const std::uint32_t* slot_count;      // per group, and one more, which is 0
  const BoundaryForce<Real>* boundary;  // per group that has any
  const std::int32_t* boundary_of_group;  // -1 = none
  WindowResult* results;                  // per window, written
  std::uint32_t group_count;
  Real lsb_x_m, lsb_y_m, lsb_z_m;
  Real dt_s;
  Real gx, gy, gz;       // m/s^2
  Real velocity_factor;  // 1, but for beds being settled: what a viscous medium leaves per step
  Real mass_per_r3;      // 4/3 pi rho, kg/m^3
  PairLaw<Real> law;
  CoulombCap cap;
  RollingLaw rolling;
  bool account;  // fill in all of the results
};

template <typename Real>
using StepKernel = void (*)(const StepArguments<Real>&, std::uint32_t window_begin,
                            std::uint32_t window_end);

enum class InstructionSet { kPortable, kAvx2, kAvx512 };

/// The widest that this machine has.
InstructionSet best_instruction_set();
bool is_supported(InstructionSet set);
const char* to_string(InstructionSet set);

template <typename Real>
StepKernel<Real> step_kernel(InstructionSet set);

}  // namespace hoof::sim
