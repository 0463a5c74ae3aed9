// What a recording does not tell of its own beginning, of its switches and of its torque constant:
// doubtful numbers of the pendulum's model, that are fitted and are no physics.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tools/diagnose/fitter.h"
#include "tools/diagnose/pendulum_model.h"

using namespace hoof;
using namespace hoof::tools;

namespace {

constexpr double kPositionNoise_rad = 0.0005;
constexpr double kTorqueNoise_Nm = 0.01;
constexpr int kSamples = 1200;
constexpr double kSample_s = 0.005;

DataSet blank(double kp_Nm_rad) {
  DataSet set;
  set.file = "made";
  set.name = "made";
  set.setup.law = DriveLaw::kImpedance;
  set.setup.values = {{"payload_mass", {0.5, 0}},     {"payload_length", {0.15, 0}},
                      {"arm_mass", {0.06, 0.02}},     {"armature", {0.004, 0.001}},
                      {"coulomb", {0.06, 0.02}},      {"viscous", {0.02, 0.008}},
                      {"control_period", {0.001, 0}}, {"kp", {kp_Nm_rad, 0}},
                      {"kd", {0.04 * kp_Nm_rad, 0}},  {"torque_limit", {4, 0}}};
  Recording recording;
  recording.name = "run.csv";
  recording.setup = set.setup;
  for (int i = 0; i < kSamples; ++i) {
    const double t = kSample_s * i;
    recording.time_s.push_back(t);
    // At rest for a second, then a swing.
    recording.channels["position_goal"].push_back(t < 1 ? 0 : 0.9 * std::sin(2 * (t - 1)));
  }
  recording.channels["position"].assign(kSamples, 0);
  recording.channels["torque"].assign(kSamples, 0);
  set.recordings.push_back(std::move(recording));
  return set;
}

std::vector<double> stated(const PendulumModel& model) {
  std::vector<double> setup;
  for (const DoubtfulValue& d : model.doubtful()) setup.push_back(d.value);
  return setup;
}

int doubt(const PendulumModel& model, const std::string& name) {
  const auto& all = model.doubtful();
  const auto at = std::find_if(all.begin(), all.end(),
                               [&name](const DoubtfulValue& d) { return d.name == name; });
  REQUIRE(at != all.end());
  return static_cast<int>(at - all.begin());
}

/// Puts what the model predicts for `setup`, with noise, into the recording.
void record(DataSet& set, const PendulumModel& plant, const std::vector<double>& setup,
            std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Prediction p = plant.predict(0, setup, {}, Rollout::kFree);
  auto& channels = set.recordings[0].channels;
  for (std::size_t c = 0; c < plant.channels(0).size(); ++c) {
    const std::string& name = plant.channels(0)[c];
    const double noise = name == "position" ? kPositionNoise_rad : kTorqueNoise_Nm;
    for (std::size_t i = 0; i < p[c].size(); ++i)
      channels[name][i] = p[c][i] + noise * normal(random);
  }
}

Fit fitted(const Fitter& fitter) {
  Fit fit;
  fit.x = Layout(fitter.model(), {}).stated();
  for (const double share : {0.5, 0.15}) {
    fit = fitter.fit({}, fit.x, 6, fitter.roomy_weights(fitter.squares(fit), share));
  }
  fit = fitter.fit({}, fit.x, 20, fitter.weights());
  fit.squares = fitter.squares(fit);
  return fit;
}

double rms_of(const Fitter& fitter, const Fit& fit, const std::string& channel) {
  for (std::size_t g = 0; g < fitter.groups().size(); ++g) {
    const Group& group = fitter.groups()[g];
    if (fitter.model().channels(group.recording)[group.channel] == channel) {
      return std::sqrt(fit.squares[g] / group.samples);
    }
  }
  return -1;
}

}  // namespace

TEST_CASE("pendulum: when a drive is turned off between two samples is fitted") {
  for (const double late_s : {0.0012, -0.0012}) {
    CAPTURE(late_s);
    DataSet set = blank(6);
    auto& enable = set.recordings[0].channels["enable"];
    // Off while it is lifted and moving: the swing that follows remembers when.
    for (int i = 0; i < kSamples; ++i) enable.push_back(i < 330 ? 1 : 0);
    const PendulumModel plant({set});
    std::vector<double> setup = stated(plant);
    const int timing = doubt(plant, "switch_timing@run.csv");
    setup[timing] = late_s;
    record(set, plant, setup, 21);
    const PendulumModel model({set});
    const Fitter fitter(model);
    const Fit fit = fitted(fitter);
    // Noise over the slope that the swing has there leaves a tenth of a millisecond; twice that.
    CHECK(Layout(model, {}).setup_value(timing, fit.x[timing]) == Approx(late_s).margin(2e-4));
    CHECK(rms_of(fitter, fit, "position") < 1.1 * kPositionNoise_rad);
    // And it matters: in the middle of the two samples it would be off by more than the noise.
    Fit middle = fit;
    middle.x[timing] = 0;
    middle.squares = fitter.squares(middle);
    CHECK(rms_of(fitter, middle, "position") > 2 * kPositionNoise_rad);
  }
}

TEST_CASE("pendulum: a torque constant that is off makes a current, and no misfit") {
  for (const double wrong : {0.75, 1.3}) {
    CAPTURE(wrong);
    DataSet set = blank(6);
    set.recordings[0].channels["current"].assign(kSamples, 0);
    const auto state = [&set](double kt, double sigma) {
      set.setup.values["kt"] = {kt, sigma};
      set.recordings[0].setup.values["kt"] = {kt, sigma};
    };
    state(0.8, 0.25);
    const PendulumModel plant({set});
    record(set, plant, stated(plant), 22);
    state(0.8 * wrong, 0.25);
    const PendulumModel model({set});
    const Fitter fitter(model);
    const Fit fit = fitted(fitter);
    const int kt = doubt(model, "kt");
    CHECK(Layout(model, {}).setup_value(kt, fit.x[kt]) == Approx(0.8).epsilon(0.02));
    CHECK(rms_of(fitter, fit, "current") < 1.1 * kTorqueNoise_Nm);
  }
}

TEST_CASE("pendulum: a current of a drive whose torque constant nobody states is not compared") {
  DataSet set = blank(6);
  set.recordings[0].channels["current"].assign(kSamples, 1);
  const PendulumModel model({set});
  for (const std::string& name : model.channels(0)) CHECK(name != "current");
}

TEST_CASE("pendulum: a joint that begins at rest begins where all its first samples say") {
  // One sample's noise would be an offset of kp times that, 0.06 Nm, for as long as it sticks.
  for (const std::uint64_t seed : {31, 32, 33, 34}) {
    CAPTURE(seed);
    DataSet set = blank(120);
    set.recordings[0].channels["position"].assign(kSamples, 0.0002);
    const PendulumModel plant({set});
    record(set, plant, stated(plant), seed);
    const PendulumModel model({set});
    const Prediction p = model.predict(0, stated(model), {}, Rollout::kCorrected);
    double offset = 0;
    for (std::size_t i = 10; i < 150; ++i) {
      offset += (set.recordings[0].channels["torque"][i] - p[1][i]) / 140;
    }
    // 200 torques and angles tell it to 0.01 Nm / sqrt(200); five of those.
    CHECK(std::abs(offset) < 5 * kTorqueNoise_Nm / std::sqrt(200.0));
  }
}
