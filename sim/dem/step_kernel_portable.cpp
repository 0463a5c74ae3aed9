#define HOOF_ISA portable
#define HOOF_VECTOR_BYTES 16
#include "sim/dem/step_kernel_lanes.h"
