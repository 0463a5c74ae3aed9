// Can the press model's own parameters be found again from its own data with noise?
#include <ceres/ceres.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tools/diagnose/press_data.h"

namespace hoof::tests {
namespace {

using tools::ActiveEffect;
using tools::DataSet;
using tools::PressModel;

/// Residuals over their noise, then the doubts about the setup over theirs.
class Misfit {
 public:
  Misfit(const PressModel& model, std::vector<ActiveEffect> effects, double force_noise_N,
         double position_noise_m)
      : model_(model),
        effects_(std::move(effects)),
        force_noise_N_(force_noise_N),
        position_noise_m_(position_noise_m) {}

  int residuals() const {
    int count = static_cast<int>(model_.doubtful().size());
    for (int i = 0; i < model_.recordings(); ++i) {
      count += static_cast<int>(model_.recording(i).time_s.size());
    }
    return count;
  }

  int parameters() const {
    auto count = model_.doubtful().size();
    for (const auto& effect : effects_) count += effect.values.size();
    return static_cast<int>(count);
  }

  bool operator()(double const* const* blocks, double* residual) const {
    const double* next = blocks[0];
    std::vector<double> setup;
    for (const auto& doubt : model_.doubtful()) {
      setup.push_back(doubt.value + doubt.sigma * *next);
      *residual++ = *next++;
    }
    auto effects = effects_;
    for (auto& effect : effects) {
      for (std::size_t i = 0; i < effect.values.size(); ++i) {
        effect.values[i] = effect.info->parameters[i].typical * *next++;
      }
    }
    for (int i = 0; i < model_.recordings(); ++i) {
      const std::string& channel = model_.channels(i)[0];
      const auto predicted = model_.predict(i, setup, effects, tools::Rollout::kFree)[0];
      const auto& measured = model_.recording(i).channels.at(channel);
      const double sigma = channel == "force" ? force_noise_N_ : position_noise_m_;
      for (std::size_t j = 0; j < predicted.size(); ++j) {
        *residual++ = std::isnan(predicted[j]) ? 0.0 : (predicted[j] - measured[j]) / sigma;
      }
    }
    return true;
  }

