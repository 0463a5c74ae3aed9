// The numbers of the exchange between rig and ground.
#pragma once

#include "sim/config/reader.h"

namespace hoof::sim {

struct CouplingSettings {
  /// Interval between two exchanges; also the step of the multibody world and of the drives' law.
  double exchange_s = 0.0;
  /// The ground is not stepped before a body first comes this near to its surface. Above the
  /// largest grain radius, and far above the way of the fastest foot in one exchange.
  double sleep_margin_m = 0.0;
  /// A body faster than this has diverged.
  double speed_limit_m_s = 0.0;
  /// An exchange that has made more energy than this has diverged.
  double energy_error_limit_J = 0.0;

  /// @throws std::invalid_argument naming the first broken rule
  void validate() const;
};

/// Reads the section "coupling" of a run.
CouplingSettings read_coupling(Reader section);

}  // namespace hoof::sim
