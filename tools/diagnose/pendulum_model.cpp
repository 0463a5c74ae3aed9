#include "tools/diagnose/pendulum_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/diagnose/noise.h"
#include "tools/diagnose/pendulum_keys.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

using sim::JointEffect;
using sim::PendulumLaw;
using sim::PendulumSettings;

/// Where no control period is stated the law is evaluated at every step of this length: a servo's
/// loop closes at a few Hz, so that a hundred steps go into a radian of its phase.
constexpr double kFreeStep_s = 1e-3;
constexpr double kLongestStep_s = 1e-3;

/// Whether a key changes what is predicted. The torque constant does under every law but the
/// recorded torque's: it makes the current of a commanded torque.
bool used(const PendulumKey& key, DriveLaw law) {
  if (std::string_view(key.name) == "supply_voltage") return law == DriveLaw::kDuty;
  if (std::string_view(key.name) == "kt") return law != DriveLaw::kTorque;
  const bool of_a_law = key.duty || key.impedance;
  return !of_a_law || (key.duty && law == DriveLaw::kDuty) ||
         (key.impedance && law == DriveLaw::kImpedance);
}

/// What nobody stated is not zero but unknown: half a normal distribution of this width, a share of
/// what the payload makes.
double unstated_sigma(std::string_view key, const PendulumSettings& s) {
  const double torque = s.gravity_m_s2 * s.payload_mass_kg * s.payload_length_m;
  if (key == "coulomb") return 0.1 * torque;
  if (key == "viscous") return 0.02 * torque;
  if (key == "arm_mass") return 0.1 * s.payload_mass_kg;
  if (key == "armature") {
    return 0.2 * s.payload_mass_kg * s.payload_length_m * s.payload_length_m;
  }
  return 0;
}

PendulumSettings read_settings(const DataSet& data_set, const Recording& recording) {
  PendulumSettings settings;
  const Setup& setup = recording.setup;
  const std::string where = data_set.file.string() + ": [setup]";
  settings.law = setup.law == DriveLaw::kDuty        ? PendulumLaw::kDuty
                 : setup.law == DriveLaw::kImpedance ? PendulumLaw::kImpedance
                                                     : PendulumLaw::kTorque;
  for (const PendulumKey& key : kPendulumKeys) {
    const SetupValue* value = setup.find(key.name);
    if (value) {
      settings.*key.member = value->value;
    } else if (key.needed_by_all || (key.duty && setup.law == DriveLaw::kDuty) ||
               (key.impedance && setup.law == DriveLaw::kImpedance)) {
      throw UserError(where + " lacks " + key.name + ", which " + recording.name + " needs");
    }
  }
  const bool supply = recording.has("supply_voltage") || setup.find("supply_voltage");
  if (settings.law == PendulumLaw::kDuty && !supply) {
    throw UserError(where + " lacks supply_voltage, and " + recording.name +
                    " has no such channel");
  }
  return settings;
}

/// Missing samples of an input filled by the last one before: a drive holds what it has.
void fill_gaps(std::vector<double>& values) {
  double last = 0;
  for (const double v : values) {
    if (std::isfinite(v)) {
      last = v;
      break;
    }
  }
  for (double& v : values) v = last = std::isfinite(v) ? v : last;
}

bool is_input(const std::string& name, DriveLaw law) {
  return name == "position_goal" || name == "velocity_goal" || name == "torque_ff" ||
         name == "enable" || name == "supply_voltage" ||
         (name == "torque" && law == DriveLaw::kTorque);
}

}  // namespace

PendulumModel::PendulumModel(std::vector<DataSet> data_sets) : data_sets_(std::move(data_sets)) {
  for (DataSet& data_set : data_sets_) {
    for (Recording& recording : data_set.recordings) {
      for (auto& [name, values] : recording.channels) {
        if (is_input(name, recording.setup.law)) fill_gaps(values);
        if (name == "torque" && recording.setup.law == DriveLaw::kTorque) {
          input_noise_Nm_[&recording] = estimate_noise(recording.time_s, values);
          for (const std::size_t span : kSmoothingSpans) {
            smoothed_Nm_[&recording].push_back(without_noise(recording.time_s, values, span));
          }
          values = smoothed_Nm_[&recording][kUsualSmoothing];
        }
      }
    }
  }
  for (const DataSet& data_set : data_sets_) {
    for (const Recording& recording : data_set.recordings) add(data_set, recording);
  }
  doubt_losses();
  choose_effects();
  measure_effort();
}

