// A closed body has an inside: a grain whose centre is pressed through its surface is pushed back
// where it came from, and one that was put inside stays there.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "sim/dem/mesh_surface.h"
#include "tests/sim/dem/boundary_rig.h"
#include "tests/sim/dem/test_meshes.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

constexpr double kRadius_m = 1e-3;

DemSettings smooth_settings() {
  DemSettings s = paper_settings();
  s.grain_wall = {1, 0, 0};
  return s;
}

/// Leads a grain along a line to `end`, at rest at each place, so that only the springs act.
/// @return the force at the end
Eigen::Vector3d pressed(BoundaryRig& rig, const Eigen::Vector3d& end_m, int places) {
  const Eigen::Vector3d start_m = rig.p_m();
  const Domain domain = Domain::spanning(smooth_settings().low_m, smooth_settings().high_m, {});
  for (int i = 0; i <= places; ++i) {
    const Eigen::Vector3d p_m = start_m + double(i) / places * (end_m - start_m);
    auto& r = rig.record(0);
    double rest;
    r.x = domain.to_steps<double>(0, p_m.x(), rest);
    r.y = domain.to_steps<double>(1, p_m.y(), rest);
    r.z = domain.to_steps<double>(2, p_m.z(), rest);
    rig.compute();
    rig.boundary().advance((end_m - start_m).norm() / places);
  }
  return rig.force_N();
}

double hertz_N(const DemSettings& s, double overlap_m) {
  return 4.0 / 3 * make_pair_law(s.grain_material, s.wall_material, s.grain_wall).E_eff_Pa *
         std::sqrt(kRadius_m) * std::pow(overlap_m, 1.5);
}

}  // namespace

TEST_CASE("the push grows on when the centre passes a face, an edge or a corner") {
  const DemSettings s = smooth_settings();
  const double h = 0.005;
  const TriangleMesh box = box_mesh({h, h, h});
  const std::vector<std::pair<const char*, Eigen::Vector3d>> ways = {
      {"face", {0, 0, 1}}, {"edge", {1, 0, 1}}, {"corner", {1, 1, 1}}, {"other face", {0, -1, 0}}};
  for (const TriangleMesh& mesh : {box, refined(refined(refined(box)))}) {
    for (const auto& [what, way] : ways) {
      const Eigen::Vector3d place_m =
          h * way +
          Eigen::Vector3d(2e-4, 3e-4, -1e-4).cwiseProduct(Eigen::Vector3d::Ones() - way.cwiseAbs());
      for (const double depth_m : {0.5e-3, 0.999e-3, 1.001e-3, 1.3e-3, 1.9e-3}) {
        BoundaryRig rig(s, {grain_at(0, 2 * kRadius_m, place_m + 1.01 * kRadius_m * way)});
        rig.boundary().add_mesh(mesh);
        // Down to `depth` of the nearest face, centre first at 1.01 radii along each axis.
        const Eigen::Vector3d force_N = pressed(rig, place_m + (kRadius_m - depth_m) * way, 400);
        INFO(what << ", overlap " << depth_m);
        CHECK(force_N.dot(way.normalized()) > 0);
        if (way.norm() == 1) {
          CHECK((force_N - hertz_N(s, depth_m) * way).norm() < 1e-9 * force_N.norm());
        } else if (depth_m > kRadius_m) {
          // Inside, the nearest face pushes; equally near, the lower number does.
          CHECK(force_N.norm() == Approx(hertz_N(s, depth_m)).epsilon(1e-9));
        }
      }
    }
  }
}

TEST_CASE("a grain rammed through a face comes back the way it came, without a gain of energy") {
  DemSettings s = smooth_settings();
  s.dt_s = 2e-7;  // 400 m/s: an impact of some microseconds
  const double h = 0.005;
  for (const int sign : {-1, 1}) {
    BoundaryRig rig(s, {grain_at(0, 2 * kRadius_m, {3e-4, 1e-4, sign * (h + 1.01 * kRadius_m)},
                                 {0, 0, sign * -160.0})});
    rig.boundary().add_mesh(refined(box_mesh({h, h, h})));
    const double before_J = rig.kinetic_energy_J();
    double deepest_m = h;
    for (int i = 0; i < 400; ++i) {
      rig.step();
      deepest_m = std::min(deepest_m, sign * rig.p_m().z());
    }
    CHECK(deepest_m < h - 0.1 * kRadius_m);                      // its centre was inside
    CHECK(sign * rig.v_m_s().z() == Approx(160).epsilon(0.01));  // leapfrog of ~80 steps
    CHECK(rig.kinetic_energy_J() == Approx(before_J).epsilon(0.02));
    CHECK(rig.boundary().take_deepest_ratio() > 1.1);
  }
}

