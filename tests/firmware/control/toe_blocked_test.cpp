// Jam, stall and load: what is called what, and when.
#include <catch2/catch.hpp>
#include <cmath>

#include "firmware/control/toe_opening.h"
#include "tests/firmware/control/joint_plant.h"

using namespace hoof::firmware::control;
using test::JointPlant;

namespace {

struct Bench {
  ToeOpening toe;
  JointPlant plant;

  explicit Bench(ToeSettings s = {}, float from_rad = 0.3f) : toe(s, kTick_s) {
    plant.q_rad = from_rad;
    toe.start(from_rad);
  }

  void tick() { plant.run(toe.step(plant.state())); }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }

  /// Ticks until a jam or a stall, or -1.
  int run_until_blocked(int longest = 5000) {
    for (int i = 0; i < longest; ++i) {
      if (toe.jammed() || toe.stalled()) return i;
      tick();
    }
    return -1;
  }
};

/// A drive whose torque is lost, or whose gate lets little through: friction holds the toe.
struct Powerless : Bench {
  explicit Powerless(float order_rad) {
    plant.torque_limit_Nm = 0.2;
    toe.move_to(order_rad);
  }
};

}  // namespace

TEST_CASE("Blocked with the torque of a jam: a jam, opening and closing") {
  for (const float order_rad : {0.6f, 0.0f}) {
    Bench bench;
    bench.plant.friction_Nm = 30.0;  // a stone in the hinge
    bench.toe.move_to(order_rad);
    const int ticks = bench.run_until_blocked();
    CHECK(bench.toe.jammed());
    CHECK_FALSE(bench.toe.stalled());
    // Planned in 5 ticks; at 20 rad/s2 the set point is 50 mrad ahead after 80 ms; then 200 ms.
    CHECK(ticks == Approx(5 + 80 + 200).margin(20));
  }
}

TEST_CASE("Blocked without that torque: a stall, opening and closing") {
  for (const float order_rad : {0.6f, 0.0f}) {
    Powerless bench(order_rad);
    const int ticks = bench.run_until_blocked();
    CHECK(bench.toe.stalled());
    CHECK_FALSE(bench.toe.jammed());
    CHECK(ticks == Approx(5 + 80 + 500).margin(20));
  }
  ToeSettings soft;
  soft.kp_Nm_rad = 5.0f;
  Bench weak(soft);
  weak.plant.load_Nm = -3.0;  // held by the end stop against the sand
  weak.plant.stop_rad = 0.3;
  weak.toe.move_to(0.6f);
  CHECK(weak.run_until_blocked() > 0);
  CHECK(weak.toe.stalled());
}

TEST_CASE("A jam that is given longer than a stall is still a jam") {
  ToeSettings settings;
  settings.jam_time_s = 1.0f;
  Bench bench(settings);
  bench.plant.friction_Nm = 30.0;
  bench.toe.move_to(0.6f);
  CHECK(bench.run_until_blocked() == Approx(5 + 80 + 1000).margin(20));
  CHECK(bench.toe.jammed());
}

TEST_CASE("The stall time is the setting's; a push that comes and goes is a stall at the latest") {
  ToeSettings settings;
  settings.stall_time_s = 1.5f;
  Bench late(settings);
  late.plant.torque_limit_Nm = 0.2;
  late.toe.move_to(0.6f);
  CHECK(late.run_until_blocked() == Approx(5 + 80 + 1500).margin(20));

  ToeOpening toe({}, kTick_s);
  toe.start(0.0f);
  toe.move_to(0.5f);
  JointState stuck;
  int ticks = 0;
  while (!toe.jammed() && !toe.stalled() && ticks < 5000) {
    stuck.torque_Nm = ticks / 100 % 2 == 0 ? 4.5f : 3.5f;
    toe.step(stuck);
    ++ticks;
  }
  CHECK(toe.stalled());
  CHECK(ticks < 5 + 80 + 500 + 101);
}

TEST_CASE("A slow move against a load is neither, though its speed looks like standing still") {
  ToeSettings settings;
  settings.speed_rad_s = 0.05f;  // below three codes of the reply's speed
  for (const double load_Nm : {-6.0, 6.0}) {
    for (const float order_rad : {0.6f, 0.0f}) {
      Bench bench(settings);
      bench.plant.load_Nm = load_Nm;
      bench.toe.move_to(order_rad);
      CHECK(bench.run_until_blocked(9000) == -1);
      CHECK(bench.plant.q_rad == Approx(order_rad + load_Nm / 250.0).margin(4e-3));
    }
  }
}