 private:
  const PressModel& model_;
  std::vector<ActiveEffect> effects_;
  double force_noise_N_, position_noise_m_;
};

struct Fit {
  std::vector<double> value, deviation;  // in units of sigma and of typical
  double cost = 0;                       // sum of squares over 2
  int samples = 0;
};

Fit fit(const PressModel& model, const std::vector<ActiveEffect>& effects, double force_noise_N,
        double position_noise_m) {
  auto* misfit = new Misfit(model, effects, force_noise_N, position_noise_m);
  ceres::NumericDiffOptions steps;
  steps.relative_step_size = 1e-5;
  auto* cost =
      new ceres::DynamicNumericDiffCostFunction<Misfit>(misfit, ceres::TAKE_OWNERSHIP, steps);
  const int parameters = misfit->parameters();
  cost->AddParameterBlock(parameters);
  cost->SetNumResiduals(misfit->residuals());
  Fit result;
  result.samples = misfit->residuals();
  result.value.assign(model.doubtful().size(), 0.1);
  for (const auto& effect : effects) {
    for (std::size_t i = 0; i < effect.values.size(); ++i) {
      result.value.push_back(effect.values[i] / effect.info->parameters[i].typical);
    }
  }
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, result.value.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  result.cost = summary.final_cost;
  ceres::Covariance covariance({});
  REQUIRE(covariance.Compute({result.value.data()}, &problem));
  std::vector<double> matrix(static_cast<std::size_t>(parameters * parameters));
  covariance.GetCovarianceBlock(result.value.data(), result.value.data(), matrix.data());
  for (int i = 0; i < parameters; ++i) {
    result.deviation.push_back(std::sqrt(matrix[static_cast<std::size_t>(i * (parameters + 1))]));
  }
  return result;
}

std::vector<PressPlan> rich_plans() {
  return {{.name = "a.csv", .diameter_m = 0.06, .speed_m_s = 0.002, .back_m = 0.01},
          {.name = "b.csv", .diameter_m = 0.10, .speed_m_s = 0.008, .back_m = 0.01},
          {.name = "c.csv", .diameter_m = 0.04, .speed_m_s = 0.004, .back_m = 0.02},
          {.name = "d.csv", .diameter_m = 0.15, .deepest_m = 0.02, .speed_m_s = 0.002}};
}

struct Hidden {
  std::string name;
  std::vector<double> truth, start;
};

TEST_CASE("each effect is found again from noisy presses, within its interval") {
  const std::vector<Hidden> cases = {
      {"rig_compliance", {1.5e-5}, {5e-6}},
      {"plate_size_law", {-0.25}, {0.1}},
      {"rate_dependence", {25}, {5}},
      {"cohesion", {2500}, {500}},
      {"wall_confinement", {4}, {1}},
      {"hard_layer", {0.013, 2.2}, {0.01, 1.5}},
      {"packing_change", {0.07}, {0.01}},
      {"packing_change", {-0.07}, {0.01}},
      {"unload_hysteresis", {4}, {2}},
      {"unlisted_force_offset", {1.2, -0.3}, {0.1, 0.1}},
      {"unlisted_bearing_limit", {2e-6}, {5e-7}},
      {"unlisted_crust", {4000, 0.004}, {500, 0.006}},
      {"unlisted_force_wave", {0.1, 0.008, 0.6}, {0.05, 0.0085, 0.4}},
      {"unlisted_side_friction", {4e5}, {1e5}},
      {"unlisted_surface_offset", {7e-4}, {1e-4}},
      {"unlisted_rig_settling", {4e-4, 12}, {2e-4, 20}},
      {"unlisted_relaxation", {0.15, 2}, {0.05, 1}}};
  std::uint64_t seed = 40;
  for (const Hidden& hidden : cases) {
    ++seed;
    std::vector<DataSet> sets = {sand_set(rich_plans())};
    // Another soil than stated: half a sigma and more away.
    const std::vector<double> soil = {8e3, 4.2e6, 1.22};
    const double noise_N = 0.4;
    simulate_into(sets, soil, {active(hidden.name, hidden.truth)}, noise_N, 0, seed);
    const PressModel model(sets);
    const Fit with = fit(model, {active(hidden.name, hidden.start)}, noise_N, 1);
    const Fit without = fit(model, {}, noise_N, 1);
    INFO(hidden.name << ", noise seed " << seed);
    // 2 cost is chi-squared with as many degrees: within five deviations.
    CHECK(2 * with.cost == Approx(with.samples).margin(5 * std::sqrt(2.0 * with.samples)));
    CHECK(without.cost > with.cost + 50);
    const auto& info = *sim::find_effect(hidden.name);
    for (std::size_t i = 0; i < hidden.truth.size(); ++i) {
      const double typical = info.parameters[i].typical;
      const double value = with.value[3 + i] * typical;
      const double deviation = with.deviation[3 + i] * typical;
      INFO(info.parameters[i].name << " = " << value << " +- " << deviation << ", truth "
                                   << hidden.truth[i]);
      // Sixteen cases of up to three numbers: 3.5 deviations would fail once in 80 such runs.
      CHECK(std::abs(value - hidden.truth[i]) < 3.5 * deviation);
      CHECK(deviation < 0.25 * std::max(std::abs(hidden.truth[i]), 0.1 * typical));
    }
    const std::vector<double> sigma = {2e4, 3e6, 0.3}, value = {0, 3e6, 1.1};
    for (std::size_t i = 0; i < soil.size(); ++i) {
      INFO(model.doubtful()[i].name << " " << with.value[i] << " +- " << with.deviation[i]);
      CHECK(std::abs(value[i] + sigma[i] * with.value[i] - soil[i]) <
            3.5 * sigma[i] * with.deviation[i]);
    }
  }
}

TEST_CASE("a block tells the rig's compliance that sand alone hardly tells") {
  std::vector<DataSet> sets = {sand_set({{.name = "a.csv"}, {.name = "b.csv", .diameter_m = 0.05}}),
                               block_set(250)};
  const std::vector<double> soil = {0, 4.2e6, 1.22};
  simulate_into(sets, soil, {active("rig_compliance", {1e-5})}, 0.4, 5e-6, 7);
  const PressModel alone({sets[0]}), both(sets);
  const auto start = active("rig_compliance", {3e-6});
  const Fit sand = fit(alone, {start}, 0.4, 5e-6);
  const Fit rig = fit(both, {start}, 0.4, 5e-6);
  INFO("noise seed 7");
  CHECK(rig.deviation[3] < 0.2 * sand.deviation[3]);
  // The height of contact comes from a tenth of the samples, which the interval does not count.
  CHECK(std::abs(rig.value[3] - 1) < 6 * rig.deviation[3]);
  CHECK(rig.deviation[3] < 0.02);
}

TEST_CASE("cycles in one recording: packing and unloading are told apart") {
  std::vector<DataSet> sets = {
      sand_set({{.name = "a.csv", .speed_m_s = 0.006, .cycles = 5}, {.name = "b.csv"}})};
  const std::vector<double> soil = {0, 4.2e6, 1.22};
  simulate_into(sets, soil, {active("packing_change", {0.05}), active("unload_hysteresis", {7})},
                0.5, 0, 9);
  const PressModel model(sets);
  const Fit both =
      fit(model, {active("packing_change", {0.01}), active("unload_hysteresis", {3})}, 0.5, 1);
  INFO("noise seed 9");
  CHECK(std::abs(both.value[3] * 0.05 - 0.05) < 3.5 * both.deviation[3] * 0.05);
  CHECK(std::abs(both.value[4] * 5 - 7) < 3.5 * both.deviation[4] * 5);
}

}  // namespace
}  // namespace hoof::tests
