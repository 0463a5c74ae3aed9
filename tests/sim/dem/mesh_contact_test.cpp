// A grain against a triangle mesh: face, edge and vertex alike, never twice, and like a flat wall.
#include <catch2/catch.hpp>
#include <cmath>

#include "sim/dem/closest_point.h"
#include "tests/sim/dem/paper_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

constexpr double kDiameter_m = 4e-3;

/// Shoots a grain at a fixed box along `direction`, aimed at `target` on its surface, and gives the
/// speed along the line afterwards over the speed before.
double rebound(const Eigen::Vector3d& target, const Eigen::Vector3d& direction, Precision precision,
               double* sideways = nullptr) {
  DemSettings s = paper_settings();
  s.precision = precision;
  const double speed = 0.3;
  BedState start;
  start.grains = {
      grain_at(0, kDiameter_m, target - (kDiameter_m / 2 + 1e-6) * direction, speed * direction)};
  SandBed bed(s, start);
  const int box = bed.add_mesh(box_mesh({0.01, 0.01, 0.01}), Eigen::Vector3d::Zero(),
                               Eigen::Quaterniond::Identity());
  bed.advance(400);
  const Grain end = bed.state().grains[0];
  const MeshLoad load = bed.take_load(box);
  // What the grain lost, the box got.
  const Eigen::Vector3d lost = grain_mass_kg(kDiameter_m) * (speed * direction - end.v_m_s);
  CHECK((load.impulse_W_Ns - lost).norm() < 1e-5 * lost.norm());
  CHECK(load.work_J == 0);  // it does not move
  if (sideways) *sideways = (end.v_m_s - end.v_m_s.dot(direction) * direction).norm() / speed;
  return -end.v_m_s.dot(direction) / speed;
}

}  // namespace

TEST_CASE("closest point of a triangle: face, edges, vertices") {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  const auto at = [&](double x, double y, double z) {
    const Eigen::Vector3d p(x, y, z);
    return Eigen::Vector3d(p - closest_point(Facet(a, b, c), p).to_p_m);
  };
  CHECK(at(0.2, 0.3, 0.5).isApprox(Eigen::Vector3d(0.2, 0.3, 0)));
  CHECK(at(0.2, 0.3, -0.5).isApprox(Eigen::Vector3d(0.2, 0.3, 0)));
  CHECK(at(0.4, -1, 1).isApprox(Eigen::Vector3d(0.4, 0, 0)));
  CHECK(at(-1, 0.4, 1).isApprox(Eigen::Vector3d(0, 0.4, 0)));
  CHECK(at(1, 1, 1).isApprox(Eigen::Vector3d(0.5, 0.5, 0)));
  CHECK(at(-1, -1, 2).norm() == 0);
  CHECK(at(3, -1, 2).isApprox(b));
  CHECK(at(-1, 3, 2).isApprox(c));
}

TEST_CASE("face, edge, vertex and the diagonal of a face give the same rebound as a wall") {
  DemSettings s = paper_settings();
  s.walls = {{Eigen::Vector3d::UnitZ(), 0}};
  s.precision = Precision::kDouble;
  BedState start;
  start.grains = {grain_at(0, kDiameter_m, {0, 0, kDiameter_m / 2 + 1e-6}, {0, 0, -0.3})};
  SandBed wall(s, start);
  wall.advance(400);
  const double e_wall = wall.state().grains[0].v_m_s.z() / 0.3;
  CHECK(e_wall == Approx(0.5636).epsilon(0.01));

  const double h = 0.01, q = 1 / std::sqrt(2.0), t = 1 / std::sqrt(3.0);
  struct Aim {
    const char* what;
    Eigen::Vector3d target, direction;
  };
  const std::vector<Aim> aims = {
      {"face", {0.002, 0.003, h}, {0, 0, -1}},       {"diagonal of a face", {0, 0, h}, {0, 0, -1}},
      {"face below", {0.002, 0.003, -h}, {0, 0, 1}}, {"near an edge", {h - 1e-5, 0, h}, {0, 0, -1}},
      {"edge", {h, 0.002, h}, {-q, 0, -q}},          {"other edge", {0.001, -h, -h}, {0, q, q}},
      {"vertex", {h, h, h}, {-t, -t, -t}},           {"other vertex", {-h, h, -h}, {t, -t, t}}};
  for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
    for (const Aim& aim : aims) {
      double sideways = 0;
      const double e = rebound(aim.target, aim.direction, precision, &sideways);
      INFO(aim.what);
      // A spot pushed twice would show as another restitution or as a kick sideways.
      CHECK(e == Approx(e_wall).epsilon(precision == Precision::kDouble ? 1e-6 : 1e-3));
      CHECK(sideways < 1e-6);
    }
  }
}

