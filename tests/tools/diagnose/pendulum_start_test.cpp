// What a recording does not tell of its own beginning, of its switches and of its torque constant:
// doubtful numbers of the pendulum's model, that are fitted and are no physics.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tools/diagnose/fitter.h"
#include "tools/diagnose/pendulum_model.h"
#include "tools/diagnose/search_start.h"

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

TEST_CASE("pendulum: while a drive turns off it is on, then off, and never half on") {
  // Lifted and held by more than friction: half a torque would hold it, none lets it fall. The
  // later it is turned off, the later it falls, by just that.
  DataSet set = blank(6);
  auto& channels = set.recordings[0].channels;
  for (int i = 0; i < kSamples; ++i) {
    channels["position_goal"][i] = 0.3;
    channels["enable"].push_back(i < 330 ? 1 : 0);
  }
  const PendulumModel plant({set});
  std::vector<double> setup = stated(plant);
  setup[doubt(plant, "viscous")] = 0;  // what is left is a fall that begins
  const int timing = doubt(plant, "switch_timing@run.csv");
  std::vector<double> angles;
  for (const double late_ms : {-1.2, -0.9, -0.6, -0.3, 0.0, 0.3, 0.6, 0.9, 1.2}) {
    setup[timing] = late_ms * 1e-3;
    angles.push_back(plant.predict(0, setup, {}, Rollout::kFree)[0][350]);
  }
  REQUIRE(angles.front() < 0.25);
  const double each = (angles.back() - angles.front()) / 8;
  CHECK(each > 1e-4);
  for (std::size_t i = 1; i < angles.size(); ++i) {
    // A fall that speeds up by a fiftieth from one to the next; a step that is cut has its own
    // error.
    CHECK(angles[i] - angles[i - 1] == Approx(each).epsilon(0.1));
  }
}

TEST_CASE("pendulum: the speed of a recording that begins in motion is fitted") {
  // A soft drive: what it begins with is forgotten in a second or so.
  for (const double speed : {1.5, -2.5}) {
    CAPTURE(speed);
    DataSet set = blank(0.8);
    auto& recording = set.recordings[0];
    for (int i = 0; i < kSamples; ++i) {
      recording.channels["position_goal"][i] = 0.4 * std::sin(5 * kSample_s * i);
      // What the estimate sees first is the motion itself.
      recording.channels["position"][i] = speed * kSample_s * i;
    }
    const PendulumModel plant({set});
    std::vector<double> setup = stated(plant);
    const int start = doubt(plant, "start_speed@run.csv");
    setup[start] = speed;
    std::mt19937_64 random(41);
    std::normal_distribution<double> normal;
    const Prediction p = plant.predict(0, setup, {}, Rollout::kCorrected);
    for (int i = 0; i < kSamples; ++i) {
      recording.channels["position"][i] = p[0][i] + kPositionNoise_rad * normal(random);
      recording.channels["torque"][i] = p[1][i] + kTorqueNoise_Nm * normal(random);
    }
    const PendulumModel model({set});
    const Fitter fitter(model);
    const Fit fit = fitted(fitter);
    // Noise over the slope of the swing that follows leaves a few thousandths.
    const int fitted_start = doubt(model, "start_speed@run.csv");
    CHECK(Layout(model, {}).setup_value(fitted_start, fit.x[fitted_start]) ==
          Approx(speed).margin(0.02));
    CHECK(rms_of(fitter, fit, "position") < 1.1 * kPositionNoise_rad);
    CHECK(model.doubtful()[fitted_start].recording == 0);
  }
}

