// Love-Weber stress against lattices and columns whose stress is known, and against the load on a
// bed of the real engine.

#include "tools/fields/sand_stress.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tools/fields/made_scene.h"
#include "tools/fields/sand_packing.h"
#include "tools/fields/stress_bulb.h"

using namespace hoof;
using namespace hoof::tests;
using namespace hoof::tools;

namespace {

constexpr double kRadius_m = 2e-3, kOverlap_m = 4e-6, kPitch_m = 2 * kRadius_m - kOverlap_m;

/// A simple cubic lattice of 5 x 5 x 5 grains about the origin that overlap along all three axes.
Made cubic_lattice() {
  Made made({box_mesh({-0.01, -0.01, 0.02}, {0.01, 0.01, 0.03})});
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      for (int k = -2; k <= 2; ++k) made.grain(kPitch_m * Eigen::Vector3d(i, j, k), kRadius_m);
    }
  }
  made.touch_all();
  return made;
}

}  // namespace

TEST_CASE("a cubic lattice has the stress f / a^2 along each axis and six partners a grain") {
  const Made made = cubic_lattice();
  const FieldScene scene(made.setting, made.moment);
  const double expected_Pa = hertz_N(kRadius_m, kOverlap_m) / (kPitch_m * kPitch_m);
  // Any volume of whole cells, wherever its sides cut the branches.
  for (const double shift : {0.0, 0.3, -0.45}) {
    CAPTURE(shift);
    const Eigen::Vector3d middle = kPitch_m * Eigen::Vector3d(shift, -shift, 0.5 * shift);
    const Eigen::Vector3d half = kPitch_m * Eigen::Vector3d(1, 0.5, 1);
    const Eigen::Matrix3d sigma_Pa = box_stress_Pa(scene.lines, {middle - half, middle + half});
    // Rounding of places against overlaps: 1e-18 m of 4e-6.
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        CHECK(sigma_Pa(a, b) == Approx(a == b ? expected_Pa : 0).margin(1e-9 * expected_Pa));
      }
    }
  }
  const double inner_m = 1.5 * kPitch_m;
  const Coordination inside = coordination(
      scene, [&](const Eigen::Vector3d& p_m) { return p_m.cwiseAbs().maxCoeff() < inner_m; });
  CHECK(inside.grains == 27);
  CHECK(inside.mean == 6);
  CHECK(inside.mechanical == 6);
  // 300 contacts of 125 grains.
  const Coordination all = coordination(scene, [](const Eigen::Vector3d&) { return true; });
  CHECK(all.mean == Approx(2 * 300.0 / 125));
}

TEST_CASE("pulling contacts give tension and a leaning contact shears") {
  const double lean = GENERATE(-1.0, 1.0);
  ForceLine line;
  line.from_m = {0, 0, 0};
  line.to_m = Eigen::Vector3d(lean, 0, -1) * 1e-3;
  line.f_N = 5 * (line.from_m - line.to_m).normalized();
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-2e-3), Eigen::Vector3d::Constant(2e-3));
  const double expected_Pa = 5 * std::sqrt(0.5) * 1e-3 / box.volume();
  CHECK(box_stress_Pa({line}, box)(2, 2) == Approx(expected_Pa));
  CHECK(box_stress_Pa({line}, box)(0, 2) == Approx(-lean * expected_Pa));
  line.f_N = -line.f_N;
  CHECK(box_stress_Pa({line}, box)(2, 2) == Approx(-expected_Pa));
}

