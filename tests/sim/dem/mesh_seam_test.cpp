// However a surface is cut into triangles, a grain feels one surface.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/sim/dem/boundary_rig.h"
#include "tests/sim/dem/test_meshes.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

constexpr double kRadius_m = 2e-3;

DemSettings heavy_settings() {
  DemSettings s = paper_settings();
  s.gravity_m_s2 = {0, 0, -9.81};
  return s;
}

/// Overlap with a flat face that carries a force.
double overlap_m(const DemSettings& s, double force_N) {
  const PairLaw<double> law = make_pair_law(s.grain_material, s.wall_material, s.grain_wall);
  return std::pow(3 * force_N / (4 * law.E_eff_Pa * std::sqrt(kRadius_m)), 2.0 / 3.0);
}

double weight_N() {
  return grain_mass_kg(2 * kRadius_m) * 9.81;
}

/// Two coplanar triangles over [-w, w]^2, and the upper one's long side split by vertices that the
/// lower one does not have.
TriangleMesh t_junction_mesh(double w, int splits) {
  TriangleMesh mesh;
  mesh.vertices_m = {{-w, -w, 0}, {w, -w, 0}, {w, w, 0}, {-w, w, 0}};
  mesh.triangles = {{0, 1, 2}};
  std::int32_t last = 0;
  for (int i = 1; i <= splits; ++i) {
    const double x = -w + 2 * w * i / splits;
    std::int32_t next = 2;
    if (i < splits) {
      next = std::int32_t(mesh.vertices_m.size());
      mesh.vertices_m.emplace_back(x, x, 0);
    }
    mesh.triangles.push_back({last, next, 3});
    last = next;
  }
  return mesh;
}

struct Track {
  std::vector<Eigen::Vector3d> p_m, v_m_s, w_rad_s;
};

/// A grain that slides, rolls and spins over the plane z = 0, from x = -15 mm on.
Track track_over(const TriangleMesh& mesh) {
  const DemSettings s = heavy_settings();
  BoundaryRig rig(
      s, {grain_at(0, 2 * kRadius_m, {-0.015, -0.0137, kRadius_m - overlap_m(s, weight_N())},
                   {0.35, 0.31, 0}, {20, -10, 40})});
  rig.boundary().add_mesh(mesh);
  Track track;
  for (int i = 0; i < 60; ++i) {
    rig.advance(400);
    track.p_m.push_back(rig.p_m());
    track.v_m_s.push_back(rig.v_m_s());
    track.w_rad_s.push_back(rig.w_rad_s());
  }
  return track;
}

}  // namespace

TEST_CASE("a grain rolling and sliding over a plane takes the same way however it is cut") {
  const double w = 0.02;
  const auto flat = [](double, double) { return 0.0; };
  const Track coarse = track_over(sheet_mesh(w, 1, flat));
  CHECK((coarse.p_m.back() - coarse.p_m.front()).norm() > 0.015);
  TriangleMesh back_to_front = sheet_mesh(w, 7, flat);
  std::reverse(back_to_front.triangles.begin(), back_to_front.triangles.end());
  const std::vector<std::pair<const char*, TriangleMesh>> cuts = {
      {"80 x 80 squares", sheet_mesh(w, 80, flat)},  // seams every half millimetre
      {"7 x 7 squares, the last first", back_to_front},
      {"T-junctions", t_junction_mesh(w, 9)},
      {"a closed block", [] {
         TriangleMesh block = box_mesh({0.02, 0.02, 0.01});
         for (Eigen::Vector3d& v : block.vertices_m) v.z() -= 0.01;
         return refined(refined(refined(block)));
       }()}};
  for (const auto& [what, mesh] : cuts) {
    INFO(what);
    const Track cut = track_over(mesh);
    // 24,000 steps, hundreds of seams: no more than the rounding of positions gathers.
    for (std::size_t i = 0; i < cut.p_m.size(); ++i) {
      CHECK((cut.p_m[i] - coarse.p_m[i]).norm() < 1e-12);
      CHECK((cut.v_m_s[i] - coarse.v_m_s[i]).norm() < 1e-10);
      CHECK((cut.w_rad_s[i] - coarse.w_rad_s[i]).norm() * kRadius_m < 1e-10);
    }
  }
}

