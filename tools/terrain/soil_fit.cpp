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

/// Steps of the law within one sample: 0.1 mm of a push.
constexpr int kSteps = 5;

double dot(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

std::vector<Eigen::Vector3d> forces_of(const Push& push) {
  std::vector<Eigen::Vector3d> forces;
  for (const PushSample& s : push.samples) forces.push_back(s.force_N);
  return forces;
}

/// Where a function of one peak downward is least, to 1e-3 of the range.
template <typename Function>
double golden_section(double low, double high, const Function& f) {
  constexpr double kGolden = 0.6180339887498949;
  const double end = 1e-3 * (high - low);
  double p = high - kGolden * (high - low), q = low + kGolden * (high - low);
  double at_p = f(p), at_q = f(q);
  while (high - low > end) {
    if (at_p < at_q) {
      high = q, q = p, at_q = at_p;
      p = high - kGolden * (high - low), at_p = f(p);
    } else {
      low = p, p = q, at_p = at_q;
      q = low + kGolden * (high - low), at_q = f(q);
    }
  }
  return 0.5 * (low + high);
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
    if (w.unit.size() != w.measured.size()) {
      throw UserError("'" + w.push->plate.name + "' has " + std::to_string(w.measured.size()) +
                      " samples, must have " + std::to_string(w.unit.size()) +
                      ": one per 0.5 mm of its push, then one per 0.05 mm of its way back");
    }
  }
}

struct Linear {
  double xi = 0, left = 0;  // left: mean of the squared ratios
};

Linear linear_xi(const std::vector<Weighed>& all) {
  double fg = 0, gg = 0;
  int n = 0;
  for (const Weighed& w : all) {
    if (w.push->plate.held_out) continue;
    fg += dot(w.measured, w.unit) / w.square_N2;
    gg += dot(w.unit, w.unit) / w.square_N2;
    ++n;
  }
  if (!(fg > 0) || !(gg > 0)) {
    throw UserError("the pushes do not resist the motion: the scale that fits them best is " +
                    format_number(gg > 0 ? fg / gg : 0) + " N/m^3, must be above 0");
  }
  return {fg / gg, 1 - fg * fg / gg / n};
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

/// Between a hundredth and ten times the thickness of the plates, on a scale of ratios.
double fit_yield_m(std::vector<Weighed>& all, const sim::RftTerrainSettings& soil) {
  const bool linear = soil.pressure_law == sim::PressureLaw::kLinear;
  double thickness_m = 0;
  for (const Weighed& w : all) thickness_m = std::max(thickness_m, w.push->plate.thickness_m);
  const double low = std::log(0.01 * thickness_m), high = std::log(10 * thickness_m);
  const double best = golden_section(low, high, [&](double log_m) {
    sim::RftTerrainSettings unit =
        linear ? unit_linear(soil) : unit_bekker(soil, soil.bekker_exponent);
    unit.yield_displacement_m.value = std::exp(log_m);
    predict_units(all, unit);
    return linear ? linear_xi(all).left : bekker_moduli(all).left;
  });
  const double margin = 0.01 * (high - low);
  if (best < low + margin || best > high - margin) {
    throw UserError("the yield displacement runs to " + format_number(std::exp(best) * 1e3) +
                    " mm, must stay inside " + format_number(std::exp(low) * 1e3) + " ... " +
                    format_number(std::exp(high) * 1e3) + " mm: the pushes do not tell it");
  }
  return std::exp(best);
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

/// The moduli follow from the exponent.
void fit_bekker(std::vector<Weighed>& all, sim::RftTerrainSettings& soil) {
  constexpr double kLow = 0.2, kHigh = 2.5;
  const auto moduli_at = [&](double exponent) {
    predict_units(all, unit_bekker(soil, exponent));
    return bekker_moduli(all);
  };
  const double exponent = golden_section(
      kLow, kHigh, [&](double exponent_tried) { return moduli_at(exponent_tried).left; });
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
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = w.measured[i] - left[i];
  return {w.push->plate.name, w.push->plate.held_out, std::sqrt(dot(left, left) / w.square_N2),
          std::sqrt(w.square_N2 / double(w.measured.size())),
          dot(w.measured, w.unit) / dot(w.unit, w.unit)};
}

}  // namespace

std::vector<Eigen::Vector3d> predict(const PushCase& plate, const sim::RftTerrainSettings& soil) {
  sim::RftTerrainSettings slow = soil;
  slow.damping_s = 0;
  // Fine, so that what is fitted is the law and not the facets of a foot.
  slow.facet_size_m = 2 * plate.thickness_m;
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
      if (leg.phase != PushPhase::kInsert) forces.push_back(sum / kSteps);
    }
  }
  return forces;
}

SoilFit fit_soil(const std::vector<Push>& pushes, const sim::RftTerrainSettings& start) {
  const auto fitted =
      std::count_if(pushes.begin(), pushes.end(), [](const Push& p) { return !p.plate.held_out; });
  if (fitted < 2) {
    throw UserError("there are " + std::to_string(fitted) +
                    " pushes to fit, must be at least 2 that are not held out");
  }
  SoilFit fit;
  fit.soil = start;
  std::vector<Weighed> all = weigh(pushes);
  fit.soil.yield_displacement_m.sigma = 0;
  fit.soil.yield_displacement_m.source = "fitted together with the pressure to the same pushes";
  if (start.pressure_law == sim::PressureLaw::kLinear) {
    fit.soil.yield_displacement_m.value = fit_yield_m(all, fit.soil);
  } else {
    require_two_widths(pushes);
    // In turns: the two numbers hardly touch.
    for (int round = 0; round < 2; ++round) {
      fit_bekker(all, fit.soil);
      fit.soil.yield_displacement_m.value = fit_yield_m(all, fit.soil);
    }
  }
  predict_units(all, unit_linear(fit.soil));
  const double xi = linear_xi(all).xi;
  fit.soil.xi_n_N_m3 = {
      xi, 0,
      "least squares over " + std::to_string(fitted) + " pushes; sigma is the spread between them"};
  for (const Weighed& w : all) fit.cases.push_back(error_of(w, fit.soil));
  fit.soil.xi_n_N_m3.sigma = spread_of_xi(fit.cases, xi);
  fit.fit_error = fit.soil.fit_error = root_mean_square(fit.cases, false);
  fit.held_out_error = fit.soil.held_out_error = root_mean_square(fit.cases, true);
  return fit;
}

}  // namespace hoof::tools
