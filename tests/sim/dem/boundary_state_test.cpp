// What the boundary keeps from step to step: its lists, its energy account, its state as bytes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <span>

#include "tests/sim/dem/boundary_rig.h"
#include "tests/sim/dem/test_meshes.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

/// Grains that rain on a floor, a side wall and a turning box, in a bed that is periodic in y. They
/// do not see each other.
BoundaryRig rain(bool friction, bool account = false) {
  DemSettings s = paper_settings(0.03);
  s.periodic = {false, true, false};
  s.walls = {{Eigen::Vector3d::UnitZ(), -0.02}, {Eigen::Vector3d::UnitX(), -0.02}};
  s.gravity_m_s2 = {0, 0, -9.81};
  if (!friction) s.grain_wall = {0.5636, 0, 0};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Grain> grains;
  for (std::uint32_t id = 0; id < 150; ++id) {
    // Clear of the box at the start, and none can be crushed between it and a wall.
    const Eigen::Vector3d p(-0.016 + 0.03 * unit(random), -0.03 + 0.06 * unit(random),
                            -0.0165 + 0.006 * unit(random) + (id % 3 == 0 ? 0.022 : 0));
    grains.push_back(grain_at(
        id, 2e-3 + 4e-3 * unit(random), p,
        {-1.2 * unit(random), unit(random) - 0.5, 2.5 * (id % 3 == 0 ? -1 : 1) * unit(random)},
        {50 * unit(random), 30, -20}));
  }
  BoundaryRig rig(s, grains, account);
  rig.boundary().add_mesh(refined(refined(box_mesh({0.006, 0.012, 0.003}))));
  return rig;
}

MeshMotion sweep(double time_s) {
  MeshMotion m;
  m.p_WB_m = {0.002, 0.02 + 0.8 * time_s,
              -0.002 - 0.2 * time_s};  // goes out through a periodic side
  m.q_WB = Eigen::AngleAxisd(20 * time_s, Eigen::Vector3d(0.6, 0, 0.8));
  m.v_WB_m_s = {0, 0.8, -0.2};
  m.w_WB_rad_s = {12, 0, 16};
  return m;
}

}  // namespace

TEST_CASE("the lists miss nothing: the same forces as from lists made anew at every step") {
  // Without friction forces depend on the present alone.
  BoundaryRig rig = rain(false);
  rig.boundary().set_motion(0, sweep(0));
  int on_walls = 0, on_mesh = 0;
  for (int i = 0; i < 3000; ++i) {
    rig.step();
    if (i % 10 != 0) continue;
    rig.compute();
    BoundaryRig anew = rain(false);
    anew.boundary().set_motion(0, sweep(rig.time_s()));
    for (std::uint32_t row = 0; row < rig.count(); ++row) anew.record(row) = rig.record(row);
    anew.compute();
    for (std::uint32_t row = 0; row < rig.count(); ++row) {
      INFO("step " << i << ", grain " << row);
      // Positions are made from other places: 1e-17 m in overlaps of micrometres.
      CHECK((rig.force_N(row) - anew.force_N(row)).norm() <=
            1e-8 * anew.force_N(row).norm() + 1e-12);
      if (anew.force_N(row).norm() == 0) continue;
      const bool far = anew.p_m(row).x() > -0.0165 && anew.p_m(row).z() > -0.0165;
      ++(far ? on_mesh : on_walls);
    }
  }
  CHECK(on_walls > 50);
  CHECK(on_mesh > 100);
}

TEST_CASE("a mesh that comes, turns or jumps finds grains that lie still") {
  const DemSettings s = paper_settings();
  const double h = 0.005, r = 1e-3;
  const auto box = [&](const MeshMotion& start) {
    BoundaryRig rig(s, {grain_at(0, 2 * r, {0, 0, 0.02})});
    rig.boundary().add_mesh(box_mesh({h, h, h}));
    rig.boundary().set_motion(0, start);
    rig.advance(10);
    CHECK(rig.force_N().norm() == 0);
    return rig;
  };
  MeshMotion motion;
  SECTION("comes") {
    motion.v_WB_m_s = {0, 0, 1};
    BoundaryRig rig = box(motion);
    rig.advance(6000);  // 16.8 mm, of which 14 to the grain
    CHECK(rig.v_m_s().z() > 1);
  }
  SECTION("turns") {
    motion.p_WB_m = {0, h + r + 1e-3, 0.02};  // a corner of it reaches 7.1 mm far
    motion.w_WB_rad_s = {60, 0, 0};
    BoundaryRig rig = box(motion);
    rig.advance(6000);  // one radian
    CHECK(rig.v_m_s().norm() > 0.1);
  }
  SECTION("jumps") {
    BoundaryRig rig = box(motion);
    motion.p_WB_m = {0, 0, 0.02 - h - r + 1e-6};
    rig.boundary().set_motion(0, motion);
    rig.step();
    CHECK(rig.force_N().z() > 0);
  }
}