TEST_CASE("a grain goes over a convex edge on one contact, finely cut or not") {
  const DemSettings s = heavy_settings();
  const TriangleMesh box = box_mesh({0.01, 0.01, 0.01});
  const double arc_m = kRadius_m - 2e-6;  // distance of the centre from the edge
  for (const TriangleMesh& mesh : {box, refined(refined(refined(refined(box))))}) {
    // The centre is led around the edge: the force is that of one flat contact throughout.
    double flat_N = 0;
    for (int degrees = -20; degrees <= 110; ++degrees) {
      const double turn_rad = degrees * 3.14159265358979323846 / 180;
      const double on_edge_rad = std::clamp(turn_rad, 0.0, 1.5707963267948966);
      Eigen::Vector3d centre =
          Eigen::Vector3d(0.01, 0.0013, 0.01) +
          arc_m * Eigen::Vector3d(std::sin(on_edge_rad), 0, std::cos(on_edge_rad));
      if (degrees < 0) centre.x() += 1e-4 * degrees;
      if (degrees > 90) centre.z() -= 1e-4 * (degrees - 90);
      BoundaryRig rig(s, {grain_at(0, 2 * kRadius_m, centre)});
      rig.boundary().add_mesh(mesh);
      rig.compute();
      const double force_N = rig.force_N().norm();
      if (flat_N == 0) flat_N = force_N;
      INFO(degrees << " degrees around the edge");
      // Rounding of a position of 1e-2 m in an overlap of 2e-6 m, to the power of 3/2.
      CHECK(force_N == Approx(flat_N).epsilon(1e-10));
      CHECK(rig.force_N().normalized().dot(Eigen::Vector3d(
                std::sin(on_edge_rad), 0, std::cos(on_edge_rad))) == Approx(1).epsilon(1e-9));
    }
    CHECK(flat_N > 0);
  }
}

TEST_CASE("in a corner each of two or three walls pushes as if it were alone") {
  const DemSettings s = heavy_settings();
  const double delta = 3e-6;
  BoundaryRig alone(s, {grain_at(0, 2 * kRadius_m, {0, 0, kRadius_m - delta})});
  alone.boundary().add_mesh(sheet_mesh(0.01, 1, [](double, double) { return 0.0; }));
  alone.compute();
  const double one_N = alone.force_N().z();
  REQUIRE(one_N > 0);
  // The inside of a closed box: its faces meet in concave edges and corners as seen from within.
  TriangleMesh room = box_mesh({0.01, 0.01, 0.01});
  for (auto& t : room.triangles) std::swap(t[1], t[2]);
  for (const TriangleMesh& mesh : {room, refined(refined(refined(room)))}) {
    for (const Eigen::Vector3d& walls :
         {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, -1), Eigen::Vector3d(1, -1, 0),
          Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(-1, 1, -1)}) {
      BoundaryRig rig(s, {grain_at(0, 2 * kRadius_m, (0.01 - kRadius_m + delta) * walls)});
      rig.boundary().add_mesh(mesh);
      rig.compute();
      INFO("walls " << walls.transpose());
      CHECK((rig.force_N() + one_N * walls).norm() < 1e-9 * one_N);
    }
  }
}

