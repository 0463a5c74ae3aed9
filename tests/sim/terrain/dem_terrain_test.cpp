#include "sim/terrain/dem_terrain.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "sim/terrain/bed_maker.h"
#include "tests/sim/dem/paper_bed.h"
#include "tests/sim/terrain/small_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

constexpr double kExchange_s = 50e-6;
constexpr double kDt_s = 2.5e-6;  // 20 steps in an exchange

Pose pose(const Eigen::Vector3d& p_m, double turn_rad = 0,
          const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  return {p_m, Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, axis))};
}

Wrench advance(DemTerrain& ground, const Pose& start, const Pose& end,
               double interval_s = kExchange_s) {
  const std::array<BodyMotion, 1> motion{{{start, end}}};
  std::array<Wrench, 1> wrench;
  ground.advance(interval_s, motion, wrench);
  return wrench[0];
}

/// One grain in free space, without gravity.
DemSettings one_grain_settings() {
  DemSettings s = paper_settings();
  s.dt_s = kDt_s;
  s.precision = Precision::kDouble;
  return s;
}

DemTerrain one_grain(const Eigen::Vector3d& p_m,
                     const Eigen::Vector3d& v_m_s = Eigen::Vector3d::Zero()) {
  BedState state;
  state.grains = {grain_at(0, 4e-3, p_m, v_m_s)};
  return DemTerrain(one_grain_settings(), state);
}

/// Work of a wrench on its body, the torque about the mean place of the body's origin.
double work_J(const Wrench& w, const Pose& start, const Pose& end) {
  const Eigen::AngleAxisd turn(end.q_WB * start.q_WB.conjugate());
  return w.f_W_N.dot(end.p_WB_m - start.p_WB_m) + w.tau_Bo_W_Nm.dot(turn.angle() * turn.axis());
}

}  // namespace

TEST_CASE("an interval that is no whole number of steps is refused with both settings") {
  DemTerrain ground = one_grain({0, 0, 0});
  ground.add_body(box_mesh({0.01, 0.01, 0.01}), pose({0, 0, 0.03}));
  const Pose still = pose({0, 0, 0.03});
  CHECK_THROWS_WITH(advance(ground, still, still, 51e-6),
                    Catch::Contains("coupling.exchange_us = 51.0") &&
                        Catch::Contains("is not a whole number of bed steps of 2.5") &&
                        Catch::Contains("change bed.steps_per_ms"));
  CHECK_THROWS_WITH(advance(ground, still, still, 1e-6), Catch::Contains("coupling.exchange_us"));
  CHECK(ground.bed().health().steps == 0);
  CHECK_NOTHROW(advance(ground, still, still, 47.5e-6));
  CHECK(ground.bed().health().steps == 19);
}

TEST_CASE("every step a terrain takes passes the time of the exchange") {
  // 1/360 ms is no binary number: 18 of them are 50 us but for rounding.
  DemSettings s = one_grain_settings();
  s.dt_s = 1e-3 / 360;
  BedState state;
  state.grains = {grain_at(0, 4e-3, {0, 0, 0}, {0.1, 0, 0})};
  DemTerrain ground(s, state);
  ground.add_body(box_mesh({0.001, 0.001, 0.001}), pose({0, 0, 0.03}));
  for (int i = 0; i < 20; ++i) advance(ground, pose({0, 0, 0.03}), pose({0, 0, 0.03}));
  CHECK(ground.bed().health().steps == 360);
  CHECK(ground.bed().state().grains[0].p_m.x() == Approx(1e-4).epsilon(1e-9));
}

TEST_CASE("a grain's blow arrives on the body as its change of momentum and of spin") {
  // The grain flies at the box's top face, off the middle by `off` along x or y.
  const double off = GENERATE(-6e-3, 6e-3);
  const int axis = GENERATE(0, 1);
  const Eigen::Vector3d place = off * Eigen::Vector3d::Unit(axis);
  DemTerrain ground = one_grain(place + Eigen::Vector3d(0, 0, 0.01 + 2e-3 + 1e-6), {0, 0, -0.3});
  const Pose still = pose({0, 0, 0});
  ground.add_body(box_mesh({0.01, 0.01, 0.01}), still);
  Eigen::Vector3d impulse(0, 0, 0), twist(0, 0, 0);
  for (int i = 0; i < 20; ++i) {
    const Wrench w = advance(ground, still, still);
    impulse += w.f_W_N * kExchange_s;
    twist += w.tau_Bo_W_Nm * kExchange_s;
  }
  const Grain end = ground.bed().state().grains[0];
  CHECK(end.v_m_s.z() > 0);
  const double lost = grain_mass_kg(4e-3) * (-0.3 - end.v_m_s.z());
  CHECK(impulse.z() == Approx(lost).epsilon(1e-6));
  // r x F with F down the z axis: (y Fz, -x Fz, 0).
  const Eigen::Vector3d expected(place.y() * lost, -place.x() * lost, 0);
  CHECK((twist - expected).norm() < 1e-6 * expected.norm());
  CHECK(ground.work_on_bodies_J() == 0);
}

