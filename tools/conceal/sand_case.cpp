#include "tools/conceal/sand_case.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tools/conceal/intervals.h"
#include "tools/conceal/sand_plan.h"
#include "tools/conceal/seen_change.h"
#include "tools/conceal/servo_truth.h"
#include "tools/run/errors.h"

namespace hoof::tools::conceal {
namespace {

using Json = nlohmann::ordered_json;
using Forces = std::vector<std::vector<double>>;

constexpr int kMostDraws = 200;
constexpr double kLeastStrength = 15.0, kLeastStrengthUnknown = 25.0, kLargestShare = 0.5;

Forces run(const SandPlan& plan, const std::vector<HiddenEffect>& hidden) {
  Forces forces;
  for (const SandPress& press : plan.presses) {
    forces.push_back(sand_force(plan.bed, hidden, press, carriage_depth(press)));
  }
  return forces;
}

Eigen::VectorXd whitened(const SandPlan& plan, const Forces& forces) {
  std::vector<double> all;
  for (const auto& force : forces) {
    for (const double f : force) all.push_back(f / plan.force_sigma_N);
  }
  return Eigen::Map<Eigen::VectorXd>(all.data(), Eigen::Index(all.size()));
}

void set_force_noise(SandPlan& plan, const Forces& clean) {
  double sum = 0.0, count = 0.0;
  for (const auto& force : clean) {
    for (const double f : force) sum += f * f;
    count += double(force.size());
  }
  plan.force_sigma_N = std::sqrt(sum / count) * std::pow(10.0, -plan.snr_db / 20.0);
}

Sensitivities sand_sensitivities(const SandPlan& plan, const std::vector<HiddenEffect>& hidden,
                                 const std::vector<HiddenEffect>& free_effects,
                                 const Eigen::VectorXd& base) {
  std::vector<Eigen::VectorXd> columns;
  std::vector<double> ridge;
  for (const DoubtfulSand& doubt : plan.doubts) {
    SandPlan other = plan;
    other.bed.*doubt.field += 0.05 * doubt.sigma;
    columns.push_back((whitened(other, run(other, hidden)) - base) / 0.05);
    ridge.push_back(1.0);
  }
  for (const HiddenEffect& effect : free_effects) {
    for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
      std::vector<HiddenEffect> other = hidden;
      for (HiddenEffect& e : other) {
        if (e.name == effect.name) e.parameters[p].value *= 1.02;
      }
      columns.push_back((whitened(plan, run(plan, other)) - base) / 0.2);
      ridge.push_back(0.0);
    }
  }
  Sensitivities out{Eigen::MatrixXd(base.size(), Eigen::Index(columns.size())),
                    Eigen::Map<Eigen::VectorXd>(ridge.data(), Eigen::Index(ridge.size()))};
  for (std::size_t i = 0; i < columns.size(); ++i) out.columns.col(Eigen::Index(i)) = columns[i];
  return out;
}

struct HiddenInSand {
  std::vector<HiddenEffect> effects;
  Forces forces;
  SeenChange together;
};

SeenChange change_without(const SandPlan& plan, const HiddenInSand& hidden,
                          const std::vector<HiddenEffect>& others) {
  const Eigen::VectorXd with = whitened(plan, hidden.forces);
  return seen_change({"force"}, with - whitened(plan, run(plan, others)),
                     sand_sensitivities(plan, hidden.effects, others, with));
}

bool hide(const CaseRequest& request, const SandPlan& plan, const RandomStream& random,
          HiddenInSand& hidden) {
  RandomStream sizes = random.branch(0);
  const double least = request.kind == "unknown" ? kLeastStrengthUnknown : kLeastStrength;
  std::vector<double> shares;
  for (std::size_t i = 0; i < request.effects.size(); ++i) {
    shares.push_back(sizes.log_uniform(0.06, 0.4));
  }
  for (int growth = 0; growth < 6; ++growth) {
    hidden = {};
    for (std::size_t i = 0; i < request.effects.size(); ++i) {
      RandomStream draw = random.branch(i + 1);
      hidden.effects.push_back(draw_sand_effect(request.effects[i], shares[i], plan, draw));
    }
    hidden.forces = run(plan, hidden.effects);
    bool seen = true;
    for (std::size_t i = 0; i < hidden.effects.size(); ++i) {
      std::vector<HiddenEffect> others = hidden.effects;
      others.erase(others.begin() + std::ptrdiff_t(i));
      if (change_without(plan, hidden, others).strength >= least) continue;
      seen = false;
      if (shares[i] >= kLargestShare) return false;
      shares[i] = std::min(kLargestShare, 1.6 * shares[i]);
    }
    if (!seen) continue;
    hidden.together = change_without(plan, hidden, {});
    return true;
  }
  return false;
}

std::string file_of(std::size_t index) {
  return "press_" + std::to_string(index + 1) + ".csv";
}

RecordedChannel channel(const SandPlan& plan, const std::string& name,
                        const std::vector<double>& values) {
  RecordedChannel c{name, name == "time" ? "t_s" : name, values};
  if (plan.millimetres && name == "position") {
    c.column = "height_mm";
    c.scale = 1e-3;
  }
  return c;
}

CaseData record(const std::string& name, const SandPlan& plan, const HiddenInSand& hidden,
                const RandomStream& random) {
  CaseData data;
  data.name = name;
  data.rig = "plate_sand";
  for (const DoubtfulSand& d : plan.doubts) data.setup.push_back({d.key, d.believed, d.sigma});
  if (plan.doubts[0].key != "k_c") data.setup.push_back({"k_c", plan.bed.k_c});
  if (plan.noise_given) data.noise.push_back({"force", plan.force_sigma_N});
  for (std::size_t r = 0; r < plan.presses.size(); ++r) {
    RandomStream noise = random.branch(r);
    const SandPress& press = plan.presses[r];
    RecordingData recording{file_of(r), plan.holdout[r]};
    recording.setup = {{"diameter", press.width_m}, {"surface_height", press.surface_height_m}};
    std::vector<double> position, force;
    for (std::size_t i = 0; i < press.times_s.size(); ++i) {
      const double height = press.start_height_m - press.travel.value(press.times_s[i]);
      position.push_back(height + plan.position_sigma_m * noise.normal());
      force.push_back(hidden.forces[r][i] + plan.force_sigma_N * noise.normal());
    }
    recording.channels = {channel(plan, "time", press.times_s), channel(plan, "position", position),
                          channel(plan, "force", force)};
    data.recordings.push_back(recording);
  }
  return data;
}

/// The same rig on a block that does not give: what it travels is the rig's own.
CaseData rigid_press(const std::string& name, const SandPlan& plan, const HiddenInSand& hidden,
                     RandomStream random) {
  double compliance = 0.0;
  for (const HiddenEffect& e : hidden.effects) {
    if (e.name == "rig_compliance") compliance = e.at("compliance");
  }
  CaseData data;
  data.name = name + "_rigid";
  data.rig = "rigid_press";
  const double most_N = largest_force_N(plan), contact_m = random.uniform(0.05, 0.1);
  for (int r = 0; r < 2; ++r) {
    RecordingData recording{"rigid_" + std::to_string(r + 1) + ".csv", r == 1};
    recording.setup = {{"diameter", plan.presses[0].width_m}, {"surface_height", contact_m}};
    std::vector<double> times, position, force;
    const double period_s = random.uniform(4.0, 7.0);
    for (double t_s = 0.0; t_s < 2.0 * period_s; t_s += 0.02) {
      const double pushed_N = most_N * std::pow(std::sin(3.14159265 * t_s / period_s), 2);
      times.push_back(t_s);
      force.push_back(pushed_N + 0.2 * plan.force_sigma_N * random.normal());
      position.push_back(contact_m - compliance * pushed_N +
                         plan.position_sigma_m * random.normal());
    }
    recording.channels = {channel(plan, "time", times), channel(plan, "position", position),
                          channel(plan, "force", force)};
    data.recordings.push_back(recording);
  }
  return data;
}

Json intervals_of(const SandPlan& plan, const HiddenInSand& hidden) {
  if (hidden.effects.empty()) return Json::array();
  const Forces without = run(plan, {});
  std::vector<StrengthSeries> series;
  for (std::size_t r = 0; r < plan.presses.size(); ++r) {
    if (plan.holdout[r]) continue;
    StrengthSeries s{file_of(r), false, plan.presses[r].times_s, {}};
    for (std::size_t i = 0; i < without[r].size(); ++i) {
      s.strength.push_back(std::abs(hidden.forces[r][i] - without[r][i]));
    }
    series.push_back(s);
  }
  return to_json(strong_intervals(series));
}

/// The truth that is told nothing but the recorded heights.
double truth_rmse(const SandPlan& plan, const HiddenInSand& hidden, const CaseData& data) {
  double sum = 0.0, count = 0.0;
  for (std::size_t r = 0; r < plan.presses.size(); ++r) {
    if (!plan.holdout[r]) continue;
    std::vector<double> depth = data.recordings[r].channels[1].values;
    for (double& z : depth) z = plan.presses[r].surface_height_m - z;
    const auto force = sand_force(plan.bed, hidden.effects, plan.presses[r], depth);
    const std::vector<double>& seen = data.recordings[r].channels[2].values;
    for (std::size_t i = 0; i < seen.size(); ++i) sum += std::pow(seen[i] - force[i], 2);
    count += double(seen.size());
  }
  return std::sqrt(sum / count);
}

Json truth_of(const CaseRequest& request, const SandPlan& plan, const HiddenInSand& hidden,
              const CaseData& data) {
  Json truth = {{"rig", "plate_sand"}, {"kind", request.kind}, {"law", "none"}};
  truth["effects"] = Json::array();
  for (HiddenEffect effect : hidden.effects) {
    // The contract gives the distance to the wall no key, so its coefficient has no scale.
    if (effect.name == "wall_confinement") effect.parameters.clear();
    truth["effects"].push_back(to_json(effect));
  }
  truth["alike"] = request.alike;
  truth["effort_snr_db"] = plan.snr_db;
  truth["masked"] = false;
  truth["strength"] = hidden.together.strength;
  truth["channels"] = to_json(hidden.together);
  truth["channel"] = hidden.effects.empty() ? "" : "force";
  truth["fit_recordings"] = Json::array();
  for (std::size_t r = 0; r < plan.presses.size(); ++r) {
    if (!plan.holdout[r]) truth["fit_recordings"].push_back(file_of(r));
  }
  truth["intervals"] = intervals_of(plan, hidden);
  truth["true_parameters"] = {{"k_c", plan.bed.k_c}, {"k_phi", plan.bed.k_phi}, {"n", plan.bed.n}};
  truth["foreseeable"] = true;
  truth["holdout_rmse"] = {{"force_rmse", truth_rmse(plan, hidden, data)}};
  return truth;
}

}  // namespace

CaseRequest sand_alike_request() {
  return {"not_decidable", {"rate_dependence"}, {"rate_dependence", "packing_change"}};
}

CaseData make_sand_case(const std::string& name, const CaseRequest& request,
                        const RandomStream& random) {
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const RandomStream stream = random.branch(std::uint64_t(draw));
    RandomStream planning = stream.branch(0);
    SandPlan plan = draw_sand_plan(request, planning);
    HiddenInSand hidden;
    hidden.forces = run(plan, {});
    set_force_noise(plan, hidden.forces);
    if (!request.effects.empty() && !hide(request, plan, stream.branch(1), hidden)) continue;
    CaseData data = record(name, plan, hidden, stream.branch(2));
    data.truth = truth_of(request, plan, hidden, data);
    if (plan.rigid_beside) {
      data.beside.push_back(rigid_press(name, plan, hidden, stream.branch(3)));
    }
    return data;
  }
  throw CannotFinish(name + ": no presses were found that hide what was drawn");
}

}  // namespace hoof::tools::conceal
