#include "firmware/app/telemetry_frames.h"

#include "firmware/protocol/codec.h"

namespace hoof::firmware::app {

using control::Joint;

namespace {

hal::CanFrame toe_frame(const Telemetry& t) {
  const control::JointState& toe = t.state[index(Joint::kToe)];
  return encode(protocol::FootToe{t.toe_set_point_rad, toe.position_rad, toe.torque_Nm,
                                  toe.temperature_C, t.toe_moving});
}

hal::CanFrame leg_frame(const Telemetry& t, float hip_above_sand_m) {
  return encode(protocol::FootLeg{t.state[index(Joint::kHip)].position_rad,
                                  t.state[index(Joint::kKnee)].position_rad, t.foot_m.x,
                                  t.foot_m.z + hip_above_sand_m});
}

hal::CanFrame ground_frame(const Telemetry& t) {
  return encode(protocol::FootGround{t.phase_cycles, t.ground.sinkage_m, t.ground.force_N.x,
                                     t.ground.force_N.z, t.ground.contact});
}

hal::CanFrame gate_frame(const Telemetry& t) {
  return encode(protocol::FootGate{t.gate_interventions, t.verdict.limits[0], t.verdict.limits[1],
                                   t.verdict.limits[2]});
}

hal::CanFrame counters_frame(const Counters& c) {
  return encode(protocol::FootCounters{c.ticks, static_cast<std::uint16_t>(c.missed_ticks),
                                       static_cast<std::uint16_t>(c.stale_syncs)});
}

hal::CanFrame frames_frame(const Counters& c) {
  return encode(protocol::FootFrames{
      static_cast<std::uint16_t>(c.unknown_frames), static_cast<std::uint16_t>(c.malformed_frames),
      static_cast<std::uint16_t>(c.bad_crc_frames), static_cast<std::uint16_t>(c.refused_orders)});
}

hal::CanFrame load_frame(const Telemetry& t) {
  return encode(protocol::FootLoad{t.heat_ratio[0], t.heat_ratio[1], t.heat_ratio[2],
                                   t.ground.slip_m, t.ground.slip_ratio, t.supply_V,
                                   static_cast<std::uint8_t>(t.counters.overruns)});
}

}  // namespace

std::optional<hal::CanFrame> telemetry_frame(const Telemetry& t, bool leg, float hip_above_sand_m) {
  switch (t.counters.ticks % 10) {
    case 1:
      return toe_frame(t);
    case 3:
      if (leg) return leg_frame(t, hip_above_sand_m);
      break;
    case 5:
      if (leg) return ground_frame(t);
      break;
    case 7:
      return gate_frame(t);
    case 8:
      return load_frame(t);
    case 9:
      if (t.counters.ticks % 100 == 9) return counters_frame(t.counters);
      if (t.counters.ticks % 100 == 59) return frames_frame(t.counters);
      break;
    default:
      break;
  }
  return std::nullopt;
}

}  // namespace hoof::firmware::app