void PendulumModel::add(const DataSet& data_set, const Recording& recording) {
  Run run;
  run.data_set = &data_set;
  run.recording = &recording;
  run.settings = read_settings(data_set, recording);
  const DriveLaw law = recording.setup.law;
  const std::string needed = law == DriveLaw::kTorque ? "torque" : "position_goal";
  for (const std::string& name : {needed, std::string("position")}) {
    if (!recording.has(name)) {
      throw UserError(data_set.file.string() + ": recording " + recording.name +
                      " lacks the channel " + name + ", which the rig servo_pendulum needs");
    }
  }
  run.inputs.time_s = recording.time_s;
  run.inputs.position_goal_rad = recording.values("position_goal");
  run.inputs.velocity_goal_rad_s = recording.values("velocity_goal");
  run.inputs.torque_ff_Nm = recording.values("torque_ff");
  run.inputs.enable = recording.values("enable");
  run.inputs.supply_V = recording.values("supply_voltage");
  if (law == DriveLaw::kTorque) run.inputs.torque_Nm = recording.values("torque");
  run.inputs.position_rad = recording.values("position");
  run.goal_bends = goal_bends(recording);
  for (const char* name : {"position", "velocity", "torque", "current"}) {
    if (recording.has(name) && !is_input(name, law)) run.channels.push_back(name);
  }
  // Current of a recording driven by torque is that torque over kt: nothing to predict.
  if (law == DriveLaw::kTorque || run.settings.kt_Nm_A <= 0) std::erase(run.channels, "current");
  run.longest_step_s = run.settings.control_period_s > 0 ? kLongestStep_s : kFreeStep_s;
  add_doubts(run);
  choose_correction(run);
  estimate_start(run);
  add_timing(run);
  add_start_speed(run);
  add_smoothing(run);
  // Of an experiment to come the noise is not known yet: as in the recordings that were made.
  if (recording.planned && !runs_.empty()) run.correction = runs_.front().correction;
  look_for_losses(run);
  runs_.push_back(std::move(run));
}

void PendulumModel::add_doubts(Run& run) {
  for (const PendulumKey& key : kPendulumKeys) {
    const SetupValue* stated = run.recording->setup.find(key.name);
    const SetupValue guess{0, stated ? 0 : unstated_sigma(key.name, run.settings)};
    const SetupValue* value = stated || guess.sigma <= 0 ? stated : &guess;
    if (!value || value->sigma <= 0 || !used(key, run.recording->setup.law)) continue;
    const bool channel =
        std::string_view(key.name) == "supply_voltage" && run.recording->has("supply_voltage");
    const bool unseen = std::string_view(key.name) == "kt" &&
                        run.settings.law == PendulumLaw::kImpedance && !run.predicts("current");
    if (channel || unseen) continue;
    // The same key with the same numbers is the same thing; an override is this recording's own.
    const SetupValue* shared = run.data_set->setup.find(key.name);
    const bool own =
        stated && (!shared || shared->value != value->value || shared->sigma != value->sigma);
    const std::string name = own ? std::string(key.name) + "@" + run.recording->name : key.name;
    DoubtfulValue doubt{name, value->value, value->sigma, 0};
    if (own) doubt.recording = static_cast<int>(runs_.size());
    doubt.stated = stated != nullptr;
    run.doubts[key.name] = shared_doubt(doubt);
  }
}

int PendulumModel::shared_doubt(const DoubtfulValue& doubt) {
  const auto there =
      std::find_if(doubtful_.begin(), doubtful_.end(),
                   [&doubt](const DoubtfulValue& d) { return d.name == doubt.name; });
  if (there != doubtful_.end()) return static_cast<int>(there - doubtful_.begin());
  doubtful_.push_back(doubt);
  return static_cast<int>(doubtful_.size()) - 1;
}

