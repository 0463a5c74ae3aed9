// Plants for lock-step without sand.
#pragma once

#include <memory>
#include <string>

#include "sim/experiments/experiment.h"
#include "tools/experiment/run_settings.h"

namespace hoof::benchmarks {

/// "sinkage" (the toe's drive) or "traction" (three drives), on a hard floor.
tools::RunSettings rigid_settings(const std::string& kind);

/// Firmware, buses, drives and supervisor only: the joints are held, nothing moves, nothing touches
/// the ground. What lock-step costs where the plant costs nothing.
std::unique_ptr<sim::Experiment> held(const tools::RunSettings& run);

/// The run's own rig, ODE, over the hard floor. It never ends.
std::unique_ptr<sim::Experiment> on_floor(const tools::RunSettings& run);

}  // namespace hoof::benchmarks
