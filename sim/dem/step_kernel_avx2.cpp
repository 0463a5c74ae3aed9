#define HOOF_ISA avx2
#define HOOF_VECTOR_BYTES 32
#include "sim/dem/step_kernel_lanes.h"