TEST_CASE("pendulum: a column of one recording's own number is as if all were predicted anew") {
  DataSet set = blank(6);
  auto& enable = set.recordings[0].channels["enable"];
  for (int i = 0; i < kSamples; ++i) enable.push_back(i < 330 ? 1 : 0);
  const PendulumModel plant({set});
  record(set, plant, stated(plant), 51);
  Recording other = set.recordings[0];
  other.name = "other.csv";
  set.recordings.push_back(other);
  const PendulumModel model({set});
  const Fitter fitter(model);
  const Layout layout(model, {});
  const Fitter::Weights weights = fitter.weights();
  const Eigen::VectorXd x = layout.stated();
  const Eigen::VectorXd r = fitter.residuals(layout, x, weights);
  const Eigen::MatrixXd J = fitter.jacobian(layout, x, r, weights);
  for (int i = 0; i < layout.size(); ++i) {
    CAPTURE(model.doubtful()[i].name);
    Eigen::VectorXd shifted = x;
    shifted[i] += layout.step(i);
    const Eigen::VectorXd whole = (fitter.residuals(layout, shifted, weights) - r) / layout.step(i);
    CHECK((whole - J.col(i)).lpNorm<Eigen::Infinity>() == 0);
    if (i == doubt(model, "coulomb") || i == doubt(model, "switch_timing@other.csv")) {
      CHECK(J.col(i).squaredNorm() > 2);  // the prior alone makes one
    }
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

TEST_CASE("pendulum: a slow motion that hides in the noise of a few samples is no rest") {
  // A fifth of what the noise is, per sample: a dozen of them look like one angle.
  const double speed = GENERATE(0.2, -0.2);
  std::mt19937_64 random(77);
  std::normal_distribution<double> normal;
  DataSet set = blank(120);
  auto& recording = set.recordings[0];
  for (int i = 0; i < kSamples; ++i) {
    const double q = speed * kSample_s * i;
    recording.channels["position_goal"][i] = q;
    recording.channels["position"][i] = q + 10 * kPositionNoise_rad * normal(random);
  }
  const PendulumModel model({set});
  const int start = doubt(model, "start_speed@run.csv");
  // Of 20 samples; the path is fitted over 45 at most.
  const double told = 10 * kPositionNoise_rad * std::sqrt(12 / 20.0) / (20 * kSample_s);
  CHECK(model.doubtful()[start].value == Approx(speed).margin(4 * told));
}

TEST_CASE("pendulum: noise of a recorded torque is smoothed as the recording asks, not by a lag") {
  // A third of the torque is the recorder's noise, at every sample; the motor never had it.
  for (const std::uint64_t seed : {61, 62}) {
    CAPTURE(seed);
    DataSet set = blank(6);
    set.setup.law = set.recordings[0].setup.law = DriveLaw::kTorque;
    auto& channels = set.recordings[0].channels;
    channels.erase("position_goal");
    for (int i = 0; i < kSamples; ++i) {
      const double t = kSample_s * i;
      channels["torque"][i] = 0.5 * std::sin(2.2 * t) + 0.25 * std::sin(7 * t + 1);
    }
    const PendulumModel plant({set});
    std::vector<double> setup = stated(plant);
    setup[doubt(plant, "torque_smoothing")] = 0;  // as it was
    channels["position"] = plant.predict(0, setup, {}, Rollout::kFree)[0];
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (int i = 0; i < kSamples; ++i) {
      channels["position"][i] += kPositionNoise_rad * normal(random);
      channels["torque"][i] += 0.15 * normal(random);
    }
    const PendulumModel model({set});
    const Fitter fitter(model);
    const Fit fit = fitted(fitter);
    const int smoothing = doubt(model, "torque_smoothing");
    CHECK(Layout(model, {}).setup_value(smoothing, fit.x[smoothing]) > 1);
    // What a lag gains beside it, in log likelihood, by smoothing what is left.
    const auto lags = [&model](const std::string& name) {
      for (const sim::EffectInfo* e : model.effects()) {
        if (e->name == name) return e;
      }
      throw std::runtime_error("no " + name);
    };
    const Effects lag = {lags("actuator_lag")};
    const auto gain = [&](double at) {
      const auto weights = fitter.weights();
      Eigen::VectorXd x = Layout(model, lag).stated();
      x.head(fit.x.size()) = fit.x;
      const auto objective = [&](double time_constant_s) {
        x[smoothing] = at;
        x[x.size() - 1] = std::log(time_constant_s);
        return fitter.objective(lag, x, weights);
      };
      return objective(1e-5) - std::min({objective(0.003), objective(0.006), objective(0.012)});
    };
    // Smoothed over nine samples, as it was once for all recordings, a lag would be found.
    const double usual = gain(0), fitted_gain = gain(fit.x[smoothing]);
    CHECK(usual > 50);
    CHECK(fitted_gain < 0.2 * usual);
  }
}

TEST_CASE("search: both phases of cogging are one linear step") {
  for (const double phase : {0.7, -2.4}) {
    CAPTURE(phase);
    DataSet set = blank(6);
    const PendulumModel plant({set});
    const sim::EffectInfo* cogging = nullptr;
    for (const sim::EffectInfo* e : plant.effects()) {
      if (e->name == "cogging_torque") cogging = e;
    }
    REQUIRE(cogging);
    constexpr double kAmplitude_Nm = 0.01;
    const ActiveEffect hidden{cogging, {kAmplitude_Nm, 9, phase}};
    const Prediction p = plant.predict(0, stated(plant), {&hidden, 1}, Rollout::kFree);
    std::mt19937_64 random(71);
    std::normal_distribution<double> normal;
    for (int i = 0; i < kSamples; ++i) {
      set.recordings[0].channels["position"][i] = p[0][i] + kPositionNoise_rad * normal(random);
      set.recordings[0].channels["torque"][i] = p[1][i] + kTorqueNoise_Nm * normal(random);
    }
    const PendulumModel model({set});
    const Fitter fitter(model);
    Fit base;
    base.x = Layout(model, {}).stated();
    base.squares = fitter.squares(base);
    const auto weights = fitter.roomy_weights(base.squares, 0.3);
    const auto starts =
        starts_beside(fitter, base, tangent(fitter, base, weights), cogging, weights);
    REQUIRE(!starts.empty());
    const Layout layout(model, {cogging});
    const int at = layout.setup_count();
    CHECK(layout.effect_value(1, starts[0].x[at + 1]) == 9);
    // Linear: a torque so small moves the joint in proportion but where it sticks.
    CHECK(layout.effect_value(0, starts[0].x[at]) == Approx(kAmplitude_Nm).epsilon(0.25));
    CHECK(std::abs(std::remainder(starts[0].x[at + 2] - phase, 2 * M_PI)) < 0.25);
  }
}
