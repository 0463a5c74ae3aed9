#include "tools/terrain/soil_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "sim/terrain/rft_terrain.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

/// Steps of the law within one sample: a twentieth of the yield displacement of coarse sand.
constexpr int kSteps = 10;

double dot(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// The samples of the push itself, without the way back.
std::vector<Eigen::Vector3d> forces_of(const Push& push) {
  std::vector<Eigen::Vector3d> forces;
  for (const PushSample& s : push.samples) {
    if (s.phase == PushPhase::kPush) forces.push_back(s.force_N);
  }
  return forces;
}

sim::RftTerrainSettings unit_linear(sim::RftTerrainSettings soil) {
  soil.pressure_law = sim::PressureLaw::kLinear;
  soil.xi_n_N_m3.value = 1;
  return soil;
}

sim::RftTerrainSettings unit_bekker(sim::RftTerrainSettings soil, double exponent) {
  soil.pressure_law = sim::PressureLaw::kBekker;
  soil.bekker_k_phi_Pa = 1;
  soil.bekker_k_c_N_m = 0;
  soil.bekker_exponent = exponent;
  return soil;
}

/// Half of the load is gone after half of the yield displacement.
void fit_yield(const std::vector<Push>& pushes, sim::RftTerrainSettings& soil) {
  std::vector<double> found_m;
  for (const Push& push : pushes) {
    if (push.plate.held_out) continue;
    Eigen::Vector3d load_N(0, 0, 0);
    double before_m = 0, before_N = 0;
    for (const PushSample& s : push.samples) {
      if (s.phase == PushPhase::kPush) {
        load_N = s.force_N;
        before_N = load_N.norm();
        continue;
      }
      const double now_N = s.force_N.dot(load_N.normalized()), half_N = 0.5 * load_N.norm();
      if (now_N <= half_N) {
        const double share = (before_N - half_N) / (before_N - now_N);
        found_m.push_back(2 * (before_m + share * (s.way_m - before_m)));
        break;
      }
      before_m = s.way_m, before_N = now_N;
    }
  }
  if (found_m.empty()) return;
  double mean_m = 0, square_m2 = 0;
  for (const double m : found_m) mean_m += m / double(found_m.size());
  for (const double m : found_m) square_m2 += (m - mean_m) * (m - mean_m);
  const double n = double(found_m.size());
  soil.yield_displacement_m = {mean_m, n > 1 ? std::sqrt(square_m2 / (n - 1)) : 0,
                               "twice the way back that halves the load, of " +
                                   std::to_string(found_m.size()) + " pushes"};
}

struct Weighed {
  const Push* push;
  std::vector<Eigen::Vector3d> measured, unit;
  double square_N2 = 0;  // of the measured
};

std::vector<Weighed> weigh(const std::vector<Push>& pushes) {
  std::vector<Weighed> all;
  for (const Push& push : pushes) {
    Weighed w{&push, forces_of(push), {}, 0};
    w.square_N2 = dot(w.measured, w.measured);
    if (!(w.square_N2 > 0)) {
      throw UserError("'" + push.plate.name +
                      "' has no force in any sample; a push that met nothing cannot be fitted");
    }
    all.push_back(std::move(w));
  }
  return all;
}

void predict_units(std::vector<Weighed>& all, const sim::RftTerrainSettings& unit) {
  for (Weighed& w : all) {
    w.unit = predict(w.push->plate, unit);
    if (w.unit.size() < w.measured.size()) {
      throw UserError("'" + w.push->plate.name + "' has " + std::to_string(w.measured.size()) +
                      " samples, must have " + std::to_string(w.unit.size()) +
                      ": one per 0.5 mm of its push");
    }
    w.unit.resize(w.measured.size());
  }
}

double linear_xi(const std::vector<Weighed>& all) {
  double fg = 0, gg = 0;
  for (const Weighed& w : all) {
    if (w.push->plate.held_out) continue;
    fg += dot(w.measured, w.unit) / w.square_N2;
    gg += dot(w.unit, w.unit) / w.square_N2;
  }
  if (!(fg > 0) || !(gg > 0)) {
    throw UserError("the pushes do not resist the motion: the scale that fits them best is " +
                    format_number(gg > 0 ? fg / gg : 0) + " N/m^3, must be above 0");
  }
  return fg / gg;
}

struct Moduli {
  double k_c_N_m = 0, k_phi_Pa = 0, left = 0;  // left: mean of the squared ratios
};

/// Linear in k_c and k_phi for a given exponent.
Moduli bekker_moduli(const std::vector<Weighed>& all) {
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b(0, 0);
  int n = 0;
  for (const Weighed& w : all) {
    if (w.push->plate.held_out) continue;
    const Eigen::Vector2d row(1 / w.push->plate.smaller_width_m(), 1);
    a += row * row.transpose() * dot(w.unit, w.unit) / w.square_N2;
    b += row * dot(w.measured, w.unit) / w.square_N2;
    ++n;
  }
  const Eigen::Vector2d k = a.ldlt().solve(b);
  return {k[0], k[1], (n - 2 * b.dot(k) + k.dot(a * k)) / n};
}

void require_two_widths(const std::vector<Push>& pushes) {
  std::set<double> widths;
  for (const Push& push : pushes) {
    if (!push.plate.held_out) widths.insert(push.plate.smaller_width_m());
  }
  if (widths.size() < 2) {
    throw UserError("Bekker's k_c and k_phi cannot be told apart: all fitted plates are " +
                    format_number(widths.empty() ? 0 : *widths.begin() * 1e3) +
                    " mm wide, must be of two widths at least; --law linear needs one");
  }
}

/// Golden section over the exponent; the moduli follow.
void fit_bekker(std::vector<Weighed>& all, sim::RftTerrainSettings& soil) {
  constexpr double kLow = 0.2, kHigh = 2.5, kGolden = 0.6180339887498949;
  const auto moduli_at = [&](double exponent) {
    predict_units(all, unit_bekker(soil, exponent));
    return bekker_moduli(all);
  };
  double low = kLow, high = kHigh;
  double p = high - kGolden * (high - low), q = low + kGolden * (high - low);
  double at_p = moduli_at(p).left, at_q = moduli_at(q).left;
  while (high - low > 1e-4) {
    if (at_p < at_q) {
      high = q, q = p, at_q = at_p;
      p = high - kGolden * (high - low), at_p = moduli_at(p).left;
    } else {
      low = p, p = q, at_p = at_q;
      q = low + kGolden * (high - low), at_q = moduli_at(q).left;
    }
  }
  const double exponent = 0.5 * (low + high);
  if (exponent < kLow + 0.01 || exponent > kHigh - 0.01) {
    throw UserError("Bekker's exponent runs to " + format_number(exponent) +
                    ", must stay inside 0.2 ... 2.5: the pushes do not tell it");
  }
  const Moduli k = moduli_at(exponent);
  soil.bekker_exponent = exponent;
  soil.bekker_k_c_N_m = k.k_c_N_m;
  soil.bekker_k_phi_Pa = k.k_phi_Pa;
}

double spread_of_xi(const std::vector<CaseError>& cases, double xi) {
  double sum = 0;
  int n = 0;
  for (const CaseError& c : cases) {
    if (!c.held_out) sum += (c.xi_n_N_m3 - xi) * (c.xi_n_N_m3 - xi), ++n;
  }
  return n > 1 ? std::sqrt(sum / (n - 1)) : 0;
}

double root_mean_square(const std::vector<CaseError>& cases, bool held_out) {
  double sum = 0;
  int n = 0;
  for (const CaseError& c : cases) {
    if (c.held_out == held_out) sum += c.ratio * c.ratio, ++n;
  }
  return n > 0 ? std::sqrt(sum / n) : 0;
}

CaseError error_of(const Weighed& w, const sim::RftTerrainSettings& soil) {
  sim::RftTerrainSettings here = soil;
  here.bekker_width_m = w.push->plate.smaller_width_m();
  std::vector<Eigen::Vector3d> left = predict(w.push->plate, here);
  left.resize(w.measured.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = w.measured[i] - left[i];
  return {w.push->plate.name, w.push->plate.held_out, std::sqrt(dot(left, left) / w.square_N2),
          std::sqrt(w.square_N2 / double(w.measured.size())),
          dot(w.measured, w.unit) / dot(w.unit, w.unit)};
}

}  // namespace

std::vector<Eigen::Vector3d> predict(const PushCase& plate, const sim::RftTerrainSettings& soil) {
  sim::RftTerrainSettings slow = soil;
  slow.damping_s = 0;
  sim::RftTerrain terrain(slow);
  sim::BodyMotion motion;
  motion.start = motion.end = {plate.start_m(), plate.q_WB()};
  terrain.add_body(plate.mesh(), motion.start);
  std::vector<Eigen::Vector3d> forces;
  for (const PushLeg& leg : legs_of(plate)) {
    const Eigen::Vector3d step_m = leg.way_m / leg.intervals / kSteps;
    for (int i = 0; i < leg.intervals; ++i) {
      Eigen::Vector3d sum(0, 0, 0);
      for (int k = 0; k < kSteps; ++k) {
        motion.start = motion.end;
        motion.end.p_WB_m += step_m;
        sim::Wrench wrench;
        terrain.advance(1, {&motion, 1}, {&wrench, 1});  // without a damper time is nothing
        sum += wrench.f_W_N;
      }
      if (leg.phase == PushPhase::kPush) forces.push_back(sum / kSteps);
    }
  }
  return forces;
}

SoilFit fit_soil(const std::vector<Push>& pushes, const sim::RftTerrainSettings& start) {
  const auto fitted = std::count_if(pushes.begin(), pushes.end(),
                                    [](const Push& p) { return !p.plate.held_out; });
  if (fitted < 2) {
    throw UserError("there are " + std::to_string(fitted) +
                    " pushes to fit, must be at least 2 that are not held out");
  }
  SoilFit fit;
  fit.soil = start;
  fit_yield(pushes, fit.soil);
  std::vector<Weighed> all = weigh(pushes);
  if (start.pressure_law == sim::PressureLaw::kBekker) {
    require_two_widths(pushes);
    fit_bekker(all, fit.soil);
  }
  predict_units(all, unit_linear(fit.soil));
  const double xi = linear_xi(all);
  fit.soil.xi_n_N_m3 = {xi, 0, "least squares over " + std::to_string(fitted) +
                                   " pushes; sigma is the spread between them"};
  for (const Weighed& w : all) fit.cases.push_back(error_of(w, fit.soil));
  fit.soil.xi_n_N_m3.sigma = spread_of_xi(fit.cases, xi);
  fit.fit_error = fit.soil.fit_error = root_mean_square(fit.cases, false);
  fit.held_out_error = fit.soil.held_out_error = root_mean_square(fit.cases, true);
  return fit;
}

}  // namespace hoof::tools
