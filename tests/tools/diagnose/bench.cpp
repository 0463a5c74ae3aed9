#include "tests/tools/diagnose/bench.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tools/run/csv_writer.h"
#include "tools/run/output_file.h"

namespace hoof::tests {
namespace {

using namespace hoof::tools;

constexpr double kMass_kg = 0.5, kLength_m = 0.15, kGravity_m_s2 = 9.81, kLimit_Nm = 6;
constexpr double kCoulomb_Nm = 0.05, kViscous = 0.02, kInertia = 0.5 * 0.15 * 0.15 + 0.002;

/// Two sines, then a ramp there and back, then steps or quick moves.
double goal_at(double time_s, double length_s, double factor, double move_s) {
  const double third_s = length_s / 3;
  if (time_s < third_s) {
    return 0.7 * std::sin(4 * factor * time_s) + 0.3 * std::sin(9 * factor * time_s);
  }
  if (time_s < 2 * third_s) {
    const double share = (time_s - third_s) / third_s;
    return 1.2 * (1 - std::abs(2 * share - 1));
  }
  constexpr double kEvery_s = 0.7;
  const double since_s = time_s - 2 * third_s;
  const int moves = int(since_s / kEvery_s);
  const double from = moves == 0 ? 0 : moves % 2 == 0 ? -0.4 : 0.6;
  const double to = moves % 2 == 0 ? 0.6 : -0.4;
  const double moved_s = since_s - moves * kEvery_s;
  return moved_s >= move_s ? to : from + (to - from) * moved_s / move_s;
}

}  // namespace

DataSet pendulum_bench(const PendulumBench& bench) {
  std::mt19937_64 random(bench.seed);
  std::normal_distribution<double> normal;
  DataSet set;
  set.file = "bench.toml";
  set.name = "bench";
  set.rig = RigKind::kServoPendulum;
  set.setup.law = DriveLaw::kImpedance;
  set.setup.values = {{"payload_mass", {kMass_kg, 0}},
                      {"payload_length", {kLength_m, 0}},
                      {"arm_mass", {0, 0}},
                      {"armature", {0.002, 0.001}},
                      {"coulomb", {kCoulomb_Nm, 0.03}},
                      {"viscous", {kViscous, 0.02}},
                      {"gravity", {kGravity_m_s2, 0}},
                      {"kp", {bench.kp, 0}},
                      {"kd", {bench.kd, 0}},
                      {"torque_limit", {kLimit_Nm, 0}}};
  Recording r;
  r.name = "run.csv";
  r.path = "run.csv";
  r.setup = set.setup;
  const double dt_s = 1e-4;
  const int every = int(std::lround(bench.step_s / dt_s));
  double q = 0, w = 0;
  for (int i = 0; i * dt_s < bench.length_s; ++i) {
    const double goal = goal_at(i * dt_s, bench.length_s, bench.speed_factor, bench.move_s);
    const double torque = std::clamp(bench.kp * (goal - q) - bench.kd * w, -kLimit_Nm, kLimit_Nm);
    if (i % every == 0) {
      double seen = q + bench.position_noise * normal(random);
      const double step = bench.encoder_step_rad;
      if (step > 0) seen = step * std::round(seen / step);
      r.time_s.push_back(i * dt_s);
      r.channels["position_goal"].push_back(goal);
      r.channels["position"].push_back(seen);
      r.channels["velocity"].push_back(w + bench.velocity_noise * normal(random));
      r.channels["torque"].push_back(torque + bench.torque_noise * normal(random));
    }
    const double free = torque - kMass_kg * kGravity_m_s2 * kLength_m * std::sin(q) - kViscous * w;
    const double before = w;
    w += dt_s * (free - kCoulomb_Nm * (w > 0 ? 1 : w < 0 ? -1 : 0)) / kInertia;
    if (before * w <= 0 && std::abs(free) <= kCoulomb_Nm) w = 0;
    q += dt_s * w;
  }
  set.recordings = {r};
  return set;
}

std::filesystem::path write_bench(const DataSet& set, const std::filesystem::path& folder) {
  const auto number = [](double value) { return format_number(value); };
  std::string toml =
      "format = 1\nname = \"" + set.name + "\"\nrig = \"" + rig_name(set.rig) + "\"\n\n[setup]\n";
  if (set.setup.law == DriveLaw::kImpedance) toml += "law = \"impedance\"\n";
  for (const auto& [key, v] : set.setup.values) {
    toml += key + " = { value = " + number(v.value) + ", sigma = " + number(v.sigma) + " }\n";
  }
  for (const Recording& r : set.recordings) {
    toml += "\n[[recording]]\ndata = \"" + r.name + "\"\nrole = \"" +
            (r.holdout ? "holdout" : "fit") + "\"\n[recording.channels]\ntime = \"time\"\n";
    std::string csv = "time";
    for (const auto& [channel, values] : r.channels) {
      toml += channel + " = \"" + channel + "\"\n";
      csv += "," + channel;
    }
    for (std::size_t i = 0; i < r.time_s.size(); ++i) {
      csv += "\n" + number(r.time_s[i]);
      for (const auto& [channel, values] : r.channels) csv += "," + number(values[i]);
    }
    write_file(folder / r.name, csv + "\n");
  }
  write_file(folder / "bench.toml", toml);
  return folder / "bench.toml";
}

DataSet sand_bench(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  DataSet set;
  set.file = "sand.toml";
  set.name = "sand";
  set.rig = RigKind::kPlateSand;
  set.setup.values = {{"width", {0.05, 0}},  {"length", {0.1, 0}},  {"surface_height", {0.01, 0}},
                      {"k_c", {1000, 1000}}, {"k_phi", {1e6, 3e5}}, {"n", {1.1, 0.2}}};
  Recording r;
  r.name = "press.csv";
  r.path = "press.csv";
  r.setup = set.setup;
  for (int i = 0; i < 800; ++i) {
    const double time_s = 0.02 * i;
    const double share = 1 - std::abs(time_s / 8 - 1);  // down for 8 s, up for 8 s
    const double position_m = 0.02 - 0.04 * share;
    const double depth_m = std::max(0.0, 0.01 - position_m);
    const double force_N = 0.05 * 0.1 * (1000 / 0.05 + 1e6) * std::pow(depth_m, 1.1);
    r.time_s.push_back(time_s);
    r.channels["position"].push_back(position_m + 2e-5 * normal(random));
    r.channels["force"].push_back(force_N + 0.3 * normal(random));
  }
  set.recordings = {r};
  return set;
}

}  // namespace hoof::tests
