// Equation errors and the features of effects in them, for the baselines.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "tools/conceal/regression.h"

namespace hoof::tools::conceal {
namespace {

constexpr std::size_t kMostRows = 1200;

/// Value, first and second derivative by a parabola through the samples within +-25 ms.
struct Smoothed {
  std::vector<double> value, rate, second;
};

Smoothed smoothed(const std::vector<double>& t, const std::vector<double>& x, double half_s) {
  Smoothed out;
  for (std::size_t i = 0; i < t.size(); ++i) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    std::size_t from = i, to = i;
    while (from > 0 && (t[i] - t[from - 1] <= half_s || i - from < 2)) --from;
    while (to + 1 < t.size() && (t[to + 1] - t[i] <= half_s || to - i < 2)) ++to;
    for (std::size_t j = from; j <= to; ++j) {
      const double d = (t[j] - t[i]) / half_s;
      const Eigen::Vector3d row(1.0, d, d * d);
      normal += row * row.transpose();
      right += row * x[j];
    }
    const Eigen::Vector3d c = (normal + 1e-12 * Eigen::Matrix3d::Identity()).ldlt().solve(right);
    out.value.push_back(c[0]);
    out.rate.push_back(c[1] / half_s);
    out.second.push_back(2.0 * c[2] / (half_s * half_s));
  }
  return out;
}

/// Rows of named groups of columns, gathered sample by sample.
class Rows {
 public:
  void add(const std::string& group, std::vector<double> row) {
    groups_[group].push_back(std::move(row));
  }

  Eigen::MatrixXd matrix(const std::string& group) const {
    const auto& rows = groups_.at(group);
    const std::size_t step = (rows.size() + kMostRows - 1) / kMostRows;
    Eigen::MatrixXd out(Eigen::Index((rows.size() + step - 1) / step),
                        Eigen::Index(rows.front().size()));
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      const auto& row = rows[std::size_t(i) * step];
      for (Eigen::Index j = 0; j < out.cols(); ++j) out(i, j) = row[std::size_t(j)];
    }
    return out;
  }

  RegressionProblem problem() const {
    RegressionProblem out{matrix("#measured").col(0), matrix("#nominal"), {}, matrix("#state")};
    for (const auto& [group, rows] : groups_) {
      if (group[0] != '#')
        out.dictionary.push_back({group.substr(0, group.find(' ')), matrix(group)});
    }
    return out;
  }

 private:
  std::map<std::string, std::vector<std::vector<double>>> groups_;
};

/// Motor torque as far as the channels tell it, else by the law.
std::vector<double> motor_torque(const ReadCase& data, const ReadRecording& r,
                                 const Smoothed& motion) {
  if (r.has("torque")) return r.at("torque");
  const double kt = r.value("kt", 1.0);
  std::vector<double> torque;
  for (std::size_t i = 0; i < motion.value.size(); ++i) {
    double tau = 0.0;
    if (r.has("current")) {
      tau = kt * r.at("current")[i];
    } else if (data.law == "duty") {
      const double error = r.at("position_goal")[i] - r.at("position")[i];
      const double duty = std::clamp(
          r.value("kp_duty", 0) * r.value("counts_per_rad", 0) * error / 256.0 / 885.0, -1.0, 1.0);
      const double volt =
          r.has("supply_voltage") ? r.at("supply_voltage")[i] : r.value("supply_voltage", 12.0);
      tau = kt / r.value("resistance", 1.0) * (duty * volt - kt * motion.rate[i]);
    } else {
      const double goal_rate = r.has("velocity_goal") ? r.at("velocity_goal")[i] : 0.0;
      tau = r.value("kp", 0) * (r.at("position_goal")[i] - motion.value[i]) +
            r.value("kd", 0) * (goal_rate - motion.rate[i]) +
            (r.has("torque_ff") ? r.at("torque_ff")[i] : 0.0);
      const double limit = r.value("torque_limit", 1e9);
      tau = std::clamp(tau, -limit, limit);
    }
    if (r.has("enable") && r.at("enable")[i] < 0.5) tau = 0.0;
    torque.push_back(tau);
  }
  return torque;
}