TEST_CASE("a column under a plate passes the plate's force through every layer") {
  // From the plate at z = 0 down to the floor at -30 mm: the load is the same at every height, as
  // nothing is weighed here.
  const double load_N = hertz_N(kRadius_m, kOverlap_m);
  Made made({box_mesh({-0.01, -0.01, 0}, {0.01, 0.01, 0.01})});
  const double first_m = -kRadius_m + 1e-6;
  for (int k = 0; k < 5; ++k) made.grain({1e-4, 2e-4, first_m - k * kPitch_m}, kRadius_m);
  made.touch_all();
  made.press(0, 0, 0, {1e-4, 2e-4, 0}, load_N);
  const FieldScene scene(made.setting, made.moment);
  CHECK(scene.load_N() == Approx(load_N));
  const double layer_m = 3.3e-3, bottom_m = first_m - 4 * kPitch_m;
  for (double top_m = 0; top_m - layer_m > bottom_m; top_m -= layer_m) {
    CAPTURE(top_m);
    const Eigen::AlignedBox3d layer(Eigen::Vector3d(-0.01, -0.01, top_m - layer_m),
                                    Eigen::Vector3d(0.01, 0.01, top_m));
    CHECK(box_stress_Pa(scene.lines, layer)(2, 2) * 4e-4 == Approx(load_N).epsilon(1e-9));
  }
  // In layers below the plan: in sixteenths of a branch, so to 1 / 16 of a branch over a layer.
  const LayerForces forces = layer_forces(scene.lines, scene.plan, 0, layer_m, 5);
  for (std::size_t k = 0; k < 5; ++k) {
    CAPTURE(k);
    CHECK(forces.foot_N[k] == Approx(load_N).epsilon(kPitch_m / 16 / layer_m));
    CHECK(forces.gap_N[k] == 0);
  }
}

TEST_CASE("a bulb's shares are of the load, less what was there, and none of a load too small") {
  const double load_N = hertz_N(kRadius_m, kOverlap_m);
  Made made({box_mesh({-0.01, -0.01, 0}, {0.01, 0.01, 0.01})});
  const double first_m = -kRadius_m + 1e-6;
  for (int k = 0; k < 5; ++k) made.grain({1e-4, 2e-4, first_m - k * kPitch_m}, kRadius_m);
  made.touch_all();
  Made before = made;
  before.moment.sand.contacts.clear();
  made.press(0, 0, 0, {1e-4, 2e-4, 0}, load_N);
  const FieldScene scene(made.setting, made.moment), empty(before.setting, before.moment);
  const StressBulb bulb = stress_bulb(scene, empty);
  CHECK(bulb.nominal_Pa == Approx(load_N / 4e-4));
  CHECK(bulb.layer_m == 2e-3);
  REQUIRE(bulb.share.size() == 15);  // to the region's floor at -30 mm
  // The column ends at -18 mm, its last centre at -18 mm: nine whole layers.
  for (std::size_t k = 0; k < 8; ++k) CHECK(bulb.share[k] == Approx(1).epsilon(0.13));
  for (std::size_t k = 10; k < 15; ++k) CHECK(bulb.share[k] == 0);
  REQUIRE(bulb.depth_m);
  CHECK(*bulb.depth_m == Approx(0.018).margin(0.002));
  CHECK(bulb.gap_share.empty());
  // What was there before is not the foot's.
  Made same = made;
  same.moment.touches.clear();
  const FieldScene with_column(same.setting, same.moment);
  CHECK(stress_bulb(scene, with_column).share[4] == Approx(0).margin(1e-12));
  // Five grains weigh 4.4 mN.
  made.moment.touches.clear();
  made.press(0, 0, 0, {1e-4, 2e-4, 0}, 0.004);
  CHECK(stress_bulb(FieldScene(made.setting, made.moment), empty).share.empty());
}

