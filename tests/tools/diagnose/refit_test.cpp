// Fits anew from other setups, on closed forms with valleys that hold a least squares fit.
#include "tools/diagnose/refit.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace hoof;
using namespace hoof::tools;

namespace {

constexpr double kNoise = 0.02;

/// position = sin((20 + 6 pace) t) + 0.3 push t + 0.5 sin(60 t) sin(turn log(push)), t from 0 to 1
/// s. Another pace fits a few turns off, and another push where the last term is as large again.
class Swing final : public RigModel {
 public:
  Swing(double pace, double push, double turn) : turn_(turn) {
    effect_ = {.name = "push", .parameters = {{"strength", "m/s", 0.01, 100, 1, true, false, {1}}}};
    effects_.push_back(&effect_);
    recording_.name = "made";
    for (int i = 0; i < 200; ++i) recording_.time_s.push_back(0.005 * i);
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(0, kNoise);
    auto& position = recording_.channels["position"];
    for (const double v : positions(pace, push)) position.push_back(v + normal(random));
  }

  int recordings() const override { return 1; }
  const Recording& recording(int) const override { return recording_; }
  const std::vector<std::string>& channels(int) const override { return channels_; }
  double stated_noise(int, const std::string&) const override { return kNoise; }
  const std::vector<DoubtfulValue>& doubtful() const override { return doubtful_; }
  const std::vector<const sim::EffectInfo*>& effects() const override { return effects_; }
  Prediction predict(int, std::span<const double> setup, std::span<const ActiveEffect> effects,
                     Rollout) const override {
    return {positions(setup[0], effects.empty() ? 0 : effects[0].values[0])};
  }
  std::vector<Condition> conditions(int) const override { return {}; }

  Fit at(double pace, double push) const {
    Fit fit;
    fit.effects = effects_;
    fit.x = Eigen::Vector2d(pace, std::log(push));
    return fit;
  }

 private:
  std::vector<double> positions(double pace, double push) const {
    std::vector<double> all;
    const double turned = turn_ > 0 ? 0.5 * std::sin(turn_ * std::log(std::max(push, 1e-9))) : 0;
    for (const double t : recording_.time_s) {
      all.push_back(std::sin((20 + 6 * pace) * t) + 0.3 * push * t + turned * std::sin(60 * t));
    }
    return all;
  }

  double turn_;
  Recording recording_;
  std::vector<std::string> channels_ = {"position"};
  std::vector<DoubtfulValue> doubtful_ = {{"pace", 0, 1, -100}};
  sim::EffectInfo effect_;
  std::vector<const sim::EffectInfo*> effects_;
};

Fit stuck_at(const Fitter& fitter, const Fit& start) {
  return settle(fitter, start, 60);
}

}  // namespace

TEST_CASE("refit: a setup that lost count of the turns is found again from what was stated") {
  for (const double side : {-1.0, 1.0}) {
    const Swing swing(side * 0.15, 1, 0);
    const Fitter fitter(swing);
    const Fit stuck = stuck_at(fitter, swing.at(side * 2.8, 1.3));
    // Else nothing is shown.
    REQUIRE(std::abs(stuck.x[0] - side * 0.15) > 0.8);
    const Fit again = fit_again(fitter, stuck, 20);
    CHECK(again.objective < 0.1 * stuck.objective);
    // Noise 0.02 in 200 samples of a swing of 1: 0.0006 in its pace, of a slope: 0.01.
    CHECK(again.x[0] == Approx(side * 0.15).margin(0.003));
    CHECK(std::exp(again.x[1]) == Approx(1).margin(0.05));
  }
}

TEST_CASE("refit: a strength in the next valley is found, from the weaker and the stronger side") {
  for (const double factor : {1.25, 0.8}) {
    // One turn of the last term to a factor of 1.25.
    const Swing swing(0.1, 1, 2 * M_PI / std::log(1.25));
    const Fitter fitter(swing);
    const Fit stuck = stuck_at(fitter, swing.at(0.1, factor));
    REQUIRE(std::abs(stuck.x[1]) > 0.1);
    const Fit again = fit_again(fitter, stuck, 20);
    CHECK(again.objective < 0.9 * stuck.objective);
    // A tenth of the way to the next valley.
    CHECK(std::exp(again.x[1]) == Approx(1).margin(0.02));
  }
}

TEST_CASE("refit: what is best already stays as it is") {
  const Swing swing(0.15, 1, 0);
  const Fitter fitter(swing);
  const Fit best = settle(fitter, swing.at(0.1, 1.1), 60);
  const Fit again = fit_again(fitter, best, 20);
  CHECK(again.objective <= best.objective);
  CHECK((again.x - best.x).norm() < 1e-3);
}