TEST_CASE("a grain in a corner is pushed by both walls of it") {
  // Two boxes' worth of concave corner: an L of two boxes in one mesh.
  TriangleMesh corner = box_mesh({0.01, 0.01, 0.01});
  TriangleMesh side = box_mesh({0.01, 0.01, 0.02});
  const auto base = std::int32_t(corner.vertices_m.size());
  for (Eigen::Vector3d v : side.vertices_m) {
    corner.vertices_m.push_back(v + Eigen::Vector3d(0.02, 0, 0.01));
  }
  for (auto t : side.triangles) corner.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  DemSettings s = paper_settings();
  s.grain_wall = {1, 0, 0};
  s.precision = Precision::kDouble;
  const double r = kDiameter_m / 2;
  BedState start;
  start.grains = {
      grain_at(0, kDiameter_m, {0.01 - r - 1e-6, 0.001, 0.01 + r + 1e-6}, {0.2, 0, -0.2})};
  SandBed bed(s, start);
  bed.add_mesh(corner, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
  bed.advance(400);
  const Grain end = bed.state().grains[0];
  CHECK(end.v_m_s.x() == Approx(-0.2).epsilon(5e-3));  // elastic: 0.5 % leapfrog, see design
  CHECK(end.v_m_s.z() == Approx(0.2).epsilon(5e-3));
}

TEST_CASE("a sliding grain keeps its friction spring across the triangles of a flat mesh") {
  // A plate cut into 2 x 40 strips: a grain that is dragged over it must feel one floor.
  TriangleMesh plate;
  const int strips = 40;
  for (int i = 0; i <= strips; ++i) {
    for (const double y : {-0.02, 0.02}) plate.vertices_m.emplace_back(-0.02 + i * 1e-3, y, 0);
  }
  for (int i = 0; i < strips; ++i) {
    plate.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
    plate.triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
  }
  DemSettings s = paper_settings();
  s.gravity_m_s2 = {0, 0, -9.81};
  s.precision = Precision::kDouble;
  const PairLaw<double> law = make_pair_law(s.grain_material, s.wall_material, s.grain_wall);
  const double r = kDiameter_m / 2, weight = grain_mass_kg(kDiameter_m) * 9.81;
  const double delta = std::pow(3 * weight / (4 * law.E_eff_Pa * std::sqrt(r)), 2.0 / 3.0);
  BedState start;
  start.grains = {grain_at(0, kDiameter_m, {-0.015, 0, r - delta}, {0.3, 0, 0})};
  DemSettings with_wall = s;
  with_wall.walls = {{Eigen::Vector3d::UnitZ(), 0}};
  SandBed flat(with_wall, start), meshed(s, start);
  meshed.add_mesh(plate, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
  flat.advance(20000), meshed.advance(20000);
  const Grain a = flat.state().grains[0], b = meshed.state().grains[0];
  CHECK(a.p_m.x() > -0.005);  // it crossed at least ten strips
  CHECK((a.p_m - b.p_m).norm() < 1e-9);
  CHECK((a.v_m_s - b.v_m_s).norm() < 1e-7);
  CHECK((a.w_rad_s - b.w_rad_s).norm() * r < 1e-7);
}

TEST_CASE("a moving box gives a grain its speed and does the work for it") {
  for (const int sign : {-1, 1}) {
    DemSettings s = paper_settings();
    s.grain_wall = {1, 0, 0};
    s.precision = Precision::kDouble;
    BedState start;
    const double gap = 1e-6, h = 0.01, u = 0.2;
    start.grains = {grain_at(0, kDiameter_m, {0, 0, sign * (h + kDiameter_m / 2 + gap)})};
    SandBed bed(s, start);
    const int box =
        bed.add_mesh(box_mesh({h, h, h}), Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
    bed.set_motion(box,
                   {Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), {0, 0, sign * u}});
    bed.advance(600);
    // Elastic, against an infinite mass: twice the wall's speed.
    CHECK(bed.state().grains[0].v_m_s.z() == Approx(sign * 2 * u).epsilon(5e-3));
    const MeshLoad load = bed.take_load(box);
    CHECK(load.work_J == Approx(-bed.kinetic_energy_J()).epsilon(1e-2));
    CHECK(bed.take_load(box).impulse_W_Ns.norm() == 0);  // taken
  }
}

TEST_CASE("a mesh acts from the first step, also on grains at rest") {
  for (const int sign : {-1, 1}) {
    DemSettings s = paper_settings();
    BedState start;
    const double h = 0.01;
    start.grains = {grain_at(0, kDiameter_m, {0, 0, sign * (h + kDiameter_m / 2 - 1e-6)})};
    SandBed bed(s, start);
    bed.add_mesh(box_mesh({h, h, h}), Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
    bed.advance(1);
    CHECK(sign * bed.state().grains[0].v_m_s.z() > 0);
  }
}
