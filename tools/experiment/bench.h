// The test bench of a run: ground, rig, drives and the experiment on them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hil_bridge/session.h"
#include "sim/dem/sand_bed.h"
#include "sim/experiments/experiment.h"
#include "sim/terrain/journaled_terrain.h"
#include "tools/experiment/run_settings.h"

namespace hoof::tools {

/// Progress of making a bed: share done; returns false to stop.
using BenchProgress = std::function<bool(double)>;
/// Something the user should know while the bench is built.
using BenchNote = std::function<void(const std::string&)>;

/// @param journal of the grains, where the run can be resumed
/// @throws std::runtime_error "stopped" when progress says so while a bed is made
std::unique_ptr<sim::Experiment> make_experiment(
    const RunSettings& run, const BenchProgress& progress, const BenchNote& note,
    const std::optional<sim::JournalSettings>& journal = {});

/// What the session is asked for: toes, gait.
bridge::SessionSettings session_settings(const RunSettings& run);

/// Null where the ground is not of grains.
const sim::SandBed* find_sand(const sim::Terrain& ground);

}  // namespace hoof::tools