TEST_CASE("the turning of a body is followed: a paddle hits a grain at its tip's speed") {
  // A long paddle turns about z, either way, by 9 degrees and meets a resting grain 15 mm out.
  const double rate_rad_s = GENERATE(-20.0, 20.0);
  const double side = rate_rad_s > 0 ? 1 : -1;
  DemTerrain ground = one_grain({15e-3, side * (1e-3 + 2e-3 + 1.5e-3), 0});
  ground.add_body(box_mesh({0.02, 0.001, 0.005}), pose({0, 0, 0}));
  double integral_J = 0;
  const auto at = [&](int i) { return pose({0, 0, 0}, rate_rad_s * i * kExchange_s); };
  double twist = 0;
  for (int i = 0; i < 200; ++i) {
    const Wrench w = advance(ground, at(i), at(i + 1));
    integral_J += work_J(w, at(i), at(i + 1));
    twist += w.tau_Bo_W_Nm.z() * kExchange_s;
  }
  const Grain end = ground.bed().state().grains[0];
  // Restitution 0.5636 against the paddle's own speed of about 0.3 m/s along its face's normal.
  // They meet after 5.7 degrees: the grain has then left the middle of the paddle by 1.5 mm of the
  // 15, on which its lever depends. 4 %: the way across the paddle's half thickness adds to it.
  CHECK(end.v_m_s.norm() == Approx(20 * 15e-3 * 1.5636).epsilon(0.04));
  CHECK(side * end.v_m_s.y() > 0);
  CHECK(side * twist < 0);  // the grain holds the paddle back
  CHECK(ground.work_on_bodies_J() < 0);
  CHECK(ground.work_on_bodies_J() == Approx(integral_J).epsilon(1e-9));
}

TEST_CASE("work on a body that moves and turns is the wrench times its motion") {
  const double v = GENERATE(-0.4, 0.4);
  // The box slides through and turns while a grain flies against its face.
  DemTerrain ground = one_grain({v > 0 ? 13e-3 : -13e-3, 3e-3, 0}, {-v, 0, 0});
  const auto at = [&](int i) {
    const double t_s = i * kExchange_s;
    return pose({v * t_s, 0.05 * t_s, 0}, 5 * t_s, Eigen::Vector3d(1, 2, 3).normalized());
  };
  ground.add_body(box_mesh({0.01, 0.01, 0.01}), at(0));
  double integral_J = 0;
  for (int i = 0; i < 100; ++i)
    integral_J += work_J(advance(ground, at(i), at(i + 1)), at(i), at(i + 1));
  CHECK(ground.work_on_bodies_J() < 0);
  CHECK(ground.work_on_bodies_J() == Approx(integral_J).epsilon(1e-9));
}

