#include "tools/diagnose/foot_session.h"

#include <stdexcept>

#include "firmware/protocol/codec.h"
#include "hil_bridge/lock_step.h"
#include "hil_bridge/recording_facts.h"
#include "tools/experiment/bench.h"
#include "tools/log/bus_recording.h"
#include "tools/report/sample_table.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;
namespace protocol = firmware::protocol;

const SampleColumn& column(const SampleTable& table, const fs::path& file, const char* name) {
  const SampleColumn* found = table.find(name);
  if (found == nullptr) throw UserError(file.string() + ": no column " + name);
  return *found;
}

/// The same order is sent again until it is acknowledged; its counter tells that it is the same.
void take_orders(const BusRecording& recording, FootScript& script) {
  for (const LoggedFrame& logged : recording.frames) {
    protocol::SupervisorOrder order;
    if (logged.bus != 0 || decode(logged.frame, order) != protocol::DecodeResult::kOk) continue;
    const int tick = int((logged.stamp_ns - recording.origin_ns) / 1'000'000);
    const bool again =
        !script.orders.empty() && script.orders.back().order.counter == order.counter;
    if (!again) script.orders.push_back({tick, order});
  }
  // Before its first order the supervisor connects, which takes a tick or two of the bus.
  if (!script.orders.empty()) script.orders.front().tick = 0;
}

void take_samples(const fs::path& file, FootSession& session) {
  const SampleTable table = read_samples(file);
  const auto& phase = column(table, file, "phase_name").texts;
  const auto& depth_m = column(table, file, "depth_m").numbers;
  const auto& fx_N = column(table, file, "fx_N").numbers;
  const auto& fz_N = column(table, file, "fz_N").numbers;
  session.script.ticks = int(phase.size());
  session.signals = FootSignals(session.script.ticks);
  for (std::size_t i = 0; i < phase.size(); ++i) {
    session.signals.ground(int(i), depth_m[i], fx_N[i], fz_N[i]);
    const bool lowers = session.run.is_sinkage() && phase[i] != "preparing";
    if (lowers && session.script.lowered_at_tick < 0) session.script.lowered_at_tick = int(i);
  }
}

void refuse_what_cannot_be_replayed(const fs::path& folder, const RunSettings& run) {
  const std::string where = folder.string() + ": ";
  if (!run.faults.empty()) {
    throw UserError(where + "faults were put into this run; they are no physics to be found");
  }
  if (!run.is_sinkage() && run.traction.prescribed) {
    throw UserError(where + "its legs were moved as prescribed: no drive of theirs to tell of");
  }
}

}  // namespace

FootSession read_foot_session(const fs::path& folder) {
  FootSession session;
  session.run = read_run_settings((folder / "settings.toml").string(), {});
  refuse_what_cannot_be_replayed(folder, session.run);
  const fs::path facts_file = folder / bridge::kRecordingFactsFile;
  session.run.parameters =
      bridge::parse_recording_facts(read_file(facts_file), facts_file.string()).parameters;
  session.on_grains = session.run.on_grains();
  if (session.on_grains) session.run.terrain = "rft";
  take_samples(folder / "samples.csv", session);
  const BusRecording recording = read_bus_log(folder);
  take_orders(recording, session.script);
  if (session.script.orders.empty()) {
    throw UserError(recording.path.string() + ": no order of a supervisor; nothing was done");
  }
  for (const LoggedFrame& logged : recording.frames) {
    hal::CanFrame frame = logged.frame;
    frame.stamp_ns = logged.stamp_ns - recording.origin_ns;
    session.signals.take(frame);
  }
  session.signals.finish();
  return session;
}

FootSignals replay_session(const RunSettings& run, const FootScript& script) {
  FootSignals signals(script.ticks);
  const auto experiment = make_experiment(
      run, [](double) { return true; }, [](const std::string&) {});
  const auto wires = bridge::in_process_wires(
      [&signals](int, const hal::CanFrame& frame) { signals.take(frame); });
  bridge::LockStep lock_step(*experiment, run.parameters, *wires);
  std::size_t next = 0;
  try {
    for (int tick = 0; tick < script.ticks; ++tick) {
      for (; next < script.orders.size() && script.orders[next].tick <= tick; ++next) {
        const protocol::SupervisorOrder& order = script.orders[next].order;
        lock_step.supervisor().order(order.order, order.toe_angle_rad, order.frequency_Hz);
      }
      if (tick == script.lowered_at_tick) experiment->foot_ready();
      lock_step.tick();
      const sim::Observation now = experiment->observe();
      signals.ground(tick, now.depth_m, now.ground_N.x(), now.ground_N.z());
    }
  } catch (const std::runtime_error&) {
    // It diverged: a hypothesis to be rejected, by what is missing.
  }
  signals.finish();
  return signals;
}

}  // namespace hoof::tools
