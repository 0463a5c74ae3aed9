#include "tools/conceal/seen_change.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hoof::tools::conceal {

const ChannelChange& SeenChange::main() const {
  return *std::max_element(
      channels.begin(), channels.end(),
      [](const ChannelChange& a, const ChannelChange& b) { return a.after_refit < b.after_refit; });
}

Eigen::VectorXd whitened(const ServoPlan& plan, const std::vector<ServoSignals>& signals) {
  std::vector<double> all;
  for (const ChannelNoise& c : plan.predicted) {
    for (const ServoSignals& s : signals) {
      for (const double v : s.*c.signal) all.push_back(v / c.sigma);
    }
  }
  return Eigen::Map<Eigen::VectorXd>(all.data(), Eigen::Index(all.size()));
}

Sensitivities sensitivities(const ServoPlan& plan, const std::vector<HiddenEffect>& hidden,
                            const std::vector<HiddenEffect>& free_effects,
                            const Eigen::VectorXd& base) {
  std::vector<Eigen::VectorXd> columns;
  std::vector<double> ridge;
  for (const DoubtfulParameter& doubt : plan.doubts) {
    ServoPlan other = plan;
    const double step = 0.1 * doubt.sigma;
    other.machine.*doubt.field += step;
    columns.push_back((whitened(other, run_plan(other, hidden)) - base) / 0.1);
    ridge.push_back(1.0);
  }
  for (const HiddenEffect& effect : free_effects) {
    for (const EffectParameter& p : effect.parameters) {
      if (p.name.starts_with("_") || p.name == "burst" || p.name == "order") continue;
      std::vector<HiddenEffect> other = hidden;
      for (HiddenEffect& e : other) {
        if (e.name == effect.name) {
          e.find(p.name).value += 0.02 * (p.period > 0.0 ? 1.0 : p.value);
        }
      }
      columns.push_back((whitened(plan, run_plan(plan, other)) - base) / 0.2);
      ridge.push_back(0.0);
    }
  }
  Sensitivities out;
  out.columns.resize(base.size(), Eigen::Index(columns.size()));
  out.ridge.resize(Eigen::Index(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    out.columns.col(Eigen::Index(i)) = columns[i];
    out.ridge[Eigen::Index(i)] = ridge[i];
  }
  return out;
}

SeenChange seen_change(const std::vector<std::string>& channels, const Eigen::VectorXd& change,
                       const Sensitivities& explained) {
  const Eigen::MatrixXd& a = explained.columns;
  Eigen::MatrixXd normal = a.transpose() * a;
  normal.diagonal() += explained.ridge;
  normal.diagonal().array() += 1e-9;
  const Eigen::VectorXd shift = normal.ldlt().solve(a.transpose() * change);
  const Eigen::VectorXd left = change - a * shift;
  SeenChange out;
  const Eigen::Index per_channel = change.size() / Eigen::Index(channels.size());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Eigen::Index from = Eigen::Index(i) * per_channel;
    const double root = std::sqrt(double(per_channel));
    out.channels.push_back({channels[i], change.segment(from, per_channel).norm() / root,
                            left.segment(from, per_channel).norm() / root});
  }
  out.strength = left.norm();
  return out;
}

SeenChange seen_change(const ServoPlan& plan, const Eigen::VectorXd& change,
                       const Sensitivities& explained) {
  std::vector<std::string> channels;
  for (const ChannelNoise& c : plan.predicted) channels.push_back(c.channel);
  return seen_change(channels, change, explained);
}

}  // namespace hoof::tools::conceal
