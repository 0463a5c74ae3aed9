// What `hoof replay` does once its flags are read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>

namespace hoof::tools {

struct ReplayRequest {
  std::filesystem::path recording;  // a run's folder, or a bus log beside its recording.json
  std::optional<std::uint32_t> to_tick;
};

/// Prints the verdict. @throws Differs with the first difference, UserError
void replay_recording(const ReplayRequest& request, std::ostream& out);

}  // namespace hoof::tools

/// Called before the firmware runs the tick of --to-tick, for a breakpoint:
///   gdb -ex 'break hoof_replay_at_tick' -ex run --args hoof replay RUN --to-tick 812
extern "C" void hoof_replay_at_tick();
