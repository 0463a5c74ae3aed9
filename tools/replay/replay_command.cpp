#include "tools/replay/replay_command.h"

#include <cstdio>
#include <string>

#include "firmware/protocol/dictionary.h"
#include "firmware/protocol/protocol_hash.h"
#include "tools/experiment/run_settings.h"
#include "tools/replay/replay.h"
#include "tools/run/differs.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

extern "C" __attribute__((noinline)) void hoof_replay_at_tick() {
  asm volatile("");  // a place to stop at; not to be optimised away
}

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

/// Runs that were recorded before recording.json was: their settings say the same, as long as the
/// defaults of parameters have not changed since.
bridge::RecordingFacts facts_from_settings(const fs::path& settings, std::ostream& out) {
  out << "no " << bridge::kRecordingFactsFile << " here; parameters are those of "
      << settings.string() << " and this program's defaults\n";
  const RunSettings run = read_run_settings(settings.string(), {});
  return bridge::recording_facts(run.bus, run.coupling.exchange_s, run.parameters);
}

bridge::RecordingFacts find_facts(const fs::path& log, std::ostream& out) {
  const fs::path folder = log.parent_path();
  if (const fs::path file = folder / bridge::kRecordingFactsFile; fs::exists(file)) {
    return bridge::parse_recording_facts(read_file(file), file.string());
  }
  if (const fs::path file = folder / "settings.toml"; fs::exists(file)) {
    return facts_from_settings(file, out);
  }
  throw UserError(log.string() + ": neither " + bridge::kRecordingFactsFile +
                  " nor settings.toml beside it; the firmware's parameters are not known");
}

const char* name_of(std::span<const firmware::protocol::ValueName> names, std::uint32_t value) {
  for (const auto& named : names) {
    if (named.value == value) return named.name.data();
  }
  return "?";
}

void print_state(const firmware::app::ControlLoop& loop, std::ostream& out) {
  const auto& t = loop.telemetry();
  char line[200];
  std::snprintf(line, sizeof line, "tick %u at %.6f s: mode %s, faults 0x%05x\n", t.tick,
                double(t.time_ns) * 1e-9,
                name_of(firmware::protocol::kModeNames, std::uint32_t(t.mode)), unsigned(t.faults));
  out << line;
  const char* const joints[] = {"toe", "hip", "knee"};
  for (std::size_t j = 0; j < 3; ++j) {
    const auto& state = t.state[j];
    const auto& wish = t.verdict.joint[j].command;
    std::snprintf(
        line, sizeof line,
        "  %-4s at %9.5f rad, %9.4f rad/s, %9.3f Nm; commanded %9.5f rad, kp %8.2f Nm/rad, "
        "kd %7.3f Nm s/rad, %9.3f Nm\n",
        joints[j], double(state.position_rad), double(state.velocity_rad_s),
        double(state.torque_Nm), double(wish.position_rad), double(wish.kp_Nm_rad),
        double(wish.kd_Nm_s_rad), double(wish.torque_Nm));
    out << line;
  }
}

}  // namespace

void replay_recording(const ReplayRequest& request, std::ostream& out) {
  const fs::path log = find_bus_log(request.recording);
  const bridge::RecordingFacts facts = find_facts(log, out);
  const BusRecording recording = read_bus_log(log);
  if (recording.frames.empty()) throw UserError(log.string() + ": no frames");
  for (const std::string& note : facts.notes) out << note << "\n";
  for (const std::string& note : recording.notes) out << note << "\n";
  for (const std::string& fault : facts.unseen_faults) {
    out << fault << " reached the firmware by ways that the bus does not show; from its begin on "
        << "answers may differ\n";
  }
  if (facts.protocol_hash != firmware::protocol::kProtocolHash) {
    out << "recorded with another message dictionary (" << std::hex << facts.protocol_hash
        << ", here " << firmware::protocol::kProtocolHash << std::dec << ")\n";
  }
  ReplayOptions options;
  options.to_tick = request.to_tick;
  options.at_tick = [](const firmware::app::ControlLoop&) { hoof_replay_at_tick(); };
  options.after_tick = [&out](const firmware::app::ControlLoop& loop) { print_state(loop, out); };
  const ReplayResult result = replay(recording, facts, options);
  out << "fed " << result.fed << " frames, compared " << result.compared << " answers up to tick "
      << result.last_tick << "\n";
  if (result.difference) {
    throw Differs("first difference: " + result.difference->text(recording.interfaces));
  }
  if (request.to_tick && !result.stopped) {
    throw UserError("--to-tick " + std::to_string(*request.to_tick) +
                    ": the recording ends with tick " + std::to_string(result.last_tick));
  }
  out << "same as recorded; answers sha256 " << result.answers_sha256 << "\n";
}

}  // namespace hoof::tools