TEST_CASE("a grain put inside a body is kept inside by its faces") {
  const DemSettings s = smooth_settings();
  const double h = 0.005;
  BoundaryRig rig(s, {grain_at(0, 2 * kRadius_m, {0, 0, h - kRadius_m + 1e-6}, {0.3, 0.2, 0.5})});
  rig.boundary().add_mesh(refined(box_mesh({h, h, h})));
  for (int i = 0; i < 20; ++i) {
    rig.advance(1000);
    CHECK(rig.p_m().cwiseAbs().maxCoeff() < h - 0.9 * kRadius_m);
  }
  CHECK(rig.v_m_s().norm() == Approx(std::sqrt(0.38)).epsilon(0.02));  // elastic
}

TEST_CASE("an open sheet is touched from both sides alike") {
  const DemSettings s = smooth_settings();
  const TriangleMesh sheet = sheet_mesh(0.01, 4, [](double, double) { return 0.0; });
  CHECK_FALSE(MeshSurface(sheet).closed());
  for (const int sign : {-1, 1}) {
    BoundaryRig rig(s, {grain_at(0, 2 * kRadius_m, {1e-4, 0, sign * (kRadius_m - 1e-5)})});
    rig.boundary().add_mesh(sheet);
    rig.compute();
    CHECK(rig.force_N().z() == Approx(sign * hertz_N(s, 1e-5)).epsilon(1e-9));
  }
}

TEST_CASE("closed bodies are told from open ones, and from those cut at T-junctions") {
  CHECK(MeshSurface(box_mesh({1, 2, 3})).closed());
  CHECK(MeshSurface(sphere_mesh(1, 3)).closed());
  TriangleMesh two = box_mesh({1, 1, 1});  // two bodies in one mesh
  for (const auto& v : box_mesh({1, 1, 1}).vertices_m) two.vertices_m.push_back(v * 0.5);
  for (const auto& t : box_mesh({1, 1, 1}).triangles) {
    two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  }
  CHECK(MeshSurface(two).closed());
  TriangleMesh open = box_mesh({1, 1, 1});
  open.triangles.pop_back();
  CHECK_FALSE(MeshSurface(open).closed());
  TriangleMesh turned = box_mesh({1, 1, 1});
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  CHECK_FALSE(MeshSurface(turned).closed());
  TriangleMesh flat;
  flat.vertices_m = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.triangles = {{0, 1, 2}};
  CHECK_THROWS_AS(MeshSurface(flat), std::invalid_argument);
}

TEST_CASE("the grid finds the triangles that a search through all of them finds") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const TriangleMesh& mesh :
       {box_mesh({0.03, 0.002, 0.01}), sphere_mesh(0.01, 3),
        sheet_mesh(0.02, 9, [](double x, double y) { return 0.3 * x * std::sin(300 * y); })}) {
    const MeshSurface surface(mesh);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d p = 0.035 * Eigen::Vector3d(unit(random), unit(random), unit(random));
      const double reach_m = 1e-4 + 0.01 * std::abs(unit(random));
      std::vector<std::uint32_t> found = {7}, all = {7};
      surface.append_near(p, reach_m, found);
      for (std::uint32_t f = 0; f < surface.facet_count(); ++f) {
        const auto& t = mesh.triangles[f];
        const Facet facet(mesh.vertices_m[std::size_t(t[0])], mesh.vertices_m[std::size_t(t[1])],
                          mesh.vertices_m[std::size_t(t[2])]);
        if (closest_point(facet, p).to_p_m.norm() < reach_m) all.push_back(f);
      }
      INFO("seed 11, point " << p.transpose() << ", reach " << reach_m);
      CHECK(found == all);
      if (all.size() > 1) CHECK(surface.maybe_near(p, reach_m));
    }
    CHECK_FALSE(surface.maybe_near({0.1, 0, 0}, 0.01));
  }
}
