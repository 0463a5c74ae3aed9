#include "sim/multibody/foot_geometry.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/multibody/mass_properties.h"
#include "sim/multibody/mesh_fault.h"

using namespace hoof::sim;

namespace {

FootGeometry paper_geometry() {
  FootGeometry g;
  g.middle = {0.175, 0.040, 0.040, 0.008};
  g.has_toes = true;
  g.toe = {0.145, 0.025, 0.020, 0.040, 0.006, 0.025, 0.033};
  g.has_spines = true;
  g.spines = {0.010, 0.006, 0.003, 20.0 * std::numbers::pi / 180.0, 7, 0.020, 5, 0.030, 0.008};
  return g;
}

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh.vertices_m) box.extend(v);
  return box;
}

}  // namespace

TEST_CASE("a plain sole has the volume of a block with rounded bottom edges") {
  FootGeometry g = paper_geometry();
  g.has_spines = false;
  const TriangleMesh mesh = make_middle(g);
  REQUIRE_FALSE(find_mesh_fault(mesh));
  const auto& [l, w, h, r] = g.middle;
  // At height z the section is inset by i(z) on all sides. The mesh's arc has four facets, between
  // which i is linear and the area (l - 2i)(w - 2i) quadratic in z: Simpson's rule is exact.
  const double pi = std::numbers::pi;
  double facetted = l * w * (h - r);
  for (int k = 0; k < 4; ++k) {
    const double a = k * pi / 8;
    const double b = (k + 1) * pi / 8;
    const double i0 = r * (1 - std::sin(a));
    const double i1 = r * (1 - std::sin(b));
    const auto area = [l = l, w = w](double i) { return (l - 2 * i) * (w - 2 * i); };
    facetted +=
        r * (std::cos(a) - std::cos(b)) / 6 * (area(i0) + 4 * area((i0 + i1) / 2) + area(i1));
  }
  CHECK(volume_m3(mesh) == Approx(facetted).epsilon(1e-12));
  // The true arc, i(z) = r - sqrt(r^2 - (r-z)^2), integrated; the facets lie inside of it.
  const double round =
      l * w * h - 2 * (l + w) * r * r * (1 - pi / 4) + 4 * r * r * r * (5.0 / 3.0 - pi / 2);
  CHECK(facetted < round);
  CHECK(facetted > 0.997 * round);

  const auto box = box_of(mesh);
  CHECK((box.min() - Eigen::Vector3d(-0.0875, -0.020, 0.0)).norm() < 1e-15);
  CHECK((box.max() - Eigen::Vector3d(0.0875, 0.020, 0.040)).norm() < 1e-15);
  CHECK(mesh.triangles.size() < 400);
}

TEST_CASE("spines are closed, raked to the rear and of the volume of a frustum") {
  FootGeometry g = paper_geometry();
  const TriangleMesh spined = make_middle(g);
  REQUIRE_FALSE(find_mesh_fault(spined));
  g.has_spines = false;
  const TriangleMesh plain = make_middle(g);
  const double one = (volume_m3(spined) - volume_m3(plain)) / 10.0;
  // Shear leaves the volume: h/3 (A + sqrt(A B) + B) over the height with the sunk part of 1 mm.
  const double depth = 0.010 * std::cos(g.spines.rake_rad);
  const double top = 0.006 + 0.003 * 0.001 / depth;
  const double frustum = (depth + 0.001) / 3.0 * (top * top + top * 0.003 + 0.003 * 0.003);
  CHECK(one == Approx(frustum).epsilon(1e-9));
  CHECK(spined.triangles.size() == plain.triangles.size() + 10 * 12);
  CHECK(box_of(spined).min().z() == Approx(-depth).epsilon(1e-12));

  // Mean of the tips lies behind the mean of the feet of the spines by length sin(rake).
  double tip_x = 0.0;
  int tips = 0;
  for (const auto& v : spined.vertices_m) {
    if (v.z() < -0.9 * depth) tip_x += v.x(), ++tips;
  }
  REQUIRE(tips == 40);
  CHECK(tip_x / tips == Approx(-0.010 * std::sin(g.spines.rake_rad)).epsilon(1e-9));
}

TEST_CASE("a toe tapers from its hinge forward and is symmetric") {
  const FootGeometry g = paper_geometry();
  const TriangleMesh mesh = make_toe(g);
  REQUIRE_FALSE(find_mesh_fault(mesh));
  const auto box = box_of(mesh);
  CHECK(box.min().x() == Approx(0.0).margin(1e-15));
  CHECK(box.max().x() == Approx(0.145));
  CHECK(box.min().y() == Approx(-box.max().y()));
  CHECK(box.max().y() == Approx(0.0125));
  CHECK(solid(mesh, 1.0).com_B_m.y() == Approx(0.0).margin(1e-12));
  FootGeometry plain = g;
  plain.has_spines = false;
  CHECK(make_toe(plain).triangles.size() < 400);
  // Trapezoid, 22.5 mm wide in the mean, less its rounded edges (checked on the middle).
  const double block = 0.145 * 0.0225 * 0.040;
  CHECK(volume_m3(make_toe(plain)) < block);
  CHECK(volume_m3(make_toe(plain)) > 0.97 * block);
}

TEST_CASE("impossible lengths are refused by name") {
  const auto refused = [](void (*change)(FootGeometry&)) {
    FootGeometry g = paper_geometry();
    change(g);
    try {
      g.validate();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(refused([](FootGeometry&) {}) == "accepted");
  CHECK(refused([](FootGeometry& g) {
          g.middle.edge_radius_m = 0.03;
        }).starts_with("middle.edge_radius = 30 mm: must be above 0 and at most"));
  CHECK(refused([](FootGeometry& g) { g.middle.length_m = 0.02; }).starts_with("middle.length"));
  CHECK(refused([](FootGeometry& g) {
          g.toe.hinge_lateral_m = 0.030;
        }).starts_with("toe.hinge_lateral = 30 mm"));
  CHECK(refused([](FootGeometry& g) { g.toe.tip_width_m = 0.03; }).starts_with("toe.tip_width"));
  CHECK(refused([](FootGeometry& g) {
          g.toe.edge_radius_m = 0.0095;
        }).starts_with("toe.edge_radius"));
  CHECK(refused([](FootGeometry& g) { g.spines.tip_m = 0.007; }).starts_with("spines.tip = 7 mm"));
  CHECK(refused([](FootGeometry& g) {
          g.spines.toe_pitch_m = 0.022;
        }).starts_with("spines.toe_pitch"));
  CHECK(refused([](FootGeometry& g) {
          g.spines.toe_pitch_m = 0.005;
        }).starts_with("spines.toe_pitch"));
  CHECK(refused([](FootGeometry& g) {
          g.spines.middle_pitch_m = 0.04;
        }).starts_with("spines.middle_pitch"));
  CHECK(refused([](FootGeometry& g) {
          g.spines.middle_row_offset_m = 0.012;
        }).starts_with("spines.middle_row_offset"));
}
