#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tools/conceal/servo_case.h"

namespace hoof::tools::conceal {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

std::string column_of(const std::string& channel, bool own_names) {
  if (!own_names) return channel;
  if (channel == "time") return "t_s";
  if (channel == "position_goal") return "goal_rad";
  if (channel == "velocity_goal") return "goal_rad_s";
  if (channel == "torque_ff") return "feed_Nm";
  if (channel == "enable") return "on";
  if (channel == "supply_voltage") return "supply_V";
  if (channel == "position") return "pos_rad";
  if (channel == "velocity") return "vel_rad_s";
  if (channel == "current") return "current_A";
  if (channel == "torque") return "torque_Nm";
  return channel == "temperature" ? "temp_C" : channel;
}

class Recorder {
 public:
  Recorder(const ServoPlan& plan, std::size_t index, const ServoSignals& clean, RandomStream random)
      : plan_(plan), exercise_(plan.exercises[index]), clean_(clean), random_(random) {
    out_.file = plan.files[index];
    out_.holdout = plan.holdout[index];
  }

  RecordingData record() {
    std::vector<double> times = exercise_.times_s;
    for (double& t : times) t += plan_.first_time_s;
    add("time", times, 10);
    const bool torque_law = plan_.machine.law == DriveLaw::kTorque;
    if (!torque_law) add("position_goal", clean_.position_goal, 9);
    if (exercise_.velocity_goal) add("velocity_goal", clean_.velocity_goal, 9);
    if (plan_.torque_ff) add("torque_ff", clean_.torque_ff, 9);
    if (std::isfinite(exercise_.disable_at_s)) add("enable", clean_.enable, 9);
    if (torque_law) add("torque", noisy(clean_.torque, input_torque_sigma()), 7);
    if (plan_.supply_channel) add("supply_voltage", supply(), 5);
    for (const ChannelNoise& c : plan_.predicted) add_predicted(c);
    if (plan_.temperature) add("temperature", temperature(), 4);
    return out_;
  }

 private:
  void add(const std::string& channel, const std::vector<double>& values, int digits) {
    RecordedChannel c{channel, column_of(channel, plan_.own_names), values};
    c.digits = digits;
    if (plan_.degrees && (channel == "position" || channel == "position_goal")) {
      c.column = channel == "position" ? "pos_deg" : "goal_deg";
      c.scale = kDegree;
    }
    out_.channels.push_back(c);
  }

  void add_predicted(const ChannelNoise& c) {
    const bool encoder = c.channel == "position" && exercise_.encoder_step_rad > 0.0;
    std::vector<double> values = encoder ? clean_.*c.signal : noisy(clean_.*c.signal, c.sigma);
    for (double& v : values) {
      if (random_.chance(plan_.missing_share)) v = kMissing;
    }
    add(c.channel, values, 8);
  }

  std::vector<double> noisy(std::vector<double> values, double sigma) {
    for (double& v : values) v += sigma * random_.normal();
    return values;
  }

  /// Where the torque is the input its noise is the recorder's: the motor had the clean one.
  double input_torque_sigma() const {
    double sum = 0.0;
    for (const double v : clean_.torque) sum += v * v;
    return std::sqrt(sum / double(clean_.torque.size())) *
           std::pow(10.0, -plan_.effort_snr_db / 20.0);
  }

  std::vector<double> supply() {
    std::vector<double> values = noisy(clean_.supply_voltage, 0.01);
    for (double& v : values) v = 0.01 * std::round(v / 0.01);
    return values;
  }

  /// Whole degrees of a housing that warms as any does; says nothing of the winding.
  std::vector<double> temperature() {
    const double from = random_.uniform(22.0, 32.0), rise = random_.uniform(0.5, 4.0);
    std::vector<double> values;
    for (const double t_s : exercise_.times_s) {
      values.push_back(std::round(from + rise * (1.0 - std::exp(-t_s / 20.0))));
    }
    return values;
  }

  const ServoPlan& plan_;
  const ServoExercise& exercise_;
  const ServoSignals& clean_;
  RandomStream random_;
  RecordingData out_;
};

const char* law_name(DriveLaw law) {
  switch (law) {
    case DriveLaw::kImpedance:
      return "impedance";
    case DriveLaw::kDuty:
      return "duty";
    default:
      return "torque";
  }
}

std::vector<SetupEntry> setup_of(const ServoPlan& plan) {
  const ServoMachine& m = plan.machine;
  std::vector<SetupEntry> setup = {{"law", 0, 0, law_name(m.law)},
                                   {"control_period", m.control_period_s},
                                   {"gravity", m.gravity_m_s2},
                                   {"payload_length", m.payload_length_m}};
  for (const DoubtfulParameter& d : plan.doubts) setup.push_back({d.key, d.believed, d.sigma});
  // What is not doubtful is known; left out it would be unknown.
  const std::pair<const char*, double> known[] = {{"payload_mass", m.payload_mass_kg},
                                                  {"coulomb", m.coulomb_Nm},
                                                  {"viscous", m.viscous_Nms_rad}};
  for (const auto& [key, value] : known) {
    const bool doubtful = std::any_of(plan.doubts.begin(), plan.doubts.end(),
                                      [key = key](const auto& d) { return d.key == key; });
    if (!doubtful) setup.push_back({key, value});
  }
  if (m.law == DriveLaw::kImpedance) {
    setup.push_back({"kd", m.kd_Nms_rad});
    setup.push_back({"torque_limit", m.torque_limit_Nm});
  } else if (m.law == DriveLaw::kDuty) {
    setup.push_back({"counts_per_rad", m.counts_per_rad});
    setup.push_back({"supply_voltage", m.supply_V});
  }
  return setup;
}

/// The gain, once where all recordings have the same, else with each recording.
void set_gains(const ServoPlan& plan, CaseData& data) {
  if (plan.machine.law == DriveLaw::kTorque) return;
  const std::string key = plan.machine.law == DriveLaw::kDuty ? "kp_duty" : "kp";
  bool same = true;
  for (const ServoExercise& e : plan.exercises) same = same && e.gain == plan.exercises[0].gain;
  if (same) data.setup.push_back({key, plan.exercises[0].gain});
  for (std::size_t i = 0; i < plan.exercises.size() && !same; ++i) {
    data.recordings[i].setup.push_back({key, plan.exercises[i].gain});
  }
}

}  // namespace

CaseData record_servo(const std::string& name, const ServoPlan& plan,
                      const std::vector<ServoSignals>& clean, RandomStream random) {
  CaseData data;
  data.name = name;
  data.rig = "servo_pendulum";
  data.setup = setup_of(plan);
  for (std::size_t i = 0; i < plan.exercises.size(); ++i) {
    data.recordings.push_back(Recorder(plan, i, clean[i], random.branch(i)).record());
  }
  set_gains(plan, data);
  if (plan.noise_given) {
    for (const ChannelNoise& c : plan.predicted) data.noise.push_back({c.channel, c.sigma});
  }
  return data;
}

}  // namespace hoof::tools::conceal
