// What VTK's own reader (package python3-vtk9) makes of our files. Where it is not installed CTest
// lists these tests as skipped.

#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <numbers>
#include <sstream>
#include <string>

#include "tests/sim/terrain/small_bed.h"
#include "tests/tools/bed/vtk_reading.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/bed/grain_export.h"

using namespace hoof;
using namespace hoof::tools;
using namespace hoof::tests;

namespace {

sim::DemSettings settings() {
  return sim::dem_settings(sim::test::small_bed(), sim::test::shipped_materials(), 1);
}

/// Two grains that touch, one of them in the floor, and one far away.
sim::BedState three_grains() {
  sim::BedState state;
  state.grains = {{0, 2e-3, {0.001, 0.002, -0.030 + 1.99e-3}, {0.1, -0.2, 0.3}, {1, 2, -3}},
                  {2, 1e-3, {0.001, 0.002 + 2.995e-3, -0.030 + 1.99e-3}, {0, 0, 0}, {0, 0, 0}},
                  {5, 1e-3, {-0.02, -0.02, -0.01}, {0, 0, -1}, {0, 0, 4}}};
  state.contacts = {{0, 2, Eigen::Vector3d::Zero()},
                    {0, sim::GrainContact::kWallContact, Eigen::Vector3d(1e-7, 0, 0)}};
  return state;
}

}  // namespace

TEST_CASE("VTK reads grains, contacts and a mesh of a series as they were written") {
  const ScratchFolder scratch;
  const sim::BedState state = three_grains();
  const sim::DemSettings dem = settings();
  VtkSeries series(scratch.path() / "vtk", "bed");
  sim::TriangleMesh mesh;
  mesh.vertices_m = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.02, 0}, {0, 0, 0.03}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const Eigen::Quaterniond quarter(
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  series.add(0, "grains", grain_points(dem, state, {}));
  series.add(0, "contacts", contact_lines(dem, state, {}));
  series.add(0.25, "foot", mesh_triangles(mesh, {0.1, 0, 0}, quarter));

  const VtkReading reading = read_with_vtk(series.collection());
  if (reading.status == 77) return;
  INFO(reading.text);
  REQUIRE(reading.status == 0);
  const std::size_t contacts_at = reading.text.find("at 0 contacts contacts-00000.vtp");
  const std::size_t foot_at = reading.text.find("at 0.25 foot foot-00001.vtp");
  REQUIRE(reading.text.starts_with("at 0 grains grains-00000.vtp"));
  REQUIRE(contacts_at != std::string::npos);
  REQUIRE(foot_at != std::string::npos);
  const std::string grains = reading.text.substr(0, contacts_at);
  const std::string contacts = reading.text.substr(contacts_at, foot_at - contacts_at);
  const std::string foot = reading.text.substr(foot_at);

  std::vector<double> p, v, w, f;
  const auto loaded = sim::loaded_contacts(dem, state);
  const auto f_N = sim::forces_on_grains(state, loaded);
  for (std::size_t i = 0; i < 3; ++i) {
    const sim::Grain& g = state.grains[i];
    p.insert(p.end(), g.p_m.begin(), g.p_m.end());
    v.insert(v.end(), g.v_m_s.begin(), g.v_m_s.end());
    w.insert(w.end(), g.w_rad_s.begin(), g.w_rad_s.end());
    f.insert(f.end(), f_N[i].begin(), f_N[i].end());
  }
  require_near(numbers_below(grains, "points 3"), p);
  require_near(numbers_below(grains, "verts 3 lines 0 polys 0"), {0, 1, 2});
  require_near(numbers_below(grains, "point array id int 1"), {0, 2, 5});
  require_near(numbers_below(grains, "point array type int 1"), {1, 1, 1});
  require_near(numbers_below(grains, "point array radius float 1"), {2e-3, 1e-3, 1e-3});
  require_near(numbers_below(grains, "point array v float 3"), v);
  require_near(numbers_below(grains, "point array omega float 3"), w);
  require_near(numbers_below(grains, "point array f float 3"), f);
  CHECK(f_N[0].z() > 0);  // from the floor
  CHECK(f_N[2].norm() == 0);

  REQUIRE(loaded.size() == 2);
  const Eigen::Vector3d a = state.grains[0].p_m, b = state.grains[1].p_m;
  require_near(numbers_below(contacts, "points 4"), {a.x(), a.y(), a.z(), b.x(), b.y(), b.z(),
                                                     a.x(), a.y(), a.z(), a.x(), a.y(), -0.030});
  require_near(numbers_below(contacts, "verts 0 lines 2 polys 0"), {0, 1, 2, 3});
  require_near(numbers_below(contacts, "cell array id1 int 1"), {0, 0});
  require_near(numbers_below(contacts, "cell array id2 int 1"), {2, -1});
  require_near(numbers_below(contacts, "cell array delta float 1"), {5e-6, 1e-5});
  std::vector<double> force, normal, tangential;
  for (const sim::LoadedContact& c : loaded) {
    const Eigen::Vector3d sum = c.f_normal_N + c.f_tangential_N;
    force.insert(force.end(), sum.begin(), sum.end());
    normal.insert(normal.end(), c.f_normal_N.begin(), c.f_normal_N.end());
    tangential.insert(tangential.end(), c.f_tangential_N.begin(), c.f_tangential_N.end());
  }
  require_near(numbers_below(contacts, "cell array force float 3"), force);
  require_near(numbers_below(contacts, "cell array force_normal float 3"), normal);
  require_near(numbers_below(contacts, "cell array force_tangential float 3"), tangential);

  // A quarter turn to the left: x becomes y, y becomes -x; then 0.1 m along x. The origin's image
  // has a y of 1e-18 where it is not exact.
  const std::vector<double> corners = numbers_below(foot, "points 4");
  const std::vector<double> wanted = {0.1, 0, 0, 0.1, 0.01, 0, 0.08, 0, 0, 0.1, 0, 0.03};
  REQUIRE(corners.size() == wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    CHECK(corners[i] == Approx(wanted[i]).margin(1e-8));
  }
  require_near(numbers_below(foot, "verts 0 lines 0 polys 4"),
               {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
}

TEST_CASE("VTK reads a selection without grains") {
  const ScratchFolder scratch;
  GrainSelection nothing;
  nothing.region = {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(2, 2, 2)};
  write_vtp(scratch.path() / "none.vtp", contact_lines(settings(), three_grains(), nothing));
  const VtkReading reading = read_with_vtk(scratch.path() / "none.vtp");
  if (reading.status == 77) return;
  INFO(reading.text);
  CHECK(reading.status == 0);
  CHECK(reading.text.starts_with("points 0\n"));
}
