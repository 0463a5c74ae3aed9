// A recorded session of the foot: what was ordered, what was told, and the same once more with the
// real control code against the simulator.
#pragma once

#include <filesystem>
#include <vector>

#include "firmware/protocol/messages.h"
#include "tools/diagnose/foot_signals.h"
#include "tools/experiment/run_settings.h"

namespace hoof::tools {

/// Inputs of a session: all that its operator did, by control ticks.
struct FootScript {
  struct Entry {
    int tick = 0;
    firmware::protocol::SupervisorOrder order;
  };
  std::vector<Entry> orders;
  int lowered_at_tick = -1;  // sinkage: the carriage was started; -1: never
  int ticks = 0;
};

struct FootSession {
  RunSettings run;  // as its folder states it, the firmware's parameters as recorded
  FootScript script;
  FootSignals signals{0};
  bool on_grains = false;  // recorded on grains; `run` has the fast soil in their place
};

/// @throws UserError naming file and what is wrong or missing
FootSession read_foot_session(const std::filesystem::path& folder);

/// The session once more: the firmware's own control loop on simulated buses, the plant of `run`,
/// the orders at their ticks. A plant that diverges leaves what was told until then.
FootSignals replay_session(const RunSettings& run, const FootScript& script);

}  // namespace hoof::tools
