#include "tools/study/indenter.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/dem/sand_bed.h"

using namespace hoof::tools;
using namespace hoof::sim;

namespace {

constexpr double kDeg = std::numbers::pi / 180;

/// The bionic foot's middle segment and spines (sim/config/feet/bionic.toml).
FootGeometry sole() {
  FootGeometry g;
  g.middle = {0.175, 0.04, 0.04, 0.008};
  g.has_spines = true;
  g.spines.length_m = 0.01, g.spines.base_m = 0.006, g.spines.tip_m = 0.003;
  g.spines.rake_rad = 20 * kDeg;
  g.spines.middle_count_row = 5, g.spines.middle_pitch_m = 0.03;
  g.spines.middle_row_offset_m = 0.008;
  return g;
}

/// Upward force of one grain on a strip that it overlaps by 1 um, in a slice of 60 mm.
double force_N(const Indenter& strip, double x_m, double y_m, double top_z_m) {
  DemSettings s;
  s.low_m = {-0.05, -0.03, -0.03};
  s.high_m = {0.05, 0.03, 0.07};
  s.periodic = {true, true, false};
  s.grain_material = {178.5e6, 0.25, 2650};
  s.wall_material = {2020e6, 0.37, 1050};
  s.grain_grain = s.grain_wall = {0.5, 0.5, 0};
  s.gravity_m_s2.setZero();
  s.precision = Precision::kDouble;
  BedState state;
  Grain g;
  g.radius_m = 2e-3;
  g.p_m = {x_m, y_m, top_z_m - g.radius_m + 1e-6};
  state.grains.push_back(g);
  SandBed bed(s, state);
  for (const Indenter::Part& part : strip.parts) {
    bed.add_mesh(part.mesh, part.p_WB_m,
                 Eigen::Quaterniond(Eigen::AngleAxisd(part.yaw_rad, Eigen::Vector3d::UnitZ())));
  }
  bed.advance(1);
  return bed.take_load(0).impulse_W_Ns.z() / s.dt_s;
}

}  // namespace

TEST_CASE("an endless strip pushes a grain alike all along its length, its seam included") {
  const Indenter strip = make_strip(sole(), 0.06, false);
  const double middle_N = force_N(strip, 0, 0, 0);
  CHECK(middle_N > 0);
  for (int i = 0; i < 60; ++i) {
    const double y_m = (i - 30 + 0.37) * 1e-3;
    CAPTURE(y_m);
    CHECK(force_N(strip, 0, y_m, 0) == Approx(middle_N).epsilon(1e-6));
    CHECK(force_N(strip, 0.0113, y_m, 0) == Approx(middle_N).epsilon(1e-6));
  }
  // At the seam itself, from both sides.
  CHECK(force_N(strip, 0.003, 0.03 - 1e-9, 0) == Approx(middle_N).epsilon(1e-6));
  CHECK(force_N(strip, 0.003, -0.03, 0) == Approx(middle_N).epsilon(1e-6));
}

TEST_CASE("a strip is as wide as the sole, and no wider at its ends") {
  const Indenter strip = make_strip(sole(), 0.06, false);
  for (const double y_m : {0.0, 0.0299, -0.0299}) {
    CAPTURE(y_m);
    CHECK(force_N(strip, 0.0119, y_m, 0) > 0);   // the flat: 20 mm less 8 mm of rounding
    CHECK(force_N(strip, 0.0140, y_m, 0) == 0);  // the rounded edge is higher
    CHECK(force_N(strip, -0.0140, y_m, 0) == 0);
  }
}

TEST_CASE("spines of a strip stand as under the foot: staggered rows, all alike") {
  const Indenter strip = make_strip(sole(), 0.06, true);
  const double depth_m = 0.01 * std::cos(20 * kDeg);
  CHECK(strip.lowest_m() == Approx(-depth_m));
  // Tips 3 mm wide, raked back by length sin(rake) along the sole's length, which is y here; the
  // sole's left (+y) is the strip's -x.
  const double back_m = 0.01 * std::sin(20 * kDeg);
  double tip_N = 0;
  int tips = 0;
  for (const double x_m : {-0.008, 0.008}) {
    for (int i = 0; i < 4; ++i) {
      const double y_m = std::remainder(-0.0225 + 0.015 * i - back_m, 0.06);
      CAPTURE(x_m, y_m);
      const double here_N = force_N(strip, x_m, y_m, -depth_m);
      if (here_N == 0) continue;
      if (tips++ == 0) tip_N = here_N;
      CHECK(here_N == Approx(tip_N).epsilon(1e-6));
      CHECK(force_N(strip, -x_m, y_m, -depth_m) == 0);
    }
  }
  CHECK(tips == 4);
  CHECK(force_N(strip, 0, 0, -depth_m) == 0);
}

TEST_CASE("a slice must hold whole spine pitches; without spines any length will do") {
  CHECK_THROWS_WITH(make_strip(sole(), 0.07, true),
                    "a slice of 70 mm is no whole number of spine pitches of 30 mm");
  CHECK_THROWS(make_strip(sole(), 0.01, true));
  CHECK_NOTHROW(make_strip(sole(), 0.07, false));
}

TEST_CASE("a foot stands on its hinges, its toes opened outward") {
  Foot foot;
  foot.geometry = sole();
  foot.has_toes = foot.geometry.has_toes = true;
  foot.geometry.toe = {0.145, 0.025, 0.020, 0.04, 0.006, 0.025, 0.033};
  foot.geometry.spines.toe_count = 7, foot.geometry.spines.toe_pitch_m = 0.02;
  foot.hinges.left_F_m = {-0.0625, 0.033, 0};
  const Indenter open = make_foot(foot, 20 * kDeg, false);
  CHECK(open.name == "foot-plain-20deg");
  CHECK(open.lowest_m() == Approx(0).margin(1e-12));
  REQUIRE(open.parts.size() == 3);
  CHECK(open.parts[1].p_WB_m.y() == 0.033);
  CHECK(open.parts[1].yaw_rad == Approx(20 * kDeg));
  CHECK(open.parts[2].p_WB_m.y() == -0.033);
  CHECK(open.parts[2].yaw_rad == Approx(-20 * kDeg));
  CHECK(make_foot(foot, 0, true).lowest_m() == Approx(-0.01 * std::cos(20 * kDeg)));
}