TEST_CASE("A toe that arrived and then gives way is loaded: neither jam nor stall") {
  struct Case {
    double ceiling_Nm, load_Nm;
  };
  // The ceiling as a gate lowers it against overheating: below and above the torque of a jam.
  for (const Case& c : {Case{3.0, 6.0}, Case{5.0, 7.0}, Case{9.0, 12.0}, Case{0.0, 2.0}}) {
    for (const double sign : {-1.0, 1.0}) {
      Bench bench;
      bench.toe.move_to(0.5f);
      bench.run(1500);
      REQUIRE_FALSE(bench.toe.moving());
      bench.plant.torque_limit_Nm = c.ceiling_Nm;
      bench.plant.load_Nm = sign * c.load_Nm;
      bench.run(100);
      bench.plant.friction_Nm = 100.0;  // and stands there, far away
      CAPTURE(c.ceiling_Nm, c.load_Nm, sign);
      CHECK(std::abs(bench.plant.q_rad - 0.5) > 0.05);
      CHECK(bench.run_until_blocked(5000) == -1);

      // The same order again, and a change that could not be told from the load.
      bench.toe.move_to(0.5f);
      CHECK(bench.run_until_blocked(2000) == -1);
      bench.toe.move_to(0.47f);
      CHECK(bench.run_until_blocked(2000) == -1);
      // A move worth the name that cannot be carried out.
      bench.toe.move_to(sign < 0 ? 0.69f : 0.2f);
      CHECK(bench.run_until_blocked(2000) > 0);
    }
  }
}

TEST_CASE("Passing the target on the way is no arrival: blocked on the way back is noticed") {
  Bench bench({}, 0.0f);
  bench.toe.move_to(0.6f);
  while (bench.plant.q_rad < 0.3) bench.tick();
  bench.toe.move_to(0.31f);  // at 2 rad/s: it goes on to 0.4 and comes back
  while (bench.plant.q_rad < 0.38) bench.tick();
  bench.plant.friction_Nm = 30.0;
  CHECK(bench.run_until_blocked(1000) >= 0);
}

TEST_CASE("Small changes add up: they are watched from where the toe last arrived") {
  Bench bench;
  bench.toe.move_to(0.5f);
  bench.run(1500);
  bench.plant.friction_Nm = 30.0;
  for (int i = 0; i < 4; ++i) {
    bench.toe.move_to(0.5f + 0.04f * float(i + 1));
    bench.run(200);
  }
  CHECK(bench.run_until_blocked(1000) >= 0);
}

TEST_CASE("An arrived toe without gain lets the sand move it, and that is no stall") {
  ToeSettings settings;
  settings.kp_Nm_rad = 0.0f;
  Bench bench(settings);
  bench.toe.move_to(0.5f);
  bench.run(1500);
  REQUIRE(bench.plant.q_rad == Approx(0.5).margin(0.05));
  bench.plant.load_Nm = -1.5;
  bench.plant.stop_rad = 0.1;
  CHECK(bench.run_until_blocked(5000) == -1);
  CHECK(bench.plant.q_rad < 0.2);
}

TEST_CASE("A new order watches anew; a start forgets") {
  Powerless bench(0.6f);
  REQUIRE(bench.run_until_blocked() > 0);
  bench.toe.start(float(bench.plant.q_rad));
  CHECK_FALSE(bench.toe.stalled());
  CHECK(bench.run_until_blocked(2000) == -1);  // holding where it is
  bench.toe.move_to(0.0f);
  CHECK(bench.run_until_blocked() > 0);
}

TEST_CASE("Settings that allow no move are a stall at once, not a toe that waits for ever") {
  ToeSettings settings;
  settings.speed_rad_s = 0.0f;
  Bench bench(settings);
  bench.toe.move_to(0.6f);
  bench.run(20);
  CHECK(bench.toe.stalled());
  CHECK_FALSE(bench.toe.moving());
  CHECK(bench.toe.set_point_rad() == 0.3f);
}
