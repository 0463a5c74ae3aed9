// A push in grains.
#pragma once

#include "sim/config/materials.h"
#include "sim/terrain/bed_maker.h"
#include "tools/terrain/push_case.h"

namespace hoof::tools {

/// Bed steps of a push at a speed.
double push_steps(const PushCase& plate, const sim::BedSettings& bed, double speed_m_s);

/// Everything that decides a push's forces, in one line.
std::string push_key(const PushCase& plate, const std::string& bed_key, double speed_m_s);

/// @throws std::invalid_argument where plate and path come nearer to a wall or the floor than half
/// the plate's smaller width
void require_room(const PushCase& plate, const sim::BedSettings& bed);

/// @throws std::invalid_argument as require_room; std::runtime_error "stopped" when progress says
/// so, or where the bed blows up
Push push_in_sand(const PushCase& plate, const sim::BedSettings& bed,
                  const sim::Materials& materials, const sim::BedState& state, double speed_m_s,
                  int threads, const sim::BedProgress& progress);

}  // namespace hoof::tools