PendulumSettings PendulumModel::settings(const Run& run, std::span<const double> setup) const {
  PendulumSettings settings = run.settings;
  for (const PendulumKey& key : kPendulumKeys) {
    const auto doubt = run.doubts.find(key.name);
    if (doubt != run.doubts.end()) settings.*key.member = setup[doubt->second];
  }
  if (run.timing >= 0) settings.input_late_s = setup[run.timing];
  if (run.switch_timing >= 0) settings.switch_late_s = setup[run.switch_timing];
  settings.resistance_ohm = std::max(settings.resistance_ohm, 1e-6);
  return settings;
}

/// Stationary Kalman gain for noise in the torque that drives an open loop. A closed loop needs
/// none: it draws the state to the goal by itself.
void PendulumModel::choose_correction(Run& run) const {
  if (run.settings.law != PendulumLaw::kTorque) return;
  const Recording& recording = *run.recording;
  const auto& t = recording.time_s;
  const double dt = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  const PendulumSettings& s = run.settings;
  const double J = s.link_inertia_kg_m2() + s.armature_kg_m2;
  double position = stated_noise(*run.data_set, "position");
  if (position <= 0) position = estimate_noise(t, recording.values("position"));
  double torque = stated_noise(*run.data_set, "torque");
  // Of the torque as recorded: smoothed it has less, and as much where it drives the joint.
  if (torque <= 0) torque = input_noise_Nm_.at(&recording);
  if (position <= 0 || torque <= 0 || J <= 0) return;
  Eigen::Matrix2d A;
  A << 1, dt, -s.gravity_torque_Nm() * dt / J, 1 - s.viscous_Nm_s_rad * dt / J;
  Eigen::Matrix2d Q = Eigen::Matrix2d::Zero();
  Q(1, 1) = torque * dt / J * torque * dt / J;
  Q(0, 0) = Q(1, 1) * dt * dt / 4;
  Eigen::Matrix2d P = Eigen::Matrix2d::Identity();
  Eigen::Vector2d gain = Eigen::Vector2d::Zero();
  for (int i = 0; i < 2000; ++i) {
    P = A * P * A.transpose() + Q;
    gain = P.col(0) / (P(0, 0) + position * position);
    run.wander_rad = std::sqrt(P(0, 0));
    run.wander_rad_s = std::sqrt(P(1, 1));
    P -= gain * P.row(0);
  }
  run.correction = {gain[0], gain[1]};
}

double PendulumModel::stated_noise(const DataSet& data_set, const std::string& channel) {
  const auto found = data_set.noise.find(channel);
  return found == data_set.noise.end() ? 0 : found->second;
}

double PendulumModel::stated_noise(int index, const std::string& channel) const {
  return stated_noise(*runs_[index].data_set, channel);
}

double PendulumModel::input_noise(int index, const std::string& channel) const {
  const Run& run = runs_[index];
  return channel == "position" ? run.wander_rad : channel == "velocity" ? run.wander_rad_s : 0;
}

void PendulumModel::choose_effects() {
  bool goals = false, sags = false;
  for (const Run& run : runs_) {
    goals = goals || run.settings.law != PendulumLaw::kTorque;
    sags = sags || (run.settings.law == PendulumLaw::kDuty && run.inputs.supply_V.empty());
  }
  for (const sim::EffectInfo& effect : sim::effect_catalogue()) {
    if (!effect.make_joint) continue;
    std::vector<double> values;
    for (const sim::EffectParameter& p : effect.parameters) values.push_back(p.typical);
    const unsigned stages = effect.make_joint(values)->stages();
    if ((stages & sim::kGoalStage) && !goals) continue;
    if ((stages & sim::kSupplyStage) && !sags) continue;
    effects_.push_back(&effect);
  }
}