TEST_CASE("the seams of a hollow are felt once, however shallow or steep they are") {
  // A gutter of two planes that fall towards x = 0 at `slope`. The grain's centre is where both
  // have the same overlap: the force may be at most the sum of both, and is that of one where the
  // gutter is nearly flat. Between, it grows steadily with the slope.
  const DemSettings s = heavy_settings();
  const double delta = 4e-6;  // contact discs of sqrt(r delta) = 89 um
  double one_N = 0, last = 0;
  for (const double slope : {0.0, 1e-6, 1e-4, 1e-3, 3e-3, 0.01, 0.02, 0.04, 0.08, 0.2, 0.6, 1.0}) {
    const auto gutter = [&](double x, double) { return slope * std::abs(x); };
    const double z_m = (kRadius_m - delta) * std::sqrt(1 + slope * slope);
    BoundaryRig rig(s, {grain_at(0, 2 * kRadius_m, {0, 1e-4, z_m})});
    rig.boundary().add_mesh(sheet_mesh(0.01, 2, gutter));
    rig.compute();
    const Eigen::Vector3d force_N = rig.force_N();
    // As if both pushed fully, each along its own normal.
    const double both = 2 / std::sqrt(1 + slope * slope);
    if (slope == 0) one_N = force_N.z();
    const double pushes = force_N.z() / one_N / both * 2;
    INFO("slope " << slope);
    CHECK(pushes >= last - 1e-9);
    CHECK(pushes <= 2 + 1e-9);
    if (slope <= 3e-3) CHECK(pushes < 1.01);
    if (slope >= 0.08) CHECK(pushes == Approx(2).epsilon(1e-9));  // discs two diameters apart
    last = pushes;
  }
}

TEST_CASE("a grain that crosses a shallow hollow seam feels no step") {
  const DemSettings s = heavy_settings();
  const double slope = 0.02, delta = 4e-6;
  const auto gutter = [&](double x, double) { return slope * std::abs(x); };
  const TriangleMesh mesh = sheet_mesh(0.01, 2, gutter);
  double last_N = 0, largest_step_N = 0, smallest_N = 1e9;
  for (int i = -400; i <= 400; ++i) {
    const double x_m = i * 0.5e-6;  // up to 200 um from the seam
    const double z_m = slope * std::abs(x_m) + (kRadius_m - delta) * std::sqrt(1 + slope * slope);
    BoundaryRig rig(s, {grain_at(0, 2 * kRadius_m, {x_m, 1e-4, z_m})});
    rig.boundary().add_mesh(mesh);
    rig.compute();
    const double force_N = rig.force_N().norm();
    if (last_N > 0) largest_step_N = std::max(largest_step_N, std::abs(force_N - last_N));
    last_N = force_N;
    smallest_N = std::min(smallest_N, force_N);
  }
  // A second push that came at once would be a step of the whole force.
  CHECK(largest_step_N < 0.05 * smallest_N);
}

TEST_CASE("a finely cut sphere pushes like a ball, from its centre outwards") {
  const DemSettings s = heavy_settings();
  const double ball_m = 8e-3, delta = 3e-5;
  const TriangleMesh ball = sphere_mesh(ball_m, 5);  // 8192 triangles, 0.2 to 0.4 mm wide
  double flattest_m = ball_m;                        // distance of a facet's plane from the centre
  for (const auto& t : ball.triangles) {
    const Facet f(ball.vertices_m[std::size_t(t[0])], ball.vertices_m[std::size_t(t[1])],
                  ball.vertices_m[std::size_t(t[2])]);
    flattest_m = std::min(flattest_m, f.normal.dot(f.a));
  }
  REQUIRE(ball_m - flattest_m < 0.5 * delta);
  const PairLaw<double> law = make_pair_law(s.grain_material, s.wall_material, s.grain_wall);
  const double flat = 4.0 / 3 * law.E_eff_Pa * std::sqrt(kRadius_m);  // N over overlap^(3/2)
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d n =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    BoundaryRig rig(s, {grain_at(0, 2 * kRadius_m, (ball_m + kRadius_m - delta) * n)});
    rig.boundary().add_mesh(ball);
    rig.compute();
    INFO("seed 5, shot " << i << ", direction " << n.transpose());
    // The surface lies between the ball and the flattest facet; so does the overlap, and the normal
    // is no further from the radius than that facet's corners are from its middle.
    const double force_N = rig.force_N().norm();
    CHECK(force_N <= (1 + 1e-9) * flat * std::pow(delta, 1.5));
    CHECK(force_N >= (1 - 1e-9) * flat * std::pow(delta - (ball_m - flattest_m), 1.5));
    CHECK(rig.force_N().normalized().dot(n) >= flattest_m / ball_m);
  }
}