TEST_CASE("two bodies feel each its own grains") {
  BedState state;
  state.grains = {grain_at(0, 4e-3, {-0.02, 0, 8e-3}, {0, 0, -0.3}),
                  grain_at(1, 4e-3, {0.02, 0, -8e-3}, {0, 0, 0.3})};
  DemTerrain ground(one_grain_settings(), state);
  const TriangleMesh box = box_mesh({0.005, 0.005, 0.005});
  const Pose left = pose({-0.02, 0, 0}), right = pose({0.02, 0, 0});
  CHECK(ground.add_body(box, left) == 0);
  CHECK(ground.add_body(box, right) == 1);
  Eigen::Vector3d impulse[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (int i = 0; i < 200; ++i) {
    const std::array<BodyMotion, 2> motions{{{left, left}, {right, right}}};
    std::array<Wrench, 2> wrenches;
    ground.advance(kExchange_s, motions, wrenches);
    for (int b = 0; b < 2; ++b) impulse[b] += wrenches[b].f_W_N * kExchange_s;
  }
  CHECK(impulse[0].z() < 0);
  CHECK(impulse[1].z() == Approx(-impulse[0].z()).epsilon(1e-6));
}

TEST_CASE("sand pushes a plate up as it is pressed in, and carries a held one with its weight") {
  const BedSettings bed = small_bed();
  DemTerrain ground(dem_settings(bed, shipped_materials(), 1), make_small_bed(bed));
  const double half_height_m = 5e-3;
  const auto sole_at = [&](double z_m) { return pose({0, 0, z_m + half_height_m}); };
  ground.add_body(box_mesh({0.015, 0.015, half_height_m}), sole_at(1e-3));
  const double speed_m_s = 0.1;
  double z_m = 1e-3, integral_J = 0;
  Wrench w;
  while (z_m > -2e-3) {
    w = advance(ground, sole_at(z_m), sole_at(z_m - speed_m_s * kExchange_s));
    integral_J += w.f_W_N.z() * -speed_m_s * kExchange_s;
    z_m -= speed_m_s * kExchange_s;
  }
  CHECK(w.f_W_N.z() > 5);
  CHECK(ground.work_on_bodies_J() < -1e-3);
  CHECK(ground.work_on_bodies_J() == Approx(integral_J).epsilon(1e-9));

  // Held: it works no more; what it presses on is in balance, so the force stays positive and
  // steady.
  const double work_before_J = ground.work_on_bodies_J();
  const auto mean_force_N = [&](int intervals) {
    double sum = 0;
    for (int i = 0; i < intervals; ++i)
      sum += advance(ground, sole_at(z_m), sole_at(z_m)).f_W_N.z();
    return sum / intervals;
  };
  mean_force_N(1000);
  const double first_N = mean_force_N(500), second_N = mean_force_N(500);
  CHECK(first_N > 1);
  CHECK(second_N ==
        Approx(first_N).epsilon(0.02));  // sand under a held plate still creeps a little
  CHECK(ground.work_on_bodies_J() == work_before_J);
}

TEST_CASE("grains that lie on a held plate weigh on it: the mean force is their weight") {
  // Nine grains apart from each other on a wide plate.
  DemSettings s = paper_settings(0.012);
  s.gravity_m_s2 = {0, 0, -9.81};
  s.dt_s = kDt_s;
  s.viscous_rate_1_s = 20;
  BedState state;
  double weight_N = 0;
  for (std::uint32_t i = 0; i < 9; ++i) {
    state.grains.push_back(
        grain_at(i, 4e-3, {7e-3 * (i % 3) - 7e-3, 7e-3 * (i / 3) - 7e-3, 2.1e-3}));
    weight_N += grain_mass_kg(4e-3) * 9.81;
  }
  DemTerrain ground(s, state);
  const Pose still = pose({0, 0, -5e-3});
  ground.add_body(box_mesh({0.0119, 0.0119, 5e-3}), still);
  for (int i = 0; i < 4000; ++i) advance(ground, still, still);
  Eigen::Vector3d sum(0, 0, 0);
  for (int i = 0; i < 100; ++i) sum += advance(ground, still, still).f_W_N;
  // At rest but for tremor that 0.2 s of a medium leaves.
  CHECK(sum.z() / 100 == Approx(-weight_N).epsilon(1e-3));
  CHECK(sum.head<2>().norm() / 100 < 1e-3 * weight_N);
}

TEST_CASE("a ground that is put back goes on with the same bytes, on any number of threads") {
  const BedSettings bed = small_bed();
  const BedState state = make_small_bed(bed);
  const double half_height_m = 5e-3, step_m = 0.4 * kExchange_s;  // 0.4 m/s, downward and aside
  const auto sole_at = [&](int interval) {
    return pose({0.5 * interval * step_m, 0, 1e-3 + half_height_m - interval * step_m},
                1e-4 * interval, Eigen::Vector3d::UnitX());
  };
  const auto make = [&](int threads) {
    auto ground =
        std::make_unique<DemTerrain>(dem_settings(bed, shipped_materials(), threads), state);
    ground->add_body(box_mesh({0.015, 0.015, half_height_m}), sole_at(0));
    return ground;
  };
  const auto press = [&](DemTerrain& ground, int first, int last) {
    std::vector<double> trace;
    for (int i = first; i < last; ++i) {
      const Wrench w = advance(ground, sole_at(i), sole_at(i + 1));
      for (int axis = 0; axis < 3; ++axis) {
        trace.push_back(w.f_W_N[axis]), trace.push_back(w.tau_Bo_W_Nm[axis]);
      }
      trace.push_back(ground.work_on_bodies_J());
    }
    return trace;
  };
  // 5 mm deep, with sliding contacts and neighbours of long ago; then as far again, through
  // rebuilds of the lists.
  const int cut = 300, end = 600;
  const auto undisturbed = make(1);
  press(*undisturbed, 0, cut);
  const std::uint64_t rebuilds = undisturbed->bed().health().rebuilds;
  const std::string snapshot = undisturbed->snapshot();
  const std::vector<double> expected = press(*undisturbed, cut, end);
  REQUIRE(expected[expected.size() - 5] != 0);
  REQUIRE(undisturbed->bed().health().rebuilds > rebuilds);
  for (const int threads : {1, 2, 4}) {
    CAPTURE(threads);
    const auto resumed = make(threads);
    resumed->restore(snapshot);
    CHECK(resumed->snapshot() == snapshot);
    CHECK(press(*resumed, cut, end) == expected);
    CHECK(resumed->bed().state_hash() == undisturbed->bed().state_hash());
    CHECK(resumed->bed().health().steps == undisturbed->bed().health().steps);
    CHECK(resumed->bed().health().rebuilds == undisturbed->bed().health().rebuilds);
    CHECK(resumed->bed().health().deepest_boundary_ratio ==
          undisturbed->bed().health().deepest_boundary_ratio);
  }
  // Cut short it is refused.
  for (const std::size_t size : {std::size_t(0), std::size_t(7), std::size_t(100),
                                 snapshot.size() / 2, snapshot.size() - 1}) {
    CAPTURE(size);
    CHECK_THROWS_AS(make(1)->restore(std::string_view(snapshot).substr(0, size)),
                    std::runtime_error);
  }
}
