#include "sim/multibody/leg.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace hoof::sim {
namespace {

Link read_link(Reader section) {
  Link link;
  section.number("length_mm", link.length_m, kMillimetre, 50.0, 1000.0);
  section.number("mass_kg", link.mass_kg, kKilogram, 0.01, 50.0);
  section.number("com_from_joint_mm", link.com_from_joint_m, kMillimetre, 0.0, 1000.0);
  section.number("gyration_mm", link.gyration_m, kMillimetre, 1.0, 1000.0);
  return link;
}

void require(bool holds, const std::string& text) {
  if (!holds) throw std::invalid_argument(text);
}

}  // namespace

void Leg::validate() const {
  for (const Link* link : {&thigh, &shank}) {
    require(link->length_m > 0.0 && link->mass_kg > 0.0 && link->gyration_m > 0.0,
            "length, mass and gyration of thigh and shank: must be above 0");
    require(link->com_from_joint_m <= link->length_m,
            "com_from_joint: must be at most the length of its link");
  }
  require(hip_min_rad < hip_max_rad, "hip_min: must be below hip_max");
  require(knee_min_rad < knee_max_rad && knee_max_rad <= 0.0,
          "knee_min: must be below knee_max, which must be at most 0");
  inverse_kinematics(*this, 0.0, level_sole_z_m);
}

LegPoint forward_kinematics(const Leg& leg, const LegAngles& angles) {
  const LegAngles level = inverse_kinematics(leg, 0.0, leg.level_sole_z_m);
  const double shank = angles.hip_rad + angles.knee_rad;
  return {leg.thigh.length_m * std::sin(angles.hip_rad) + leg.shank.length_m * std::sin(shank),
          leg.hip_height_m - leg.thigh.length_m * std::cos(angles.hip_rad) -
              leg.shank.length_m * std::cos(shank),
          shank - level.hip_rad - level.knee_rad};
}

LegAngles inverse_kinematics(const Leg& leg, double x_m, double z_m) {
  // Law of cosines for the knee; the hip is the direction to the foot less the share of the knee.
  const double l1 = leg.thigh.length_m;
  const double l2 = leg.shank.length_m;
  const double down_m = leg.hip_height_m - z_m;
  const double cos_knee = (x_m * x_m + down_m * down_m - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
  if (!(std::abs(cos_knee) <= 1.0)) {
    std::ostringstream text;
    text << "foot at x = " << x_m * 1e3 << " mm, z = " << z_m * 1e3
         << " mm: must be within reach of the leg, " << std::abs(l1 - l2) * 1e3 << " to "
         << (l1 + l2) * 1e3 << " mm from the hip";
    throw std::invalid_argument(text.str());
  }
  const double knee = -std::acos(cos_knee);
  const double hip =
      std::atan2(x_m, down_m) - std::atan2(l2 * std::sin(knee), l1 + l2 * std::cos(knee));
  return {hip, knee};
}

LegTorques holding_torques(const Leg& leg, const LegAngles& angles, double fx_N, double fz_N) {
  // A joint angle about -y moves the foot by (dz, -dx) seen from the joint: dx, dz are the foot's
  // place from it, so J^T f = dx fz - dz fx.
  const double shank = angles.hip_rad + angles.knee_rad;
  const double knee_dx = leg.shank.length_m * std::sin(shank);
  const double knee_dz = -leg.shank.length_m * std::cos(shank);
  const double hip_dx = knee_dx + leg.thigh.length_m * std::sin(angles.hip_rad);
  const double hip_dz = knee_dz - leg.thigh.length_m * std::cos(angles.hip_rad);
  return {-(hip_dx * fz_N - hip_dz * fx_N), -(knee_dx * fz_N - knee_dz * fx_N)};
}

Leg read_leg(Reader section) {
  Leg leg;
  std::string name;
  section.text("name", name);
  section.number("hip_height_mm", leg.hip_height_m, kMillimetre, 50.0, 2000.0);
  section.number("level_sole_z_mm", leg.level_sole_z_m, kMillimetre, -500.0, 500.0);
  section.number("hip_min_deg", leg.hip_min_rad, kDegree, -170.0, 170.0);
  section.number("hip_max_deg", leg.hip_max_rad, kDegree, -170.0, 170.0);
  section.number("knee_min_deg", leg.knee_min_rad, kDegree, -170.0, 0.0);
  section.number("knee_max_deg", leg.knee_max_rad, kDegree, -170.0, 0.0);
  leg.thigh = read_link(section.section("thigh"));
  leg.shank = read_link(section.section("shank"));
  section.finish();
  section.check([&leg] { leg.validate(); });
  return leg;
}

}  // namespace hoof::sim
