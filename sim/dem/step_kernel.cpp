#include "sim/dem/step_kernel.h"

namespace hoof::sim {

#define HOOF_DECLARE_KERNEL(isa)                                                \
  namespace isa {                                                               \
  void step_mixed(const StepArguments<float>&, std::uint32_t, std::uint32_t);   \
  void step_double(const StepArguments<double>&, std::uint32_t, std::uint32_t); \
  }
HOOF_DECLARE_KERNEL(portable)
HOOF_DECLARE_KERNEL(avx2)
HOOF_DECLARE_KERNEL(avx512)
#undef HOOF_DECLARE_KERNEL

bool is_supported(InstructionSet set) {
  switch (set) {
    case InstructionSet::kPortable:
      return true;
    case InstructionSet::kAvx2:
      return __builtin_cpu_supports("avx2");
    case InstructionSet::kAvx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  }
  return false;
}

InstructionSet best_instruction_set() {
  if (is_supported(InstructionSet::kAvx512)) return InstructionSet::kAvx512;
  if (is_supported(InstructionSet::kAvx2)) return InstructionSet::kAvx2;
  return InstructionSet::kPortable;
}

const char* to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::kPortable:
      return "portable";
    case InstructionSet::kAvx2:
      return "avx2";
    case InstructionSet::kAvx512:
      return "avx512";
  }
  return "?";
}

template <>
StepKernel<float> step_kernel<float>(InstructionSet set) {
  if (set == InstructionSet::kAvx512) return avx512::step_mixed;
  if (set == InstructionSet::kAvx2) return avx2::step_mixed;
  return portable::step_mixed;
}

template <>
StepKernel<double> step_kernel<double>(InstructionSet set) {
  if (set == InstructionSet::kAvx512) return avx512::step_double;
  if (set == InstructionSet::kAvx2) return avx2::step_double;
  return portable::step_double;
}

}  // namespace hoof::sim
