#define HOOF_ISA avx512
#define HOOF_VECTOR_BYTES 64
#include "sim/dem/step_kernel_lanes.h"
