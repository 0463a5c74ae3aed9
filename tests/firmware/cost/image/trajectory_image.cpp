// The generator as the board runs it, for the emulator to call. Compiled once per number of joints
// (HOOF_COST_JOINTS) with the board's flags.
#include <new>

#include "firmware/trajectory/generator.h"

namespace {

using namespace hoof::firmware::trajectory;

constexpr int kJoints = HOOF_COST_JOINTS;
using GeneratorType = Generator<float, kJoints>;

alignas(GeneratorType) unsigned char storage[sizeof(GeneratorType)];
GeneratorType& generator() {
  return *std::launder(reinterpret_cast<GeneratorType*>(storage));
}

}  // namespace

extern "C" {

// Written and read by the host: these types have the same layout there.
Input<float, kJoints> cost_input;
Output<float, kJoints> cost_output;

void cost_make(int work_per_update) {
  new (storage) GeneratorType(0.001f);
  generator().set_work_per_update(work_per_update);
}

int cost_update() {
  return static_cast<int>(generator().update(cost_input, cost_output));
}

int cost_state_bytes() {
  return sizeof(GeneratorType);
}
}
