#include "sim/drive/drive_settings.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/config/config_error.h"

using namespace hoof::sim;

namespace {

Settings shipped() {
  Settings run;
  run.merge(Settings::load_file(default_config_dir() / "drives/goat.toml"), "drives");
  return run;
}

}  // namespace

TEST_CASE("motor values are turned to the joint side") {
  const Settings run = shipped();
  const DriveSettings toe = read_drive(Reader(run).section("drives").section("toe"));
  // 607 g cm2 = 6.07e-5 kg m2, times 9 squared.
  CHECK(toe.rotor_inertia_kg_m2 == Approx(6.07e-5 * 81.0).epsilon(1e-12));
  CHECK(toe.no_load_speed_rad_s == Approx(570.0 * 2.0 * std::numbers::pi / 60.0).epsilon(1e-12));
  CHECK(toe.command_timeout_s == 0.020);
  CHECK_FALSE(toe.absolute_position);
}

TEST_CASE("hip and knee have the torque the paper's traction test needs") {
  const Settings run = shipped();
  for (const char* name : {"hip", "knee"}) {
    const DriveSettings drive = read_drive(Reader(run).section("drives").section(name));
    CHECK(drive.torque_limit_Nm >= 300.0);
    // Peak joint speed at 1.12 Hz is 1.82 rad/s: the speed-torque line must not clip there.
    const double line = drive.stall_torque_Nm * (1.0 - 1.82 / drive.no_load_speed_rad_s);
    CHECK(line > 300.0);
  }
}

TEST_CASE("a broken rule is named with file, section, value and bound") {
  Settings run = shipped();
  run.set("drives.toe.joint_stall_torque_Nm=10");
  CHECK_THROWS_WITH(read_drive(Reader(run).section("drives").section("toe")),
                    Catch::EndsWith("drives.toe: stall_torque_Nm = 10: must be at least "
                                    "torque_limit_Nm"));
  run = shipped();
  run.set("drives.toe.gear_ratio=0");
  CHECK_THROWS_WITH(read_drive(Reader(run).section("drives").section("toe")),
                    "--set: drives.toe.gear_ratio = 0: must be a number from 1.0 to 1000.0");
}
