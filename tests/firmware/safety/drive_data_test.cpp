// What the firmware believes of its drives, against the drives of the plant: sim/config/drives and
// the thermal model of sim/drive.
#include "firmware/safety/drive_data.h"

#include <catch2/catch.hpp>
#include <string>

#include "firmware/safety/heat.h"
#include "sim/config/settings.h"
#include "sim/drive/drive.h"

using namespace hoof;
using firmware::safety::DriveData;
using firmware::safety::kDrives;

namespace {

constexpr const char* kNames[] = {"toe", "hip", "knee"};

sim::DriveSettings plant_drive(std::size_t joint) {
  sim::Settings settings;
  settings.merge(sim::Settings::load_file(sim::default_config_dir() / "drives/goat.toml"),
                 "drives");
  return sim::read_drive(sim::Reader(settings).section("drives").section(kNames[joint]));
}

}  // namespace

TEST_CASE("The firmware's data of each drive are those of the plant") {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    INFO(kNames[joint]);
    const sim::DriveSettings plant = plant_drive(joint);
    const DriveData& drive = kDrives[joint];
    CHECK(drive.peak_torque_Nm == Approx(plant.torque_limit_Nm));
    CHECK(drive.copper_loss_W_Nm2 == Approx(plant.copper_loss_W_Nm2));
    CHECK(drive.thermal_resistance_K_W == Approx(plant.thermal_resistance_K_W));
    CHECK(drive.heat_capacity_J_K == Approx(plant.heat_capacity_J_K));
    // Held for ever at 35 degC of air, the continuous torque does not trip the plant's own limit.
    CHECK(35.0 + drive.rise_K(drive.continuous_torque_Nm) < plant.temperature_limit_C);
  }
}

TEST_CASE("The heat ratio is the plant's own rise of the winding, scaled") {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    INFO(kNames[joint]);
    const sim::DriveSettings settings = plant_drive(joint);
    sim::Drive drive(settings);
    firmware::safety::Heat heat(kDrives[joint]);
    drive.enable();
    const double full_K = kDrives[joint].rise_K(kDrives[joint].continuous_torque_Nm);
    // Peak for 20 s, nothing for 20 s, backwards at half for 20 s; a joint that does not turn.
    for (const double share : {1.0, 0.0, -0.5}) {
      const double torque_Nm = share * settings.torque_limit_Nm;
      for (int ms = 0; ms < 20'000; ++ms) {
        drive.command({.torque_Nm = torque_Nm});
        // The plant's heat needs no small steps.
        drive.step(1e-3, drive.rotor_position_rad(), 0.0);
        heat.add(static_cast<float>(drive.reading().torque_Nm), 1e-3f, 1e-3f);
      }
      const double rise_K = drive.reading().temperature_C - settings.ambient_C;
      // Explicit Euler of 1 ms there, implicit of 0.1 s here: half of 0.1 s of 20.
      CHECK(heat.ratio() == Approx(rise_K / full_K).epsilon(0.005));
    }
  }
}