TEST_CASE("a boundary that is saved and loaded goes on to the same bytes") {
  for (const int saved_at : {0, 1, 137, 1000}) {
    BoundaryRig straight = rain(true, true);
    straight.boundary().set_motion(0, sweep(0));
    straight.advance(saved_at);
    BoundaryRig resumed = rain(true, true);
    ByteWriter out;
    straight.boundary().save(out);
    ByteReader in(out.bytes());
    resumed.boundary().load<double>(in);
    CHECK(in.at_end());
    resumed.continue_from(straight);
    straight.advance(1500), resumed.advance(1500);
    ByteWriter a, b;
    straight.boundary().save(a), resumed.boundary().save(b);
    CHECK(a.bytes() == b.bytes());
    for (std::uint32_t row = 0; row < straight.count(); ++row) {
      CHECK(straight.p_m(row) == resumed.p_m(row));
      CHECK(straight.w_rad_s(row) == resumed.w_rad_s(row));
    }
    CHECK(straight.boundary().energy().lost_J() == resumed.boundary().energy().lost_J());
    const MeshLoad load = straight.boundary().take_load(0);
    CHECK(load.impulse_W_Ns.norm() > 0);
    const MeshLoad same = resumed.boundary().take_load(0);
    CHECK(load.impulse_W_Ns == same.impulse_W_Ns);
    CHECK(load.angular_impulse_Bo_W_Nms == same.angular_impulse_Bo_W_Nms);
    CHECK(load.work_J == same.work_J);
  }
}

TEST_CASE("a boundary refuses bytes that are cut short or of another bed") {
  BoundaryRig rig = rain(true, true);
  rig.boundary().set_motion(0, sweep(0));
  rig.advance(200);
  ByteWriter out;
  rig.boundary().save(out);
  for (const std::size_t length :
       {std::size_t(0), std::size_t(7), out.bytes().size() / 2, out.bytes().size() - 1}) {
    BoundaryRig other = rain(true, true);
    ByteReader in(std::string_view(out.bytes()).substr(0, length));
    CHECK_THROWS_WITH(other.boundary().load<double>(in), "is truncated");
  }
  BoundaryRig more = rain(true, true);
  more.boundary().add_mesh(box_mesh({1e-3, 1e-3, 1e-3}));
  ByteReader in(out.bytes());
  CHECK_THROWS_WITH(more.boundary().load<double>(in), "is of a bed with other meshes");
  BoundaryRig without = rain(true, false);
  ByteReader again(out.bytes());
  CHECK_THROWS_WITH(without.boundary().load<double>(again),
                    "is of a bed that accounts energy otherwise");
}

TEST_CASE("a new order of the rows changes no force, history or load") {
  BoundaryRig straight = rain(true, true), shuffled = rain(true, true);
  for (BoundaryRig* rig : {&straight, &shuffled}) {
    rig->boundary().set_motion(0, sweep(0));
    rig->advance(400);
  }
  std::vector<std::uint32_t> old_row(shuffled.count());
  for (std::uint32_t row = 0; row < old_row.size(); ++row) old_row[row] = row;
  std::shuffle(old_row.begin(), old_row.end(), std::mt19937(8));
  shuffled.reorder(old_row);
  straight.advance(800), shuffled.advance(800);
  for (std::uint32_t row = 0; row < old_row.size(); ++row) {
    // Lists are made at other times, so positions near the mesh are rounded otherwise.
    CHECK((shuffled.p_m(row) - straight.p_m(old_row[row])).norm() < 1e-12);
    Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
    CHECK(shuffled.boundary().wall_history(row, 0, a) ==
          straight.boundary().wall_history(old_row[row], 0, b));
    CHECK((a - b).norm() < 1e-12);
  }
  const Eigen::Vector3d a = straight.boundary().take_load(0).impulse_W_Ns;
  CHECK((shuffled.boundary().take_load(0).impulse_W_Ns - a).norm() < 1e-9 * a.norm());
}