void add_servo(const ReadCase& data, const ReadRecording& r, Rows& rows) {
  const std::vector<double>& t = r.at("time");
  const Smoothed motion = smoothed(t, r.at("position"), 0.025);
  const Smoothed torque = smoothed(t, motor_torque(data, r, motion), 0.025);
  std::vector<double> sizes;
  for (const double v : torque.value) sizes.push_back(std::abs(v));
  std::sort(sizes.begin(), sizes.end());
  const double high = sizes[sizes.size() * 8 / 10];
  double heat = 0.0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double q = motion.value[i], w = motion.rate[i], tau = torque.value[i];
    heat += (t[i] - t[i - 1]) / 2.0 * (tau * tau - heat);
    if (r.has("enable") && r.at("enable")[i] < 0.5) continue;
    if (std::abs(w) < 0.03) continue;  // at rest friction is whatever it must be
    const double side = std::copysign(1.0, w);
    const double weight = 9.81 * r.value("payload_length", 0.1) *
                          (r.value("payload_mass", 0) + 0.5 * r.value("arm_mass", 0));
    rows.add("#measured", {tau});
    rows.add("#nominal", {motion.second[i], side, w, std::sin(q)});
    rows.add("#state", {q, w});
    rows.add("stribeck_friction 1", {side * std::exp(-w * w / 0.01)});
    rows.add("stribeck_friction 2", {side * std::exp(-w * w / 0.1)});
    rows.add("load_dependent_friction", {side * std::abs(tau + weight * std::sin(q))});
    rows.add("directional_friction", {1.0});
    rows.add("joint_compliance", {torque.second[i]});
    rows.add("backlash", {side * motion.second[i] * motion.second[i]});
    for (const int order : {4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24}) {
      rows.add("cogging_torque " + std::to_string(order),
               {std::sin(order * q), std::cos(order * q)});
    }
    rows.add("torque_ceiling", {tau - std::clamp(tau, -high, high)});
    rows.add("thermal_derating", {tau * heat});
    if (data.law == "duty") rows.add("supply_sag", {tau * tau * tau});
    rows.add("actuator_lag", {torque.rate[i]});
    if (r.has("position_goal")) {
      const double ahead =
          i + 1 < t.size() ? r.at("position_goal")[i + 1] : r.at("position_goal")[i];
      rows.add("transport_delay", {ahead - r.at("position_goal")[i - 1]});
    }
    rows.add("encoder_eccentricity", {std::cos(q), std::sin(2.0 * q)});
    rows.add("parasitic_spring", {q, 1.0});
  }
}

void add_sand(const ReadRecording& r, int index, Rows& rows) {
  const std::vector<double>& t = r.at("time");
  const Smoothed height = smoothed(t, r.at("position"), 0.1);
  const Smoothed force = smoothed(t, r.at("force"), 0.1);
  const double width = r.value("diameter", 0.06), area = 0.785398 * width * width;
  const double n = r.value("n", 1.0);
  double deepest = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double z = r.value("surface_height", 0.0) - height.value[i];
    if (z < 5e-4) continue;
    deepest = std::max(deepest, z);
    const double p = area * std::pow(z, n), speed = -height.rate[i];
    rows.add("#measured", {force.value[i]});
    rows.add("#nominal", {p, p / (0.5 * width), p * std::log(z), p * std::log(z) / (0.5 * width)});
    rows.add("#state", {z, width});
    rows.add("plate_size_law", {p * std::log(width)});
    rows.add("rate_dependence", {p * std::max(speed, 0.0)});
    rows.add("cohesion", {area});
    rows.add("wall_confinement", {p * z * z});
    for (const double depth : {0.006, 0.009, 0.012, 0.015, 0.018}) {
      rows.add("hard_layer " + std::to_string(depth), {area * std::max(z - depth, 0.0)});
    }
    rows.add("packing_change", {p * index});
    rows.add("unload_hysteresis", {p * (deepest - z > 1e-4 ? deepest / z - 1.0 : 0.0)});
    rows.add("rig_compliance", {p * p / z});
  }
}

}  // namespace

RegressionProblem regression_of(const ReadCase& data) {
  Rows rows;
  int index = 0;
  for (const ReadRecording& r : data.recordings) {
    if (!r.holdout && data.rig == "servo_pendulum") add_servo(data, r, rows);
    if (!r.holdout && data.rig == "plate_sand") add_sand(r, index, rows);
    ++index;
  }
  return rows.problem();
}

}  // namespace hoof::tools::conceal
