// One time step of a range of groups: forces of all neighbours, then integration. Chosen at run
// time for the instruction set of the machine; every choice gives the same bytes, because each lane
// does the same IEEE operations in the same order and no fused multiply-add is used.
#pragma once

#include <cstdint>

#include "sim/dem/contact_law.h"
#include "sim/dem/grain_record.h"

namespace hoof::sim {

template <typename Real>
struct StepArguments {
  const GrainRecord<Real>* in;
  GrainRecord<Real>* out;
  EllSlot<Real>* slots;
  std::uint16_t* touching;              // per slot: bit l set while lane l touched in the last step
  const std::uint32_t* slot_begin;      // per group, then twice the end
  const BoundaryForce<Real>* boundary;  // per group that has any
  const std::int32_t* boundary_of_group;  // -1 = none
  Real lsb_x_m, lsb_y_m, lsb_z_m;
  Real dt_s;
  Real gx, gy, gz;       // m/s^2
  Real velocity_factor;  // 1, but for beds being settled: what a viscous medium leaves per step
  PairLaw<Real> law;
  CoulombCap cap;
  RollingLaw rolling;
};

/// @return largest squared speed in the range after the step, (m/s)^2.
template <typename Real>
using StepKernel = Real (*)(const StepArguments<Real>&, std::uint32_t group_begin,
                            std::uint32_t group_end);

enum class InstructionSet { kPortable, kAvx2, kAvx512 };

/// The widest that this machine has.
InstructionSet best_instruction_set();
bool is_supported(InstructionSet set);
const char* to_string(InstructionSet set);

template <typename Real>
StepKernel<Real> step_kernel(InstructionSet set);

}  // namespace hoof::sim
