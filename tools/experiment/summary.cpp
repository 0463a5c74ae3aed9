#include "tools/experiment/summary.h"

#include <algorithm>
#include <cstdio>

#include "firmware/protocol/protocol_hash.h"
#include "sim/experiments/resolution.h"
#include "tools/experiment/bench.h"
#include "tools/experiment/foot_plan.h"
#include "tools/experiment/run_bus.h"
#include "tools/run/sha256.h"
#include "tools/run/version.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

Json by_joint(const RunSettings& run, const std::array<double, sim::kJointCount>& values) {
  Json j = Json::object();
  for (int i = 0; i < sim::kJointCount; ++i) {
    if (run.drives[i]) j[sim::joint_name(sim::Joint(i))] = values[i];
  }
  return j;
}

Json by_bus(const std::array<double, bridge::kBusCount>& values) {
  Json j = Json::object();
  for (int bus = 0; bus < bridge::kBusCount; ++bus) {
    // A SocketCAN interface does not tell its load.
    j["can" + std::to_string(bus)] = values[bus] < 0 ? Json(nullptr) : Json(values[bus]);
  }
  return j;
}

Json resolution(const RunSettings& run, double sinkage_m) {
  const Eigen::Vector2d print = foot_plan_m(run.foot, run.toe_rad()).sizes();
  const sim::Resolution r =
      sim::assess_resolution(run.bed, run.foot.geometry, print.x(), print.y(), sinkage_m);
  Json j = Json::object();
  j["d50_m"] = run.bed.d50_m();
  if (r.spine_pitch_over_d50) j["spine_pitch_over_d50"] = *r.spine_pitch_over_d50;
  if (r.sole_width_over_d50) j["sole_width_over_d50"] = *r.sole_width_over_d50;
  j["sinkage_over_d50"] = r.sinkage_over_d50;
  j["box_length_over_foot"] = r.box_length_over_foot;
  j["box_width_over_foot"] = r.box_width_over_foot;
  j["bed_depth_over_foot_width"] = r.bed_depth_over_foot_width;
  j["claims_refused"] = r.claims_refused;
  return j;
}

std::string hex(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

Json ground(const RunSettings& run, const sim::Experiment& experiment) {
  Json j = Json::object();
  j["terrain"] = run.terrain;
  if (run.terrain == "rft") {
    j["soil"] = run.rft.name;
    j["soil_hash"] = hex(run.rft.hash());
    j["fitted_to"] = run.rft.fitted_to;
    j["fit_error_ratio"] = run.rft.fit_error;
    j["held_out_error_ratio"] = run.rft.held_out_error;
  }
  const sim::SandBed* sand = find_sand(experiment.plant().terrain());
  if (sand == nullptr) return j;
  const sim::BedHealth health = sand->health();
  j["bed"] = run.bed.name;
  j["seed"] = run.seed;
  j["grains"] = sand->grain_count();
  j["bed_steps"] = health.steps;
  j["list_rebuilds"] = health.rebuilds;
  j["deepest_overlap_ratio"] = health.deepest_boundary_ratio;
  j["state_hash"] = hex(sand->state_hash());
  return j;
}

Json seconds(const std::optional<double>& time_s) {
  return time_s ? Json(*time_s) : Json(nullptr);
}

Json faults(const bridge::SessionResult& session) {
  Json j = Json::object();
  for (const bridge::FaultOutcome& fault : session.faults) {
    j[fault.name] = {{"began_s", seconds(fault.began_s)},
                     {"ended_s", seconds(fault.ended_s)},
                     {"changed", fault.changed}};
  }
  return j;
}

Json reaction(const bridge::SessionResult& session) {
  const bridge::Reaction& r = *session.reaction;
  // Of the fault that began last before the firmware told one: those before it were borne.
  std::optional<double> cause_s, until_safe_s;
  for (const bridge::FaultOutcome& fault : session.faults) {
    const bool before = fault.began_s && (!r.tripped_s || *fault.began_s <= *r.tripped_s);
    if (before && (!cause_s || *fault.began_s > *cause_s)) cause_s = fault.began_s;
  }
  if (cause_s && r.safe_s) until_safe_s = std::max(0.0, *r.safe_s - *cause_s);
  return {{"faults", bridge::fault_bit_names(r.faults)},
          {"ended_by", session.ended_by},
          {"tripped_s", seconds(r.tripped_s)},
          {"safe_s", seconds(r.safe_s)},
          {"from_fault_to_safe_s", seconds(until_safe_s)},
          {"reset_s", seconds(r.reset_s)},
          {"mode", r.mode}};
}

Json firmware_identity(const RunSettings& run) {
  char hash[11];
  std::snprintf(hash, sizeof hash, "0x%08x", firmware::protocol::kProtocolHash);
  if (!run.image.empty()) {
    return {{"runs_on", run.in_qemu() ? "STM32F405 in QEMU" : "emulated STM32F405"},
            {"sha256", sha256_hex_of_file(run.image)},
            {"protocol_hash", hash}};
  }
  // Elsewhere on the bus; it has told that it speaks the same dictionary, and no more.
  if (run.bus != kInProcess) return {{"runs_on", run.bus}, {"protocol_hash", hash}};
  // The host firmware is part of this program, so the program's bytes are the firmware's.
  return {{"runs_on", "host"},
          {"sha256", sha256_hex_of_file("/proc/self/exe")},
          {"protocol_hash", hash}};
}

}  // namespace

