#include "tools/study/drop_law.h"

#include <ceres/ceres.h>

#include <cmath>
#include <stdexcept>

#include "tools/study/statistics.h"

namespace hoof::tools {
namespace {

using Values = std::span<const double>;

/// Of a rigid sphere that sticks while it touches: its spin takes 2/7.
constexpr double kSticking = 5.0 / 7;

struct Misfit {
  const DropLaw& law;
  const std::vector<DropRow>& rows;

  bool operator()(double const* const* blocks, double* residual) const {
    const Values values(blocks[0], law.parameters.size());
    for (const DropRow& row : rows) {
      const double predicted_mm = law.travel_mm(row.e, values);
      if (!std::isfinite(predicted_mm)) return false;
      *residual++ = predicted_mm - row.travel_mm;
    }
    return true;
  }
};

double root_mean_square(Values values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Fills values, rms_mm and, where asked for, interval.
void fit(const DropLaw& law, const std::vector<DropRow>& rows, bool with_interval, DropFit& into) {
  const auto count = static_cast<int>(law.parameters.size());
  if (rows.size() <= law.parameters.size()) throw std::invalid_argument("drop law: too few rows");
  into.values.clear();
  for (const DropParameter& parameter : law.parameters) into.values.push_back(parameter.start);
  const Misfit misfit{law, rows};
  // Ceres takes its own copy: rows and law outlive it.
  auto* cost = new ceres::DynamicNumericDiffCostFunction<Misfit>(new Misfit(misfit));
  cost->AddParameterBlock(count);
  cost->SetNumResiduals(static_cast<int>(rows.size()));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, into.values.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  const auto samples = static_cast<double>(rows.size());
  into.rms_mm = std::sqrt(2 * summary.final_cost / samples);
  if (!with_interval) return;
  ceres::Covariance::Options how;
  how.algorithm_type = ceres::DENSE_SVD;
  how.null_space_rank = 0;
  ceres::Covariance covariance(how);
  into.interval.assign(into.values.size(), INFINITY);
  if (!covariance.Compute({into.values.data()}, &problem)) return;
  std::vector<double> matrix(into.values.size() * into.values.size());
  covariance.GetCovarianceBlock(into.values.data(), into.values.data(), matrix.data());
  const std::size_t degrees = rows.size() - law.parameters.size();
  const double variance_mm2 = 2 * summary.final_cost / static_cast<double>(degrees);
  for (std::size_t i = 0; i < into.values.size(); ++i) {
    into.interval[i] =
        student_t_975(degrees) * std::sqrt(variance_mm2 * matrix[i * (into.values.size() + 1)]);
  }
}

}  // namespace

double drop_travel(double e, double kept_tangential, double height, double height_after) {
  const double a = (e - kept_tangential) / 2;
  return (e + kept_tangential) * height * (a + std::sqrt(a * a + height_after / height));
}

const std::vector<DropRow>& paper_drop_table() {
  static const std::vector<DropRow> rows = {
      {0.350, 39.88}, {0.375, 40.54}, {0.400, 41.85}, {0.425, 43.24}, {0.450, 45.03},
      {0.475, 46.38}, {0.500, 47.77}, {0.525, 48.51}, {0.550, 49.94}, {0.575, 51.41},
      {0.600, 52.92}, {0.625, 54.45}, {0.650, 56.03}};
  return rows;
}

const std::vector<DropLaw>& drop_laws() {
  static const std::vector<DropLaw> laws = {
      {"2 e H (k_t = e)",
       {{"H", 45}},
       [](double e, Values v) { return drop_travel(e, e, v[0], v[0]); }},
      {"k_t free",
       {{"H", 45}, {"k_t", 0.8}},
       [](double e, Values v) { return drop_travel(e, v[1], v[0], v[0]); }},
      {"k_t and H2 free",
       {{"H", 45}, {"k_t", 0.8}, {"H2", 45}},
       [](double e, Values v) { return drop_travel(e, v[1], v[0], v[2]); }},
      {"k_t = 1 (no friction)",
       {{"H", 45}},
       [](double e, Values v) { return drop_travel(e, 1, v[0], v[0]); }},
      {"k_t = 5/7 (sticks)",
       {{"H", 45}},
       [](double e, Values v) { return drop_travel(e, kSticking, v[0], v[0]); }},
      {"k_t = 5/7 and H2 free",
       {{"H", 45}, {"H2", 45}},
       [](double e, Values v) { return drop_travel(e, kSticking, v[0], v[1]); }},
      {"2 e H + offset",
       {{"H", 45}, {"offset", 0}},
       [](double e, Values v) { return drop_travel(e, e, v[0], v[0]) + v[1]; }},
      {"free parabola", {{"c0", 40}, {"c1", 50}, {"c2", 0}}, [](double e, Values v) {
         return v[0] + (e - 0.5) * (v[1] + (e - 0.5) * v[2]);
       }}};
  return laws;
}

DropFit fit_drop_law(const DropLaw& law, const std::vector<DropRow>& rows) {
  DropFit result;
  fit(law, rows, true, result);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<DropRow> others = rows;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    DropFit without;
    fit(law, others, false, without);
    result.held_out_mm.push_back(law.travel_mm(rows[i].e, without.values) - rows[i].travel_mm);
  }
  result.held_out_rms_mm = root_mean_square(result.held_out_mm);
  return result;
}

}  // namespace hoof::tools
