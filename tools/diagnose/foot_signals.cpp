#include "tools/diagnose/foot_signals.h"

#include <algorithm>
#include <limits>

#include "firmware/protocol/codec.h"

namespace hoof::tools {

namespace protocol = firmware::protocol;

FootSignals::FootSignals(int ticks) : blocks_(ticks / kBlock_ticks) {
  for (auto& sum : sums_) sum.resize(std::size_t(blocks_));
  for (auto& count : counts_) count.resize(std::size_t(blocks_));
}

void FootSignals::add(int channel, int tick, double value) {
  const int block = tick / kBlock_ticks;
  if (tick < 0 || block >= blocks_) return;
  sums_[std::size_t(channel)][std::size_t(block)] += value;
  ++counts_[std::size_t(channel)][std::size_t(block)];
}

void FootSignals::take(const hal::CanFrame& frame) {
  for (int j = 0; j < sim::kJointCount; ++j) {
    const auto drive = protocol::Drive(j);
    if (frame.id != reply_spec(drive).id) continue;
    protocol::DriveReply reply;
    if (decode_reply(drive, frame, reply) != protocol::DecodeResult::kOk) return;
    const int tick = int(frame.stamp_ns / 1'000'000);
    add(kOfJoint * j, tick, reply.position_rad);
    add(kOfJoint * j + 1, tick, reply.velocity_rad_s);
    add(kOfJoint * j + 2, tick, reply.torque_Nm);
  }
}

void FootSignals::ground(int tick, double depth_m, double fx_N, double fz_N) {
  const int first = kOfJoint * sim::kJointCount;
  add(first, tick, depth_m);
  add(first + 1, tick, fx_N);
  add(first + 2, tick, fz_N);
}

void FootSignals::finish() {
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    double last = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t b = 0; b < sums_[c].size(); ++b) {
      if (counts_[c][b] > 0) last = sums_[c][b] / counts_[c][b];
      sums_[c][b] = last;
    }
  }
}

const std::vector<std::string>& FootSignals::channel_names() {
  static const std::vector<std::string> names = {
      "toe_position",  "toe_velocity",  "toe_torque",  "hip_position", "hip_velocity", "hip_torque",
      "knee_position", "knee_velocity", "knee_torque", "depth",        "ground_fx",    "ground_fz"};
  return names;
}

const std::vector<double>& FootSignals::channel(const std::string& name) const {
  const auto& names = channel_names();
  return sums_[std::size_t(std::find(names.begin(), names.end(), name) - names.begin())];
}

std::vector<double> FootSignals::time_s() const {
  std::vector<double> time_s;
  for (int b = 0; b < blocks_; ++b) time_s.push_back((b + 0.5) * kBlock_ticks * kTick_s);
  return time_s;
}

}  // namespace hoof::tools