/// Effects of heat are scaled by the rms of the effort over all data; where it was not recorded the
/// nominal model's stands for it.
void PendulumModel::measure_effort() {
  double sum = 0, count = 0;
  std::vector<double> setup;
  for (const DoubtfulValue& doubt : doubtful_) setup.push_back(doubt.value);
  for (Run& run : runs_) {
    if (run.recording->planned) continue;
    std::vector<double> effort;
    double scale = 1;
    for (const char* name : {"torque", "current"}) {
      const auto recorded = run.recording->values(name);
      if (!effort.empty() || recorded.empty()) continue;
      effort.assign(recorded.begin(), recorded.end());
      if (std::string_view(name) == "current") scale = run.settings.kt_Nm_A;
    }
    if (effort.empty()) {
      sim::PendulumTrace trace;
      simulate_pendulum(settings(run, setup), run.inputs, {}, run.start, {}, run.longest_step_s,
                        trace);
      effort = trace.torque_Nm;
    }
    for (const double v : effort) {
      if (!std::isfinite(v)) continue;
      sum += scale * scale * v * v, count += 1;
      torque_peak_Nm_ = std::max(torque_peak_Nm_, std::abs(scale * v));
    }
  }
  torque_rms_Nm_ = count > 0 ? std::sqrt(sum / count) : 0;
  for (Run& run : runs_) {
    const double kt = run.settings.kt_Nm_A;
    for (sim::PendulumStart* start : {&run.start, &run.fitted_start}) {
      start->torque_rms_Nm = torque_rms_Nm_;
      start->current_rms_A = kt > 0 ? torque_rms_Nm_ / kt : 0;
    }
  }
}

std::vector<double> PendulumModel::strength(int index, std::span<const double> setup,
                                            std::span<const ActiveEffect> effects) const {
  const Run& run = runs_[index];
  sim::PendulumTrace trace;
  simulate(run, setup, effects, Rollout::kCorrected, trace);
  for (const double v : trace.effect_Nm) {
    if (v > 0) return trace.effect_Nm;
  }
  return {};
}

double PendulumModel::unit_of(const sim::EffectParameter& parameter) const {
  if (!parameter.unit.starts_with("Nm")) return 1;
  const bool peak = parameter.name == "ceiling";
  const double scale = peak ? torque_peak_Nm_ : torque_rms_Nm_;
  return scale > 0 ? scale : 1;
}

void PendulumModel::simulate(const Run& run, std::span<const double> setup,
                             std::span<const ActiveEffect> active, Rollout rollout,
                             sim::PendulumTrace& trace) const {
  std::vector<std::unique_ptr<JointEffect>> owned;
  std::vector<JointEffect*> effects;
  sim::PendulumInputs inputs = run.inputs;
  inputs.position_goal_bend_rad_s = run.goal_bends.position;
  inputs.velocity_goal_bend_rad_s2 = run.goal_bends.velocity;
  inputs.torque_ff_bend_Nm_s = run.goal_bends.torque;
  for (const ActiveEffect& effect : active) {
    if (effect.info->name == "frame_loss" && run.losses) {
      // Which goals were lost stands in the recording; drawing them anew would tell nothing.
      inputs.lost = run.losses->lost;
      continue;
    }
    owned.push_back(effect.info->make_joint(effect.values));
    effects.push_back(owned.back().get());
  }
  std::vector<double> torque_Nm;
  if (run.smoothing >= 0) {
    torque_Nm = smoothed_torque_Nm(run, setup[run.smoothing]);
    inputs.torque_Nm = torque_Nm;
  }
  const bool fitted = rollout == Rollout::kCorrected;
  sim::PendulumStart start = fitted ? run.fitted_start : run.start;
  if (fitted && run.start_speed >= 0) start.velocity_rad_s = setup[run.start_speed];
  simulate_pendulum(settings(run, setup), inputs, effects, start,
                    fitted ? run.correction : sim::PendulumCorrection{}, run.longest_step_s, trace);
}

Prediction PendulumModel::predict(int index, std::span<const double> setup,
                                  std::span<const ActiveEffect> active, Rollout rollout) const {
  const Run& run = runs_[index];
  sim::PendulumTrace trace;
  simulate(run, setup, active, rollout, trace);
  Prediction prediction;
  for (const std::string& name : run.channels) {
    prediction.push_back(name == "position"   ? std::move(trace.position_rad)
                         : name == "velocity" ? std::move(trace.velocity_rad_s)
                         : name == "torque"   ? std::move(trace.torque_Nm)
                                              : std::move(trace.current_A));
  }
  return prediction;
}

}  // namespace hoof::tools
