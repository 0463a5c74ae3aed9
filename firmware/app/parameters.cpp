#include "firmware/app/parameters.h"

#include <array>
#include <bit>

#include "firmware/app/crc32.h"

namespace hoof::firmware::app {
namespace {

using P = Parameters;

constexpr auto kTable = std::to_array<ParameterEntry>({
    {"toe_kp_Nm_rad", "Nm/rad", 0, 500, [](P& p) -> float& { return p.control.toe.kp_Nm_rad; },
     "Stiffness that holds the toes; deflection = sand torque / stiffness"},
    {"toe_kd_Nm_s_rad", "Nm s/rad", 0, 5, [](P& p) -> float& { return p.control.toe.kd_Nm_s_rad; },
     "Damping of the toes"},
    {"toe_inertia_kg_m2", "kg m2", 0, 1, [](P& p) -> float& { return p.control.toe.inertia_kg_m2; },
     "Rotor and both toes at the hinge, for the feed-forward"},
    {"toe_friction_Nm", "Nm", 0, 5, [](P& p) -> float& { return p.control.toe.friction_Nm; },
     "Coulomb friction of the toe drive, for the feed-forward"},
    {"toe_viscous_friction_Nm_s_rad", "Nm s/rad", 0, 5,
     [](P& p) -> float& { return p.control.toe.viscous_friction_Nm_s_rad; },
     "Viscous friction of the toe drive, for the feed-forward"},
    {"toe_speed_rad_s", "rad/s", 0.05f, 8, [](P& p) -> float& { return p.control.toe.speed_rad_s; },
     "Largest speed of opening moves"},
    {"toe_acceleration_rad_s2", "rad/s2", 0.5f, 200,
     [](P& p) -> float& { return p.control.toe.acceleration_rad_s2; },
     "Largest acceleration of opening moves"},
    {"toe_jerk_rad_s3", "rad/s3", 10, 20000,
     [](P& p) -> float& { return p.control.toe.jerk_rad_s3; }, "Largest jerk of opening moves"},
    {"toe_largest_angle_rad", "rad", 0.1f, 0.9f,
     [](P& p) -> float& { return p.control.toe.largest_angle_rad; },
     "Orders for a wider opening are refused"},
    {"toe_jam_torque_Nm", "Nm", 0.5f, 10,
     [](P& p) -> float& { return p.control.toe.jam_torque_Nm; },
     "Standing still at this torque is a jam"},
    {"toe_jam_distance_rad", "rad", 0.01f, 0.5f,
     [](P& p) -> float& { return p.control.toe.jam_distance_rad; },
     "Nearer to its set point a toe is not jammed but loaded"},
    {"toe_jam_time_s", "s", 0.02f, 5, [](P& p) -> float& { return p.control.toe.jam_time_s; },
     "How long before a jam is called"},
    {"toe_stall_time_s", "s", 0.02f, 5, [](P& p) -> float& { return p.control.toe.stall_time_s; },
     "How long a toe that stands still with less than the torque of a jam before a stall is "
     "called"},
    {"toe_absolute_encoder", "bool", 0, 1,
     [](P& p) -> float& { return p.control.homing.absolute_encoder; },
     "The toe drive tells its angle from power-on; no end stop is sought"},
    {"homing_speed_rad_s", "rad/s", 0.1f, 2,
     [](P& p) -> float& { return p.control.homing.speed_rad_s; }, "Closing speed of homing"},
    {"homing_kd_Nm_s_rad", "Nm s/rad", 0.5f, 5,
     [](P& p) -> float& { return p.control.homing.kd_Nm_s_rad; },
     "Damping of homing; push at the stop = speed times damping"},
    {"homing_stall_torque_Nm", "Nm", 0.1f, 5,
     [](P& p) -> float& { return p.control.homing.stall_torque_Nm; },
     "Torque that tells the end stop"},
    {"homing_timeout_s", "s", 0.5f, 60, [](P& p) -> float& { return p.control.homing.timeout_s; },
     "Longest search for the stop"},
    {"homing_stop_angle_rad", "rad", -0.1f, 0.2f,
     [](P& p) -> float& { return p.control.homing.stop_angle_rad; },
     "Opening angle at the closed end stop"},
    {"leg_kp_Nm_rad", "Nm/rad", 0, 20000, [](P& p) -> float& { return p.control.leg.kp_Nm_rad; },
     "Stiffness of hip and knee"},
    {"leg_kd_Nm_s_rad", "Nm s/rad", 0, 500,
     [](P& p) -> float& { return p.control.leg.kd_Nm_s_rad; }, "Damping of hip and knee"},
    {"leg_stop_kd_Nm_s_rad", "Nm s/rad", 20, 500,
     [](P& p) -> float& { return p.control.leg.stop_kd_Nm_s_rad; },
     "Damping that lets a loaded leg down"},
    {"leg_speed_rad_s", "rad/s", 0.05f, 4, [](P& p) -> float& { return p.control.leg.speed_rad_s; },
     "Largest speed of the move to the start of the path"},
    {"leg_acceleration_rad_s2", "rad/s2", 0.1f, 50,
     [](P& p) -> float& { return p.control.leg.acceleration_rad_s2; },
     "Largest acceleration of that move"},
    {"leg_jerk_rad_s3", "rad/s3", 1, 2000, [](P& p) -> float& { return p.control.leg.jerk_rad_s3; },
     "Largest jerk of that move"},
    {"thigh_m", "m", 0.05f, 1, [](P& p) -> float& { return p.control.leg_model.thigh_m; },
     "Hip to knee"},
    {"shank_m", "m", 0.05f, 1, [](P& p) -> float& { return p.control.leg_model.shank_m; },
     "Knee to sole point"},
    {"thigh_mass_kg", "kg", 0, 20, [](P& p) -> float& { return p.control.leg_model.thigh_mass_kg; },
     "Thigh"},
    {"thigh_centre_m", "m", 0, 1, [](P& p) -> float& { return p.control.leg_model.thigh_centre_m; },
     "Hip to centre of mass of the thigh"},
    {"thigh_inertia_kg_m2", "kg m2", 0, 2,
     [](P& p) -> float& { return p.control.leg_model.thigh_inertia_kg_m2; },
     "Thigh about its centre of mass"},
    {"shank_mass_kg", "kg", 0, 20, [](P& p) -> float& { return p.control.leg_model.shank_mass_kg; },
     "Shank without foot"},
    {"shank_centre_m", "m", 0, 1, [](P& p) -> float& { return p.control.leg_model.shank_centre_m; },
     "Knee to centre of mass of the shank"},
    {"shank_inertia_kg_m2", "kg m2", 0, 2,
     [](P& p) -> float& { return p.control.leg_model.shank_inertia_kg_m2; },
     "Shank about its centre of mass"},
    {"foot_mass_kg", "kg", 0, 20, [](P& p) -> float& { return p.control.leg_model.foot_mass_kg; },
     "Foot with toes and toe drive"},
    {"foot_centre_m", "m", 0, 1, [](P& p) -> float& { return p.control.leg_model.foot_centre_m; },
     "Knee to centre of mass of the foot"},
    {"leg_rotor_inertia_kg_m2", "kg m2", 0, 5,
     [](P& p) -> float& { return p.control.leg_model.rotor_inertia_kg_m2; },
     "Rotor of a leg drive, reflected to the joint"},
    {"leg_friction_Nm", "Nm", 0, 50, [](P& p) -> float& { return p.control.leg_model.friction_Nm; },
     "Coulomb friction of a leg drive, for the feed-forward"},
    {"leg_viscous_friction_Nm_s_rad", "Nm s/rad", 0, 50,
     [](P& p) -> float& { return p.control.leg_model.viscous_friction_Nm_s_rad; },
     "Viscous friction of a leg drive, for the feed-forward"},
    {"ellipse_semi_x_m", "m", 0.005f, 0.3f, [](P& p) -> float& { return p.control.path.semi_x_m; },
     "Half length of the stance path"},
    {"ellipse_semi_z_m", "m", 0.005f, 0.2f, [](P& p) -> float& { return p.control.path.semi_z_m; },
     "Half height of the stance path"},
    {"ellipse_centre_above_sand_m", "m", -0.05f, 0.3f,
     [](P& p) -> float& { return p.control.path.centre_above_sand_m; },
     "Centre of the stance path above the level sand"},
    {"hip_above_sand_m", "m", 0.1f, 2,
     [](P& p) -> float& { return p.control.path.hip_above_sand_m; },
     "Hip axis above the level sand"},
    {"gait_largest_frequency_Hz", "Hz", 0.1f, 5,
     [](P& p) -> float& { return p.control.path.largest_frequency_Hz; },
     "Orders for a faster gait are refused"},
    {"gait_start_phase_cycles", "cycles", 0.5f, 1,
     [](P& p) -> float& { return p.control.path.start_phase_cycles; },
     "Where every walk starts, in the upper half of the path; 0.75 is its top"},
    {"contact_touch_force_N", "N", 1, 500,
     [](P& p) -> float& { return p.control.contact.touch_force_N; },
     "Estimated vertical force that tells touch-down"},
    {"contact_release_force_N", "N", 0, 500,
     [](P& p) -> float& { return p.control.contact.release_force_N; },
     "Estimated vertical force below which contact ends"},
    {"body_speed_m_s", "m/s", 0, 3, [](P& p) -> float& { return p.control.contact.body_speed_m_s; },
     "Speed of the hip over ground, for the slip; 0 where the hip is held"},
    {"slip_speed_m_s", "m/s", 0.005f, 1,
     [](P& p) -> float& { return p.control.contact.slip_speed_m_s; },
     "No slip ratio while the foot goes backwards slower than this"},
    {"slip_filter_s", "s", 0, 1, [](P& p) -> float& { return p.control.contact.slip_filter_s; },
     "Time constant of the foot's speed in the slip ratio"},
    {"adaptive_enabled", "bool", 0, 1, [](P& p) -> float& { return p.control.adaptive.enabled; },
     "Toes open wider after a deeper stance; off by default"},
    {"adaptive_gain_rad_m", "rad/m", 0, 50,
     [](P& p) -> float& { return p.control.adaptive.gain_rad_m; },
     "Opening beyond the ordered angle per sinkage beyond the reference"},
    {"adaptive_reference_sinkage_m", "m", 0, 0.2f,
     [](P& p) -> float& { return p.control.adaptive.reference_sinkage_m; },
     "Sinkage at which the toes stay at the ordered angle"},
    {"adaptive_largest_step_rad", "rad", 0.005f, 0.3f,
     [](P& p) -> float& { return p.control.adaptive.largest_step_rad; },
     "Largest change of the opening from one stance to the next"},
    {"adaptive_deadband_m", "m", 0, 0.05f,
     [](P& p) -> float& { return p.control.adaptive.deadband_m; },
     "A sinkage that differs less from what the toes stand at changes nothing"},
    {"stop_longest_s", "s", 0.1f, 10, [](P& p) -> float& { return p.control.stop.longest_s; },
     "A damped stop ends after this time, at rest or not"},
    {"toe_zero_rad", "rad", -kLargestZero_rad, kLargestZero_rad,
     [](P& p) -> float& { return p.calibration[0].zero_rad; },
     "Reading of the toe drive at angle 0; with an absolute encoder"},
    {"toe_mark_rad", "rad", -0.1f, 1, [](P& p) -> float& { return p.calibration[0].mark_rad; },
     "Toe angle at its calibration mark"},
    {"toe_calibrated", "bool", 0, 1, [](P& p) -> float& { return p.calibration[0].done; },
     "toe_zero_rad is right; with an absolute encoder nothing moves before"},
    {"hip_zero_rad", "rad", -kLargestZero_rad, kLargestZero_rad,
     [](P& p) -> float& { return p.calibration[1].zero_rad; },
     "Reading of the hip drive where the thigh hangs straight down"},
    {"hip_mark_rad", "rad", -1.2f, 1.6f, [](P& p) -> float& { return p.calibration[1].mark_rad; },
     "Hip angle at its calibration mark"},
    {"hip_calibrated", "bool", 0, 1, [](P& p) -> float& { return p.calibration[1].done; },
     "hip_zero_rad is right; nothing moves before"},
    {"knee_zero_rad", "rad", -kLargestZero_rad, kLargestZero_rad,
     [](P& p) -> float& { return p.calibration[2].zero_rad; },
     "Reading of the knee drive where the shank is in line with the thigh"},
    {"knee_mark_rad", "rad", -2.7f, 0.05f, [](P& p) -> float& { return p.calibration[2].mark_rad; },
     "Knee angle at its calibration mark"},
    {"knee_calibrated", "bool", 0, 1, [](P& p) -> float& { return p.calibration[2].done; },
     "knee_zero_rad is right; nothing moves before"},
    {"toe_present", "bool", 0, 1, [](P& p) -> float& { return p.toe_present; },
     "This rig has a toe drive; counts from the next start"},
    {"leg_present", "bool", 0, 1, [](P& p) -> float& { return p.leg_present; },
     "This rig has hip and knee drives; counts from the next start"},
});

}  // namespace

control::Settings Parameters::settings() const {
  control::Settings all = control;
  all.homing.calibrated = calibration[index(control::Joint::kToe)].done;
  all.leg.calibrated = calibration[index(control::Joint::kHip)].done *
                       calibration[index(control::Joint::kKnee)].done;
  return all;
}

float Parameters::zero_rad(control::Joint joint) const {
  const bool homes = joint == control::Joint::kToe && !control.homing.is_absolute();
  return homes ? 0.0f : calibration[index(joint)].zero_rad;
}

std::span<const ParameterEntry> parameter_table() {
  return kTable;
}

std::uint32_t parameter_table_hash() {
  Crc32 crc;
  for (const ParameterEntry& entry : kTable) {
    crc.add(entry.name).add(std::uint8_t{0}).add(entry.unit).add(std::uint8_t{0});
    const std::array<std::uint32_t, 3> numbers{std::bit_cast<std::uint32_t>(entry.minimum),
                                               std::bit_cast<std::uint32_t>(entry.maximum),
                                               std::bit_cast<std::uint32_t>(entry.default_value())};
    crc.add(numbers);
  }
  return crc.value();
}

const ParameterEntry* find_parameter(std::string_view name) {
  for (const ParameterEntry& entry : kTable) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

SetResult set(Parameters& parameters, std::string_view name, float value) {
  const ParameterEntry* entry = find_parameter(name);
  return entry == nullptr ? SetResult::kUnknownName : set(parameters, *entry, value);
}

SetResult set(Parameters& parameters, const ParameterEntry& entry, float value) {
  if (!(value >= entry.minimum && value <= entry.maximum)) return SetResult::kOutOfRange;
  entry.value(parameters) = value;
  return SetResult::kOk;
}

}  // namespace hoof::firmware::app
