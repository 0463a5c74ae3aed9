// A run on the rigid floor with faults, and everything that was seen of it.
#pragma once

#include <string>
#include <vector>

#include "hil_bridge/session.h"
#include "tests/hil_bridge/rigid_bench.h"

namespace hoof::test {

/// The plant's truth after one tick.
struct TrueTick {
  double time_s = 0;
  double toe_rad = 0;  // mean of both toes
};

struct FaultRun {
  bridge::SessionResult result;
  std::vector<SeenFrame> frames;
  std::vector<TrueTick> truth;
};

inline std::vector<bridge::FaultSpec> parse_faults(const std::string& toml) {
  return bridge::read_faults(sim::Settings::parse(toml, "faults.toml"));
}

/// @param kind "sinkage" or "traction"
/// @param toml [[fault]] entries; empty: a run without any
inline FaultRun run_with_faults(const std::string& kind, const std::string& toml) {
  const tools::RunSettings settings = rigid_run(kind, {"experiment.toe_deg=20"});
  const auto experiment = rigid_bench(settings);
  FaultRun run;
  const auto wires = bridge::in_process_wires([&](int bus, const hal::CanFrame& frame) {
    run.frames.push_back({bus, frame});
  });
  bridge::FaultTimeline faults(parse_faults(toml), settings.has_drives());
  bridge::SessionSettings session;
  session.has_toes = settings.foot.has_toes;
  session.toe_rad = settings.toe_rad();
  session.firmware_leg = settings.firmware_leg();
  session.frequency_Hz = settings.traction.frequency_Hz;
  if (!toml.empty()) session.faults = &faults;
  run.result = bridge::run_session(
      *experiment, settings.parameters, *wires, session, [&run](const bridge::TickRecord& r) {
        run.truth.push_back({r.plant.time_s, 0.5 * (r.plant.toe_left_rad + r.plant.toe_right_rad)});
        return true;
      });
  return run;
}

inline double time_of(const SeenFrame& seen) {
  return double(seen.frame.stamp_ns) * 1e-9;
}

/// Frames of one identifier that ended in [from_s, to_s), in order.
inline std::vector<hal::CanFrame> frames_in(const FaultRun& run, std::uint32_t id, double from_s,
                                            double to_s) {
  std::vector<hal::CanFrame> frames;
  for (const SeenFrame& seen : run.frames) {
    const double t_s = time_of(seen);
    if (seen.frame.id == id && t_s >= from_s && t_s < to_s) frames.push_back(seen.frame);
  }
  return frames;
}

}  // namespace hoof::test