TEST_CASE("the whole load on a bed goes down through every layer of it") {
  // Periodic sides, so that no wall takes a part; a plate as wide as the box, pressed in and held
  // until all is at rest.
  sim::BedSettings bed = sim::test::small_bed();
  bed.periodic_sides = true;
  const sim::BedState settled = sim::test::make_small_bed(bed);
  sim::SandBed sand(sim::dem_settings(bed, sim::test::shipped_materials(), 1), settled);
  Made made({box_mesh({-0.015, -0.015, 0}, {0.015, 0.015, 0.01})});
  const double speed_m_s = 0.05, press_s = 0.04;
  const int press_steps = int(press_s * 160e3);
  Eigen::Vector3d at_m(0, 0, 0);
  sand.add_mesh(made.setting.shape.meshes[0], at_m, Eigen::Quaterniond::Identity());
  sand.set_motion(0, {at_m, Eigen::Quaterniond::Identity(), {0, 0, -speed_m_s}});
  sand.advance(press_steps);
  at_m.z() -= speed_m_s * press_s;
  sand.set_motion(0, {at_m, Eigen::Quaterniond::Identity()});
  sand.set_viscous_rate(200);  // a grain's own free fall takes 0.02 s over its diameter
  sand.advance(12000);
  made.moment.poses[0].p_WB_m = at_m;
  made.moment.sand = sand.state();
  made.moment.touches = sand.mesh_touches();
  made.setting.dem = sand.settings();
  const FieldScene scene(made.setting, made.moment);
  const double load_N = scene.load_N();
  REQUIRE(load_N > 5);  // the bed itself weighs 1.6 N
  sand.take_load(0);
  sand.advance(1);
  const double felt_N = sand.take_load(0).impulse_W_Ns.z() / sand.settings().dt_s;
  CHECK(load_N == Approx(felt_N).epsilon(1e-3));  // springs move on by one step
  for (const double top_m : {-0.008, -0.014, -0.020}) {
    CAPTURE(top_m);
    const double layer_m = 0.005;
    double weight_N = 0;  // of what is above the middle of the layer
    for (const sim::Grain& g : made.moment.sand.grains) {
      if (g.p_m.z() > top_m - 0.5 * layer_m) weight_N += 9.81 * scene.mass_kg(g);
    }
    // Branches across the sides leave the box by up to a grain.
    const Eigen::AlignedBox3d layer(Eigen::Vector3d(-0.04, -0.04, top_m - layer_m),
                                    Eigen::Vector3d(0.04, 0.04, top_m));
    const double passed_N = box_stress_Pa(scene.lines, layer)(2, 2) * 0.08 * 0.08;
    // A few grains still rattle, and weight steps by whole grains of 5 mN.
    CHECK(passed_N == Approx(load_N + weight_N).epsilon(0.01));
  }
}

TEST_CASE("the cut through a lattice has the stress of its cells") {
  const Made made = cubic_lattice();
  const FieldScene scene(made.setting, made.moment);
  const Eigen::Vector3d half = 1.5 * kPitch_m * Eigen::Vector3d::Ones();
  const StressCut cut = stress_cut(scene.lines, {-half, half * (1 + 1e-9)}, kPitch_m);
  REQUIRE(cut.columns == 3);
  REQUIRE(cut.rows == 3);
  for (const double zz_Pa : cut.zz_Pa) {
    CHECK(zz_Pa == Approx(hertz_N(kRadius_m, kOverlap_m) / (kPitch_m * kPitch_m)));
  }
}

TEST_CASE("a uniform stress has its own area as support, above and by participation") {
  const Made made = cubic_lattice();
  const FieldScene scene(made.setting, made.moment);
  const double sigma_Pa = hertz_N(kRadius_m, kOverlap_m) / (kPitch_m * kPitch_m);
  const Eigen::Vector3d half(2.5 * kPitch_m, 2.5 * kPitch_m, 0.5 * kPitch_m);
  const Eigen::AlignedBox3d layer(-half, half * (1 + 1e-9));
  const double area_m2 = 25 * kPitch_m * kPitch_m;
  const SupportArea low = support_area(scene.lines, {}, layer, kPitch_m, 0.9 * sigma_Pa);
  CHECK(low.above_m2 == Approx(area_m2));
  CHECK(low.participation_m2 == Approx(area_m2));
  CHECK(support_area(scene.lines, {}, layer, kPitch_m, 1.1 * sigma_Pa).above_m2 == 0);
  // What was there before counts as nothing.
  CHECK(support_area(scene.lines, scene.lines, layer, kPitch_m, 0).above_m2 == 0);
}

TEST_CASE("a bulb ends where its shares fall below the edge for good") {
  CHECK(*bulb_depth_m({1.0, 0.5, 0.15, 0.05}, 0.01, 0.1) == Approx(0.03));
  CHECK(*bulb_depth_m({1.0, 0.05, 0.3, 0.1, 0.0}, 0.01, 0.1) == Approx(0.035));
  CHECK(*bulb_depth_m({0.05, 0.02}, 0.01, 0.1) == 0);
  CHECK_FALSE(bulb_depth_m({1.0, 0.5, 0.2}, 0.01, 0.1).has_value());
  CHECK(bulb_depth_m({}, 0.01, 0.1) == 0.0);
}