void print_faults(const Json& result) {
  if (!result.contains("reaction")) return;
  const auto time_of = [](const Json& values, const char* key) {
    char text[32] = "never";
    const Json& time_s = values[key];
    if (!time_s.is_null()) std::snprintf(text, sizeof text, "%.3f s", time_s.get<double>());
    return std::string(text);
  };
  for (const auto& [name, fault] : result["faults"].items()) {
    std::printf("%s: from %s to %s, changed %s\n", name.c_str(), time_of(fault, "began_s").c_str(),
                fault["ended_s"].is_null() ? "the end" : time_of(fault, "ended_s").c_str(),
                fault["changed"].dump().c_str());
  }
  const Json& r = result["reaction"];
  const auto time = [&](const char* key) { return time_of(r, key); };
  const auto bits = r["faults"].get<std::string>();
  if (bits.empty()) {
    std::printf("firmware: no fault; mode %s\n", r["mode"].get<std::string>().c_str());
    return;
  }
  std::printf("firmware: %s at %s; no drive pushes from %s on; reset worked: %s; mode %s\n",
              bits.c_str(), time("tripped_s").c_str(), time("safe_s").c_str(),
              time("reset_s").c_str(), r["mode"].get<std::string>().c_str());
}

std::string soil_line(const RunSettings& run) {
  char text[300];
  std::snprintf(text, sizeof text,
                "fast soil '%s' (%s), fitted to %s: off its pushes by %.0f %%, off those held "
                "out by %.0f %%",
                run.rft.name.c_str(), hex(run.rft.hash()).c_str(), run.rft.fitted_to.c_str(),
                100 * run.rft.fit_error, 100 * run.rft.held_out_error);
  return text;
}

TractionPeaks find_peaks(const std::vector<ForceSample>& forces) {
  TractionPeaks peaks;
  const int n = int(forces.size()), half = TractionPeaks::kPeakWindow_ticks / 2;
  for (int i = half; i + half < n; ++i) {
    double fx = 0, fz = 0;
    for (int k = i - half; k <= i + half; ++k) fx += forces[k].fx_N, fz += forces[k].fz_N;
    fx /= TractionPeaks::kPeakWindow_ticks, fz /= TractionPeaks::kPeakWindow_ticks;
    peaks.fz_peak_N = std::max(peaks.fz_peak_N, fz);
    if (fx > peaks.fx_peak_N) {
      peaks.fx_peak_N = fx;
      peaks.fz_at_fx_peak_N = fz;
      peaks.fx_peak_time_s = forces[i].time_s;
    }
  }
  return peaks;
}

Json summarise(const RunSettings& run, const sim::Experiment& experiment,
               const bridge::SessionResult& session, const Recorder& recorder) {
  Json j;
  j["experiment"] = run.kind;
  j["foot"] = run.foot_name;
  j["frames"] = session.frames;
  j["ticks"] = session.ticks;
  double depth = 0;
  if (const auto* sinkage = dynamic_cast<const sim::Sinkage*>(&experiment)) {
    depth = sinkage->max_depth_m();
    j["load_N"] = run.sinkage.load_N;
    j["max_depth_m"] = depth;
    j["final_depth_m"] = sinkage->final_depth_m();
    j["max_sole_depth_m"] = sinkage->max_sole_depth_m();
    j["rested"] = sinkage->rested();
  } else if (const auto* traction = dynamic_cast<const sim::Traction*>(&experiment)) {
    depth = traction->max_depth_m();
    const TractionPeaks peaks = find_peaks(recorder.forces());
    j["max_depth_m"] = depth;
    j["final_depth_m"] = std::max(0.0, -experiment.plant().rig().foot_position_m().z());
    j["fx_peak_N"] = peaks.fx_peak_N;
    j["fz_at_fx_peak_N"] = peaks.fz_at_fx_peak_N;
    const double coefficient = peaks.traction_coefficient();
    j["traction_coefficient"] = std::isfinite(coefficient) ? Json(coefficient) : Json(nullptr);
    j["fz_peak_N"] = peaks.fz_peak_N;
    j["fx_peak_time_s"] = peaks.fx_peak_time_s;
    j["ellipse_error_m"] = recorder.ellipse_error_m();
  }
  if (!run.effects.empty() && !run.concealed) {
    for (const EffectText& effect : effect_texts(run)) j["effects"][effect.name] = effect.values;
  }
  if (!run.setup.empty() && !run.concealed) j["setup"] = run.setup;
  if (run.foot.has_toes) {
    j["toe_command_rad"] = session.toe_command_rad;
    if (!run.concealed) {
      j["toe_reached_rad"] = session.toe_reached_rad;
      j["toe_deflection_rad"] = session.toe_deflection_rad;
    }
  }
  if (!run.concealed) {
    j["torque_peak_Nm"] = by_joint(run, session.torque_peak_Nm);
    j["torque_limited_s"] = by_joint(run, session.torque_limited_s);
  }
  j["gate_interventions"] = session.gate_interventions;
  j["bus_load_ratio"] = by_bus(session.bus_load_ratio);
  j["worst_bus_load_ratio"] = by_bus(session.worst_bus_load_ratio);
  if (session.reaction) {
    j["faults"] = faults(session);
    j["reaction"] = reaction(session);
  }
  if (!run.concealed) {
    const sim::ExchangeEnergy energy = experiment.plant().exchange_energy();
    j["exchange_work_J"] = energy.work_by_terrain_J;
    j["exchange_error_J"] = energy.error_J();
  }
  j["ground"] = ground(run, experiment);
  if (run.on_grains()) j["resolution"] = resolution(run, depth);
  j["firmware"] = firmware_identity(run);
  j["version"] = version_json();
  return j;
}

}  // namespace hoof::tools
