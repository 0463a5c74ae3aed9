// Which triangles are sole and spines, what the foot covers, what presses on it.

#include "tools/fields/foot_shape.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/multibody/shipped.h"
#include "tests/tools/fields/made_scene.h"
#include "tools/fields/sole_pressure.h"

using namespace hoof;
using namespace hoof::tests;
using namespace hoof::tools;

namespace {

constexpr double kDegree_rad = 3.14159265358979323846 / 180;

}  // namespace

TEST_CASE("the shipped foot has 24 spines and 142 cm2 of plan, less its tapering and rounding") {
  const sim::Foot foot = sim::shipped_foot("bionic");
  const FootShape shape = FootShape::of({foot.middle, foot.left_toe, foot.right_toe}, true);
  const double toe_rad = GENERATE(0.0, 30.0) * kDegree_rad;
  std::vector<sim::Pose> poses(3);
  const Eigen::Vector3d left_m = foot.hinges.left_F_m;
  poses[1] = {left_m, Eigen::Quaterniond(Eigen::AngleAxisd(toe_rad, Eigen::Vector3d::UnitZ()))};
  poses[2] = {{left_m.x(), -left_m.y(), 0}, poses[1].q_WB.conjugate()};
  const PlacedFoot placed(shape, poses);
  int spines = 0;
  double sole_m2 = 0;
  for (const FootTriangle& t : placed.triangles) {
    spines += t.part == FootPart::kSpine;
    if (t.part == FootPart::kSole) sole_m2 += t.area_m2 * -t.normal.z();
  }
  CHECK(spines == 24 * 12);
  CHECK(placed.lowest_m() == Approx(-0.010 * std::cos(20 * kDegree_rad)));
  const Footprint plan(placed, {Eigen::Vector3d(-0.2, -0.2, -0.1), Eigen::Vector3d(0.2, 0.2, 0.1)});
  // Middle 175 x 40, toes 145 x 22.5 mm: 135.25 cm2; cells of 1 mm along 1.5 m of border.
  CHECK(plan.foot_area_m2() == Approx(135.25e-4).epsilon(0.02));
  CHECK(sole_m2 < plan.foot_area_m2());
  CHECK(sole_m2 > 0.7 * plan.foot_area_m2());
  if (toe_rad == 0) {
    // Closed toes taper away from the middle: half a millimetre at the hinge, 3 mm at the tip.
    CHECK(plan.gap_area_m2() > 0);
    CHECK(plan.gap_area_m2() < 2 * 0.145 * 0.003);
  } else {
    // Two wedges from the hinge to the tip: about 1/2 (145 mm)^2 tan(30 degrees) each, cut off
    // where the middle segment ends; above half of that and below all of it.
    const double wedges_m2 = 0.145 * 0.145 * std::tan(toe_rad);
    CHECK(plan.gap_area_m2() > 0.5 * wedges_m2);
    CHECK(plan.gap_area_m2() < wedges_m2);
  }
  for (const double y_m : {-0.033, 0.0, 0.033}) {  // beside the hinge: right toe, middle, left toe
    CHECK(plan.at(-0.055, y_m) == (y_m < 0 ? 2 : y_m > 0 ? 1 : 0));
  }
}

TEST_CASE("without spines of its own a foot of several pieces has no spines") {
  sim::TriangleMesh mesh = box_mesh({-0.02, -0.02, 0}, {0.02, 0.02, 0.02});
  const sim::TriangleMesh small = box_mesh({-0.002, -0.002, -0.01}, {0.002, 0.002, 0.001});
  for (const auto& t : small.triangles) mesh.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  mesh.vertices_m.insert(mesh.vertices_m.end(), small.vertices_m.begin(), small.vertices_m.end());
  const auto count = [&](bool has_spines, FootPart part) {
    const FootShape shape = FootShape::of({mesh}, has_spines);
    return std::count(shape.parts[0].begin(), shape.parts[0].end(), part);
  };
  CHECK(count(true, FootPart::kSpine) == 12);
  CHECK(count(true, FootPart::kSole) == 2);
  CHECK(count(false, FootPart::kSpine) == 0);
  CHECK(count(false, FootPart::kSole) == 4);
}