TEST_CASE("the energy account closes: an impact on a wall, an edge and a corner, with friction") {
  for (const RollingLaw rolling : {RollingLaw::kOwnSpin, RollingLaw::kRelativeSpin}) {
    for (const bool meshed : {false, true}) {
      DemSettings s = paper_settings();
      s.rolling_law = rolling;
      s.dt_s = 5e-7;  // the account is exact but for the step: elastic work is taken by trapezia
      if (!meshed) s.walls = {{Eigen::Vector3d::UnitZ(), 0}, {Eigen::Vector3d::UnitX(), -0.01}};
      const double r = 2e-3;
      BoundaryRig rig(s,
                      {grain_at(0, 2 * r, {1e-3, 0, r + 1e-6}, {0.2, 0.1, -0.4}, {30, -100, 20}),
                       grain_at(1, 2 * r, {-0.01 + r + 1e-6, 0.01, r + 1e-6}, {-0.3, 0.2, -0.3})},
                      true);
      if (meshed) {
        TriangleMesh room = box_mesh({0.01, 0.02, 0.02});
        for (auto& t : room.triangles) std::swap(t[1], t[2]);
        for (auto& v : room.vertices_m) v.z() += 0.02;
        rig.boundary().add_mesh(room);
      }
      const double before_J = rig.kinetic_energy_J();
      double largest_stored_J = 0;
      for (int i = 0; i < 1200; ++i) {
        rig.step();
        const ContactEnergy e = rig.boundary().energy();
        largest_stored_J = std::max(largest_stored_J, e.stored_J());
        if (i % 10 != 0 && i != 1199) continue;
        INFO((meshed ? "meshed" : "walls") << ", step " << i);
        // Kinetic energy is half a step off the springs' while they push: F v dt / 2.
        const double lag_J = e.stored_J() > 0 ? 0.03 * before_J : 2e-4 * before_J;
        CHECK(rig.kinetic_energy_J() + e.stored_J() + e.lost_J() ==
              Approx(before_J).margin(lag_J).epsilon(0));
      }
      const ContactEnergy e = rig.boundary().energy();
      CHECK(e.stored_J() == 0);  // both have left
      CHECK(largest_stored_J > 0.3 * before_J);
      CHECK(e.lost_normal_dashpot_J > 0.3 * before_J);
      CHECK(e.lost_tangential_J > 0);
      CHECK(e.lost_rolling_J > 0);
      CHECK(rig.kinetic_energy_J() < 0.6 * before_J);
    }
  }
}

TEST_CASE("the account tells elastic, damped and sliding apart") {
  struct Case {
    PairCoefficients pair;
    Eigen::Vector3d v_m_s;
    bool dashpot, tangential;
  };
  for (const Case& c : {Case{{1, 0, 0}, {0.2, 0, -0.3}, false, false},
                        Case{{0.54, 0, 0}, {0.2, 0, -0.3}, true, false},
                        Case{{1, 0.3, 0}, {2, 0, -0.3}, false, true}}) {
    DemSettings s = paper_settings();
    s.grain_wall = c.pair;
    s.walls = {{Eigen::Vector3d::UnitZ(), 0}};
    BoundaryRig rig(s, {grain_at(0, 4e-3, {0, 0, 2e-3 + 1e-6}, c.v_m_s)}, true);
    const double before_J = rig.kinetic_energy_J();
    rig.advance(400);
    const ContactEnergy e = rig.boundary().energy();
    CHECK((e.lost_normal_dashpot_J > 0.1 * before_J) == c.dashpot);
    if (!c.dashpot) CHECK(std::abs(e.lost_normal_dashpot_J) == 0);
    CHECK((e.lost_tangential_J > 1e-3 * before_J) == c.tangential);
    if (!c.tangential) CHECK(std::abs(e.lost_tangential_J) < 1e-12 * before_J);
    CHECK(e.lost_rolling_J == 0);
  }
  DemSettings s = paper_settings();
  s.walls = {{Eigen::Vector3d::UnitZ(), 0}};
  BoundaryRig off(s, {grain_at(0, 4e-3, {0, 0, 2e-3 + 1e-6}, {0.2, 0, -0.3})});
  off.advance(100);
  CHECK(off.boundary().energy().lost_J() == 0);
  CHECK(off.boundary().energy().stored_J() == 0);
}

TEST_CASE("bytes come back as they were put, and never more of them") {
  ByteWriter out;
  out.put(3), out.put(Eigen::Vector3d(1, 2, 3)), out.put(Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  const std::vector<double> three = {1, -2, 1e300};
  out.put_all(three), out.put_all(std::span<const double>()), out.put_all(std::string("sand"));
  ByteReader in(out.bytes());
  CHECK(in.get<int>() == 3);
  CHECK(in.get<Eigen::Vector3d>() == Eigen::Vector3d(1, 2, 3));
  CHECK(in.get<Eigen::Quaterniond>().w() == 0.5);
  std::vector<double> values;
  in.get_all(values);
  CHECK(values == three);
  in.get_all(values);
  CHECK(values.empty());
  CHECK_FALSE(in.at_end());
  std::string text;
  in.get_all(text);
  CHECK(text == "sand");
  CHECK(in.at_end());
  CHECK_THROWS_WITH(in.get<char>(), "is truncated");
  ByteWriter damaged;
  damaged.put(std::uint64_t(1) << 61);  // a length that would take all memory
  ByteReader lies(damaged.bytes());
  CHECK_THROWS_WITH(lies.get_all(values), "is truncated");
}
