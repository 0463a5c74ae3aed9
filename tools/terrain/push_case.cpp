#include "tools/terrain/push_case.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace hoof::tools {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// The lowest point starts this far above the level sand, which no grain tops.
constexpr double kGap_m = 0.1e-3;
/// A force is read this often; finer on the way back, where it is gone within a millimetre.
constexpr double kPushSample_m = 0.5e-3, kBackSample_m = 0.05e-3;

double lowest_m(const PushCase& plate) {
  double lowest = 0;
  for (const Eigen::Vector3d& v : plate.mesh().vertices_m) {
    lowest = std::min(lowest, (plate.q_WB() * v).z());
  }
  return lowest;
}

}  // namespace

sim::TriangleMesh PushCase::mesh() const {
  sim::TriangleMesh box;
  for (int i = 0; i < 8; ++i) {
    box.vertices_m.emplace_back((i & 1 ? 0.5 : -0.5) * length_m, (i & 2 ? 0.5 : -0.5) * width_m,
                                (i & 4 ? 0.5 : -0.5) * thickness_m);
  }
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

Eigen::Quaterniond PushCase::q_WB() const {
  return Eigen::AngleAxisd(psi_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(-beta_rad, Eigen::Vector3d::UnitY());
}

Eigen::Vector3d PushCase::direction() const {
  return {std::cos(gamma_rad), 0, -std::sin(gamma_rad)};
}

Eigen::Vector3d PushCase::start_m() const {
  return {-0.5 * way_m * direction().x(), 0, kGap_m - lowest_m(*this)};
}

Eigen::Vector2d PushCase::half_extent_m() const {
  Eigen::Vector2d half(0, 0);
  for (const Eigen::Vector3d& v : mesh().vertices_m) {
    half = half.cwiseMax((q_WB() * v).head<2>().cwiseAbs());
  }
  half.x() += 0.5 * way_m * std::abs(direction().x());
  return half;
}

std::vector<PushLeg> legs_of(const PushCase& plate) {
  std::vector<PushLeg> legs;
  const auto add = [&legs](PushPhase phase, const Eigen::Vector3d& way_m, double sample_m) {
    const int n = std::max(1, int(std::lround(way_m.norm() / sample_m)));
    legs.push_back({phase, way_m, n});
  };
  if (plate.insert_m > 0) {
    add(PushPhase::kInsert, {0, 0, -plate.insert_m - kGap_m}, kPushSample_m);
  }
  add(PushPhase::kPush, plate.way_m * plate.direction(), kPushSample_m);
  if (plate.back_m > 0) {
    add(PushPhase::kBack, -plate.back_m * plate.direction(), kBackSample_m);
  }
  return legs;
}

std::vector<PushCase> standard_pushes(double scale) {
  struct Row {
    double length_mm, width_mm, beta_deg, psi_deg, gamma_deg, insert_mm, way_mm, back_mm;
  };
  // Widths of the traditional sole and its double; tilts, directions and twists of a foot that
  // stands, slides and digs. Every third is held out.
  constexpr Row kRows[] = {
      {100, 40, 0, 0, 90, 0, 20, 1},  {100, 60, 0, 0, 90, 0, 20, 1},
      {100, 90, 0, 0, 90, 0, 20, 1},  {100, 60, 0, 0, 60, 0, 20, 0},
      {100, 60, 30, 0, 90, 0, 25, 0}, {100, 60, 0, 0, 30, 0, 25, 0},
      {100, 60, 60, 0, 90, 0, 30, 0}, {100, 60, 30, 0, 30, 0, 30, 0},
      {100, 60, 30, 0, 60, 0, 25, 0}, {100, 60, -30, 0, 60, 0, 25, 0},
      {100, 60, 90, 0, 0, 25, 20, 0}, {60, 60, 60, 0, 0, 25, 20, 0},
      {100, 60, 0, 0, 0, 10, 20, 0},  {60, 100, 90, 45, 0, 25, 20, 0},
      {60, 60, 30, 45, 60, 0, 25, 0},
  };
  std::vector<PushCase> cases;
  for (const Row& row : kRows) {
    PushCase c;
    char name[100];
    std::snprintf(name, sizeof name, "plate %gx%g beta %g psi %g gamma %g", row.length_mm * scale,
                  row.width_mm * scale, row.beta_deg, row.psi_deg, row.gamma_deg);
    c.name = name;
    c.length_m = scale * row.length_mm * 1e-3, c.width_m = scale * row.width_mm * 1e-3;
    c.thickness_m = scale * 10e-3;
    c.beta_rad = row.beta_deg * kDegree, c.psi_rad = row.psi_deg * kDegree;
    c.gamma_rad = row.gamma_deg * kDegree;
    c.insert_m = scale * row.insert_mm * 1e-3, c.way_m = scale * row.way_mm * 1e-3;
    c.back_m = scale * row.back_mm * 1e-3;
    c.held_out = cases.size() % 3 == 2;
    cases.push_back(c);
  }
  return cases;
}

}  // namespace hoof::tools
