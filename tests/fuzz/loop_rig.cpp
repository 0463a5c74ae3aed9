#include "tests/fuzz/loop_rig.h"

#include "firmware/protocol/codec.h"
#include "firmware/protocol/protocol_hash.h"

namespace hoof::tests::fuzz {

using namespace firmware;
using protocol::DecodeResult;
using protocol::Drive;

namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

std::size_t bus_of(Drive drive) {
  return (protocol::command_spec(drive).buses & protocol::kBus0) != 0 ? 0 : 1;
}

}  // namespace

void RigDrive::take(Drive which, const hal::CanFrame& frame, FuzzBus& bus) {
  if (decode_command(which, frame, last) != DecodeResult::kOk) return;
  age_ms = 0;
  if (last.action == protocol::DriveSwitch::kEnter) entered = true;
  if (last.action == protocol::DriveSwitch::kExit) entered = false;
  if (silent) return;
  protocol::DriveReply reply;
  reply.position_rad = static_cast<float>(plant.q_rad - zero_rad);
  reply.velocity_rad_s = static_cast<float>(plant.v_rad_s);
  reply.torque_Nm = static_cast<float>(plant.motor_Nm);
  reply.temperature_C = temperature_C;
  reply.error = error;
  bus.arriving.push_back(encode_reply(which, reply));
}

void RigDrive::run() {
  constexpr int kCommandLife_ms = 20;
  control::JointCommand c;
  if (entered && !last.action && ++age_ms <= kCommandLife_ms) {
    const protocol::DriveCommand& w = last.command;
    c = {w.position_rad + static_cast<float>(zero_rad), w.velocity_rad_s, w.kp_Nm_rad,
         w.kd_Nm_s_rad, w.torque_Nm};
  }
  plant.run(c);
}

/// The toe lies by its stop and the leg at the top of the default path (hip 0.562, knee -1.420),
/// so that little time passes until the foot runs.
LoopRig::LoopRig(const app::Parameters& parameters)
    : loop_({&buses_[0], &buses_[1]}, clock_, board_, parameters, &storage_),
      watch_(parameters.presence()) {
  app::Parameters ignored;
  storage_.load(ignored);  // readies the log
  drives_[0].plant.stop_rad = 0.0;
  drives_[0].plant.q_rad = 0.005;
  drives_[1].plant.q_rad = 0.562;
  drives_[2].plant.q_rad = -1.420;
  for (std::size_t i = 1; i < drives_.size(); ++i) {
    drives_[i].plant.inertia_kg_m2 = 0.5;
    drives_[i].plant.friction_Nm = 2.0;
    drives_[i].plant.torque_limit_Nm = 400.0;
  }
}

void LoopRig::send_sync(std::uint32_t number) {
  for (FuzzBus& bus : buses_) bus.arriving.push_back(encode(protocol::Sync{number}));
}

void LoopRig::beat() {
  send_sync(tick_++);
  silence();
}

void LoopRig::silence() {
  jump_clock(kMillisecond_ns);
  poll();
  for (RigDrive& drive : drives_) drive.run();
}

void LoopRig::poll() {
  watch_.before({&buses_[0], &buses_[1]}, loop_, clock_.now_ns());
  watch_.before(board_, flash_);
  loop_.poll();
  watch_.after(loop_);
  watch_.after(board_, flash_, loop_);
  deliver();
}

/// What the foot sent reaches the drives and the supervisor.
void LoopRig::deliver() {
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    for (const hal::CanFrame& frame : buses_[b].sent) {
      for (const Drive drive : protocol::kDrives) {
        if (bus_of(drive) == b) drives_[index(drive)].take(drive, frame, buses_[b]);
      }
      protocol::OrderAcknowledge answer;
      if (decode(frame, answer) == DecodeResult::kOk) expected_counter_ = answer.expected_counter;
      protocol::ServiceAnswer service;
      if (decode(frame, service) == DecodeResult::kOk) follow(service);
    }
    buses_[b].sent.clear();
  }
}

void LoopRig::follow(const protocol::ServiceAnswer& answer) {
  const bool reads = answer.service == protocol::Service::kReadParameter ||
                     answer.service == protocol::Service::kReadStatus ||
                     answer.service == protocol::Service::kReadFaultLog;
  if (reads) return;
  if (answer.result == protocol::ServiceResult::kBadCounter) {
    expected_counter_ = static_cast<std::uint8_t>(answer.value);
  } else if (answer.result == protocol::ServiceResult::kDone) {
    expected_counter_ = static_cast<std::uint8_t>(answer.counter + 1);
  }
}

void LoopRig::connect(std::uint8_t who, std::uint32_t hash) {
  buses_[0].arriving.push_back(encode(protocol::SupervisorConnect{who, hash, 0}));
}

void LoopRig::send_order(protocol::SupervisorOrder order, std::uint8_t counter_error,
                         bool break_crc) {
  connect(order.supervisor_id, protocol::kProtocolHash);
  order.counter = static_cast<std::uint8_t>(expected_counter_ + counter_error);
  hal::CanFrame frame = encode(order);
  if (break_crc) frame.data[frame.length - 1u] ^= 0x01;
  buses_[0].arriving.push_back(frame);
}

}  // namespace hoof::tests::fuzz
