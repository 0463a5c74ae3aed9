#include "tools/conceal/sand_bench.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::tools::conceal {
namespace {

constexpr double kReferenceBreadth_m = 0.03;
/// Wall of the box of `wall_confinement`: the contract gives no number, only the ratio counts.
constexpr double kWallDistance_m = 0.1;

/// Everything that the force depends on beside the bed.
struct Moment {
  double depth_m, deepest_m, speed_m_s, rest_s, t_s;
};

class Bench {
 public:
  Bench(const SandBed& bed, const std::vector<HiddenEffect>& hidden, const SandPress& press)
      : bed_(bed), press_(press) {
    for (const HiddenEffect& effect : hidden) {
      for (const EffectParameter& p : effect.parameters) {
        values_.push_back({effect.name + "." + p.name, p.value});
      }
    }
  }

  double force(const Moment& m) const {
    const double compliance = value("rig_compliance.compliance");
    if (compliance <= 0.0) return stiff_force(m);
    // The rig gives by compliance * force: bisection, the force grows with depth.
    double low = 0.0, high = std::max(m.depth_m, 0.0);
    for (int i = 0; i < 60; ++i) {
      Moment there = m;
      there.depth_m = 0.5 * (low + high);
      there.deepest_m = std::max(there.depth_m, m.deepest_m - compliance * stiff_force(there));
      const bool deep = there.depth_m + compliance * stiff_force(there) > m.depth_m;
      (deep ? high : low) = there.depth_m;
    }
    Moment there = m;
    there.depth_m = 0.5 * (low + high);
    return stiff_force(there);
  }

 private:
  double value(const char* name) const {
    for (const auto& [key, v] : values_) {
      if (key == name) return v;
    }
    return 0.0;
  }

  double power_law(double z) const {
    return z > 0.0 ? (bed_.k_c / press_.breadth_m() + bed_.k_phi) * std::pow(z, bed_.n) : 0.0;
  }

  /// Pressure while the plate sinks, Pa.
  double virgin_pressure(double z) const {
    double p = power_law(z);
    const double layer = value("hard_layer.depth");
    if (layer > 0.0 && z > layer) {
      p = power_law(layer) + value("hard_layer.ratio") * (p - power_law(layer));
    }
    const double limit = value("bearing_limit.pressure");
    if (limit > 0.0) p = limit * (1.0 - std::exp(-p / limit));
    return p;
  }

  double pressure(const Moment& m) const {
    const double ratio = value("unload_hysteresis.ratio");
    if (ratio <= 0.0 || m.depth_m >= m.deepest_m) return virgin_pressure(m.depth_m);
    const double most = virgin_pressure(m.deepest_m);
    return std::max(0.0, most - ratio * (most - virgin_pressure(m.depth_m)));
  }

  double stiff_force(const Moment& m) const {
    const double z = m.depth_m;
    if (z <= 0.0) return 0.0;
    double p = pressure(m);
    const double exponent = value("plate_size_law.exponent");
    if (exponent != 0.0) p *= std::pow(press_.breadth_m() / kReferenceBreadth_m, exponent);
    const double far = z / kWallDistance_m;
    p *= 1.0 + value("wall_confinement.coefficient") * far * far;
    p *= 1.0 + value("rate_dependence.coefficient") * std::max(m.speed_m_s, 0.0);
    p *= 1.0 + value("packing_change.drift") * press_.index;
    p *= 1.0 - value("creep_at_rest.share") * (1.0 - std::exp(-m.rest_s / 1.5));
    const double pitch = value("stick_slip_in_sand.pitch");
    if (pitch > 0.0) {
      const double turn = z / pitch - std::floor(z / pitch);  // builds up, then breaks
      p *= 1.0 + value("stick_slip_in_sand.share") * (turn - 0.5);
    }
    const double level = value("unlevel_plate.depth");
    if (level > 0.0 && z < level) p *= z / level;  // touches on one side first
    p += value("cohesion.strength");
    return press_.area_m2() * p + value("side_friction.coefficient") * press_.perimeter_m() * z * z;
  }

  SandBed bed_;
  SandPress press_;
  std::vector<std::pair<std::string, double>> values_;
};

}  // namespace

double SandPress::area_m2() const {
  return disc ? 0.25 * std::numbers::pi * width_m * width_m : width_m * length_m;
}

double SandPress::breadth_m() const {
  return disc ? 0.5 * width_m : std::min(width_m, length_m);
}

double SandPress::perimeter_m() const {
  return disc ? std::numbers::pi * width_m : 2.0 * (width_m + length_m);
}

std::vector<double> sand_force(const SandBed& bed, const std::vector<HiddenEffect>& hidden,
                               const SandPress& press, const std::vector<double>& depth_m) {
  const Bench bench(bed, hidden, press);
  std::vector<double> force;
  Moment m{0.0, 0.0, 0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const double step_s = i > 0 ? press.times_s[i] - press.times_s[i - 1] : 0.0;
    m.t_s = press.times_s[i];
    m.depth_m = depth_m[i];
    m.deepest_m = std::max(m.deepest_m, m.depth_m);
    m.speed_m_s = press.travel.rate(m.t_s);
    m.rest_s = std::abs(m.speed_m_s) < 1e-5 && m.depth_m > 0.0 ? m.rest_s + step_s : 0.0;
    force.push_back(bench.force(m));
  }
  return force;
}

std::vector<double> carriage_depth(const SandPress& press) {
  std::vector<double> depth;
  for (const double t_s : press.times_s) {
    depth.push_back(press.surface_height_m - press.start_height_m + press.travel.value(t_s));
  }
  return depth;
}

const std::vector<std::string>& listed_sand_effects() {
  static const std::vector<std::string> names = {
      "rig_compliance",   "plate_size_law", "rate_dependence", "cohesion",
      "wall_confinement", "hard_layer",     "packing_change",  "unload_hysteresis"};
  return names;
}

const std::vector<std::string>& unlisted_sand_effects() {
  static const std::vector<std::string> names = {"creep_at_rest", "stick_slip_in_sand",
                                                 "unlevel_plate", "side_friction", "bearing_limit"};
  return names;
}

}  // namespace hoof::tools::conceal
