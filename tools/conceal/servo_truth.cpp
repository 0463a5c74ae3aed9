#include "tools/conceal/servo_truth.h"

#include <cmath>

#include "tools/conceal/intervals.h"

namespace hoof::tools::conceal {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kHidden = 2.0;  ///< deviations of the noise: the contract's masking

const RecordedChannel* channel_of(const RecordingData& recording, const std::string& name) {
  for (const RecordedChannel& c : recording.channels) {
    if (c.channel == name) return &c;
  }
  return nullptr;
}

/// Position and velocity as measured at the first sample; the velocity, where it is no channel, by
/// a straight line through the positions of 20 ms.
ServoStart measured_start(const RecordingData& recording) {
  const std::vector<double>& t = channel_of(recording, "time")->values;
  const std::vector<double>& q = channel_of(recording, "position")->values;
  ServoStart start{true, 0.0, 0.0};
  double n = 0, st = 0, sq = 0, stt = 0, stq = 0;
  for (std::size_t i = 0; i < t.size() && (t[i] - t[0] < 0.0205 || n < 2); ++i) {
    if (!std::isfinite(q[i])) continue;
    if (n == 0) start.position_rad = q[i];
    const double at = t[i] - t[0];
    n += 1, st += at, sq += q[i], stt += at * at, stq += at * q[i];
  }
  start.velocity_rad_s = (n * stq - st * sq) / (n * stt - st * st);
  const RecordedChannel* velocity = channel_of(recording, "velocity");
  if (velocity != nullptr && std::isfinite(velocity->values[0])) {
    start.velocity_rad_s = velocity->values[0];
  }
  return start;
}

Json intervals_of(const ServoPlan& plan, const std::vector<HiddenEffect>& hidden,
                  const std::vector<ServoSignals>& signals) {
  std::vector<TimeInterval> all;
  // A pair's intervals are those of both together.
  std::vector<StrengthSeries> series(signals.size());
  for (std::size_t r = 0; r < signals.size(); ++r) {
    series[r] = {plan.files[r], plan.holdout[r], plan.exercises[r].times_s, {}};
    for (double& t : series[r].times_s) t += plan.first_time_s;
    series[r].strength.assign(series[r].times_s.size(), 0.0);
  }
  for (std::size_t e = 0; e < hidden.size(); ++e) {
    double size = 0.0, count = 0.0;
    for (const ServoSignals& s : signals) {
      for (const double v : s.influence[e]) size += v;
      count += double(s.influence[e].size());
    }
    if (size <= 0.0) return Json::array();
    for (std::size_t r = 0; r < signals.size(); ++r) {
      for (std::size_t i = 0; i < series[r].strength.size(); ++i) {
        series[r].strength[i] += signals[r].influence[e][i] * count / size;
      }
    }
  }
  std::erase_if(series, [](const StrengthSeries& s) { return s.holdout; });
  return hidden.empty() ? Json::array() : to_json(strong_intervals(series));
}

bool is_masked(const ServoPlan& plan, const SeenChange& change) {
  if (plan.machine.law == DriveLaw::kTorque) return false;
  for (const ChannelChange& c : change.channels) {
    if (c.channel == "position") return c.raw < kHidden;
  }
  return false;
}

const char* law_word(DriveLaw law) {
  return law == DriveLaw::kImpedance ? "impedance" : law == DriveLaw::kDuty ? "duty" : "torque";
}

}  // namespace

Json to_json(const HiddenEffect& effect) {
  Json parameters = Json::object();
  for (const EffectParameter& p : effect.parameters) {
    if (p.name.starts_with("_")) continue;
    Json entry = {{"value", p.value}, {"unit", p.unit}};
    if (p.period > 0.0) entry["period"] = p.period;
    if (!p.other_readings.empty()) entry["other_readings"] = p.other_readings;
    parameters[p.name] = entry;
  }
  return {{"name", effect.name}, {"listed", effect.listed}, {"parameters", parameters}};
}

Json to_json(const SeenChange& change) {
  Json channels = Json::object();
  for (const ChannelChange& c : change.channels) {
    channels[c.channel] = {{"change_over_noise", c.raw}, {"after_refit", c.after_refit}};
  }
  return channels;
}

Json servo_truth(const CaseRequest& request, const ServoPlan& plan,
                 const std::vector<HiddenEffect>& hidden, const std::vector<ServoSignals>& signals,
                 const SeenChange& change) {
  Json truth = {{"rig", "servo_pendulum"}, {"kind", request.kind}};
  truth["law"] = law_word(plan.machine.law);
  truth["effects"] = Json::array();
  for (const HiddenEffect& effect : hidden) truth["effects"].push_back(to_json(effect));
  truth["alike"] = request.alike;
  truth["effort_snr_db"] = plan.effort_snr_db;
  truth["masked"] = !hidden.empty() && is_masked(plan, change);
  truth["strength"] = change.strength;
  truth["channels"] = to_json(change);
  truth["channel"] = change.channels.empty() ? "" : change.main().channel;
  truth["fit_recordings"] = Json::array();
  for (std::size_t r = 0; r < plan.files.size(); ++r) {
    if (!plan.holdout[r]) truth["fit_recordings"].push_back(plan.files[r]);
  }
  truth["intervals"] = intervals_of(plan, hidden, signals);
  Json parameters = Json::object();
  for (const DoubtfulParameter& d : plan.doubts) parameters[d.key] = plan.machine.*d.field;
  truth["true_parameters"] = parameters;
  // Which goals will be lost nobody can know beforehand.
  bool foreseeable = true;
  for (const HiddenEffect& effect : hidden) foreseeable &= effect.name != "frame_loss";
  truth["foreseeable"] = foreseeable;
  return truth;
}

Json truth_holdout_rmse(const ServoPlan& plan, const std::vector<HiddenEffect>& hidden,
                        const CaseData& recorded) {
  std::vector<ServoSignals> rollouts(plan.exercises.size());
  for (std::size_t r = 0; r < rollouts.size(); ++r) {
    if (!plan.holdout[r]) continue;
    rollouts[r] =
        run_servo(plan.machine, hidden, plan.exercises[r], measured_start(recorded.recordings[r]));
  }
  Json out = Json::object();
  for (const ChannelNoise& c : plan.predicted) {
    double sum = 0.0, count = 0.0;
    for (std::size_t r = 0; r < rollouts.size(); ++r) {
      if (!plan.holdout[r]) continue;
      const std::vector<double>& predicted = rollouts[r].*c.signal;
      const std::vector<double>& seen = channel_of(recorded.recordings[r], c.channel)->values;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!std::isfinite(seen[i])) continue;
        sum += (seen[i] - predicted[i]) * (seen[i] - predicted[i]);
        count += 1.0;
      }
    }
    out[c.channel + "_rmse"] = std::sqrt(sum / count);
  }
  return out;
}

}  // namespace hoof::tools::conceal
