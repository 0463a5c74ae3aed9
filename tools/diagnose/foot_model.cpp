#include "tools/diagnose/foot_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/protocol/dictionary.h"
#include "tools/diagnose/noise.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

namespace protocol = firmware::protocol;

/// Position, velocity, torque in a reply.
const protocol::Signal& reply_signal(const std::string& channel) {
  constexpr std::size_t kFirst = 1;  // after the drive's number
  const auto& names = FootSignals::channel_names();
  const auto at = std::size_t(std::find(names.begin(), names.end(), channel) - names.begin());
  return protocol::kReplySignals[at / 3][kFirst + at % 3];
}

bool of_a_drive(const std::string& channel) {
  return channel != "depth" && !channel.starts_with("ground_");
}

bool moves(const std::vector<double>& values) {
  double first = std::numeric_limits<double>::quiet_NaN();
  for (const double v : values) {
    if (std::isnan(first)) first = v;
    if (v != first && std::isfinite(v)) return true;
  }
  return false;
}

/// Depth of a gait is the foot's own height, which no bench measures.
bool compared(const FootSession& session, const std::string& channel) {
  if (channel == "depth" && !session.run.is_sinkage()) return false;
  return moves(session.signals.channel(channel));
}

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

}  // namespace

FootModel::FootModel(const std::vector<DataSet>& data_sets) {
  for (const DataSet& data_set : data_sets) {
    for (const Recording& recording : data_set.recordings) add(data_set, recording);
  }
  choose_effects();
}

void FootModel::add(const DataSet& data_set, const Recording& recording) {
  Run run;
  run.recording = recording;
  run.session = read_foot_session(recording.path);
  run.recording.time_s = run.session.signals.time_s();
  for (const std::string& name : FootSignals::channel_names()) {
    if (!compared(run.session, name)) continue;
    run.channels.push_back(name);
    run.recording.channels[name] = run.session.signals.channel(name);
  }
  if (run.recording.time_s.size() < 2 || run.channels.empty()) {
    throw UserError(recording.path.string() + ": too short, or nothing was told on its bus");
  }
  take_setup(data_set, run);
  runs_.push_back(std::move(run));
}

void FootModel::take_setup(const DataSet& data_set, Run& run) {
  RunSettings& settings = run.session.run;
  for (const auto& [key, stated] : run.recording.setup.values) {
    double* number = find_setup_number(settings, key);
    if (number == nullptr) continue;  // of another session's plant
    *number = stated.value;
    if (stated.sigma <= 0) continue;
    const SetupValue* shared = data_set.setup.find(key);
    const bool own = !shared || shared->value != stated.value || shared->sigma != stated.sigma;
    add_doubt(run, key, own ? key + "@" + run.recording.name : key, stated.value, stated.sigma);
  }
  const std::string stiffness = "soil_stiffness";
  const sim::Measured& fitted = settings.rft.xi_n_N_m3;
  const bool stated = run.recording.setup.find(stiffness) != nullptr;
  if (settings.terrain == "rft" && !stated && fitted.sigma > 0) {
    add_doubt(run, stiffness, stiffness, fitted.value, fitted.sigma);
  }
}

void FootModel::add_doubt(Run& run, const std::string& key, const std::string& name, double value,
                          double sigma) {
  int index = 0;
  while (index < static_cast<int>(doubtful_.size()) && doubtful_[index].name != name) ++index;
  if (index == static_cast<int>(doubtful_.size())) {
    const auto& known = setup_numbers();
    const auto bounds = std::find_if(known.begin(), known.end(),
                                     [&key](const SetupNumber& n) { return n.name == key; });
    doubtful_.push_back({name, value, sigma, bounds->low});
  }
  run.doubts[key] = index;
}

void FootModel::choose_effects() {
  std::array<double, sim::kJointCount> torque_rms_Nm{};
  for (int j = 0; j < sim::kJointCount; ++j) {
    const std::string name = std::string(sim::joint_name(sim::Joint(j))) + "_torque";
    for (const Run& run : runs_) {
      const auto found = run.recording.channels.find(name);
      if (found == run.recording.channels.end()) continue;
      std::vector<double> there = found->second;
      std::erase_if(there, [](double v) { return !std::isfinite(v); });
      torque_rms_Nm[j] = std::max(torque_rms_Nm[j], rms(there));
    }
  }
  for (const Run& run : runs_) effects_.add_all(run.session.run, torque_rms_Nm);
}

double FootModel::stated_noise(int, const std::string& channel) const {
  return of_a_drive(channel) ? double(reply_signal(channel).scale) / std::sqrt(12.0) : 0;
}

Prediction FootModel::predict(int index, std::span<const double> setup,
                              std::span<const ActiveEffect> effects, Rollout) const {
  const Run& run = runs_[index];
  const auto& known = effects_.list();
  PredictionKey key;
  key.add(index);
  for (const double value : setup) key.add(value);
  for (const ActiveEffect& effect : effects) {
    const auto at = std::find(known.begin(), known.end(), effect.info);
    // One that a file names, at a joint that only it knows.
    if (at == known.end()) return replay(run, setup, effects);
    key.add(static_cast<int>(at - known.begin()));
    for (const double value : effect.values) key.add(value);
  }
  return cache_.get(key, [&] { return replay(run, setup, effects); });
}

Prediction FootModel::replay(const Run& run, std::span<const double> setup,
                             std::span<const ActiveEffect> effects) const {
  RunSettings settings = run.session.run;
  for (const auto& [key, doubt] : run.doubts) *find_setup_number(settings, key) = setup[doubt];
  for (const ActiveEffect& effect : effects) {
    RunEffect added{effect.info, effect.values, effects_.joint(effect)};
    if (misfit(settings, added).empty()) settings.effects.push_back(std::move(added));
  }
  const FootSignals told = replay_session(settings, run.session.script);
  Prediction prediction;
  for (const std::string& name : run.channels) prediction.push_back(told.channel(name));
  return prediction;
}

std::vector<RigModel::Condition> FootModel::conditions(int index) const {
  const Recording& recording = runs_[index].recording;
  std::vector<Condition> list = {{"always", std::vector<bool>(recording.time_s.size(), true)}};
  const auto add = [&](const std::string& text, const std::vector<double>& values, auto test) {
    Condition c{text, {}};
    for (const double v : values) c.holds.push_back(std::isfinite(v) && test(v));
    list.push_back(std::move(c));
  };
  for (const std::string& name : runs_[index].channels) {
    const auto& values = recording.channels.at(name);
    double top = 0;
    for (const double v : values) top = std::isfinite(v) ? std::max(top, std::abs(v)) : top;
    const double low = 0.15 * top, much = 0.5 * top;
    add("|" + name + "| < " + short_text(low), values,
        [low](double v) { return std::abs(v) < low; });
    add("|" + name + "| > " + short_text(much), values,
        [much](double v) { return std::abs(v) > much; });
    add(name + " > 0", values, [](double v) { return v > 0; });
    add(name + " < 0", values, [](double v) { return v < 0; });
  }
  return list;
}

}  // namespace hoof::tools