TEST_CASE("a gap is between different bodies, as wide as they stand apart, either side alike") {
  const double side = GENERATE(-1.0, 1.0);
  const double low = std::min(side * 0.010, side * 0.030),
               high = std::max(side * 0.010, side * 0.030);
  const Made made({box_mesh({-0.02, -0.005, 0}, {0.02, 0.005, 0.01}),
                   box_mesh({-0.01, low, 0}, {0.02, high, 0.01})});
  const Footprint plan(PlacedFoot(made.setting.shape, made.moment.poses), made.setting.region_m);
  CHECK(plan.foot_area_m2() == Approx(0.04 * 0.01 + 0.03 * 0.02));
  CHECK(plan.gap_area_m2() == Approx(0.03 * 0.005));
  CHECK(plan.at(0.0, side * 0.0075) == Footprint::kGap);
  CHECK(plan.at(-0.015, side * 0.0075) == Footprint::kNone);
  CHECK(plan.at(0.0, side * 0.02) == 1);
  CHECK(plan.at(0.0, side * 0.035) == Footprint::kNone);
  CHECK(plan.at(1.0, 0.0) == Footprint::kNone);
}

TEST_CASE("pressure is the force over the triangle, its shares are of the plantar area") {
  Made made({box_mesh({-0.01, -0.02, 0}, {0.01, 0.02, 0.01})});
  made.press(made.grain({0.004, -0.001, -1.999e-3}), 0, 0, {0.004, -0.001, 0}, 3);
  made.press(made.grain({-0.004, 0.001, -1.999e-3}), 0, 1, {-0.004, 0.001, 0}, 0.5);
  const FieldScene scene(made.setting, made.moment);
  const auto pressure_Pa = triangle_pressure_Pa(scene);
  CHECK(pressure_Pa[0] == Approx(3 / 4e-4));
  CHECK(pressure_Pa[1] == Approx(0.5 / 4e-4));
  const SolePressure s = sole_pressure(scene);
  CHECK(s.plantar_area_m2 == Approx(8e-4));
  CHECK(s.normal_force_N == Approx(3.5));
  CHECK(scene.load_N() == Approx(3.5));
  CHECK(s.threshold_Pa == Approx(3.5 / 8e-4));
  CHECK(s.high_share == Approx(0.5));
  CHECK(s.touched_area_m2 == Approx(8e-4));
  CHECK(s.hertz_area_m2 == Approx(2 * 3.14159265 * 2e-3 * 1e-6));
  CHECK(s.spine_load_share == 0);
  CHECK(share_above(scene, pressure_Pa, 0.4 / 4e-4) == Approx(1));
  CHECK(share_above(scene, pressure_Pa, 4 / 4e-4) == 0);
  CHECK(pressure_of_share_Pa(scene, pressure_Pa, 0.3) == Approx(3 / 4e-4));
  CHECK(pressure_of_share_Pa(scene, pressure_Pa, 0.7) == Approx(0.5 / 4e-4));
}

TEST_CASE("the spines' share is of the vertical load, friction on their sides included") {
  sim::TriangleMesh mesh = box_mesh({-0.02, -0.02, 0}, {0.02, 0.02, 0.02});
  const sim::TriangleMesh small = box_mesh({-0.002, -0.002, -0.01}, {0.002, 0.002, 0.001});
  for (const auto& t : small.triangles) mesh.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  mesh.vertices_m.insert(mesh.vertices_m.end(), small.vertices_m.begin(), small.vertices_m.end());
  Made made({mesh}, true);
  made.press(made.grain({0.01, 0.01, -1.999e-3}), 0, 0, {0.01, 0.01, 0}, 3);
  made.press(made.grain({0.003999, 0, -5e-3}), 0, 12 + 10, {0.002, 0, -5e-3}, 7);
  made.moment.touches.back().f_tangential_N = {0, 0, -1};  // the grain is pushed down
  const FieldScene scene(made.setting, made.moment);
  CHECK(scene.load_N() == Approx(4));
  CHECK(sole_pressure(scene).spine_load_share == Approx(0.25));
  CHECK(std::isnan(
      sole_pressure(FieldScene(made.setting, Made({mesh}, true).moment)).spine_load_share));
}
