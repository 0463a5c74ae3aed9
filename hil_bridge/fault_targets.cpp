#include "hil_bridge/fault_targets.h"

#include "firmware/protocol/dictionary.h"
#include "hil_bridge/wires.h"
#include "sim/config/config_error.h"

namespace hoof::bridge {
namespace {

namespace protocol = firmware::protocol;
using Drives = std::array<bool, sim::kJointCount>;

[[noreturn]] void fail(const FaultSpec& fault, const std::string& rule) {
  throw sim::ConfigError(fault.origin.text() + ": " + fault.key + ".target = \"" + fault.target +
                         "\": " + rule);
}

std::optional<sim::Joint> joint_of(const std::string& name) {
  for (const sim::Joint joint : {sim::Joint::kToe, sim::Joint::kHip, sim::Joint::kKnee}) {
    if (name == sim::joint_name(joint)) return joint;
  }
  return {};
}

std::optional<int> bus_of(const std::string& name) {
  for (int bus = 0; bus < kBusCount; ++bus) {
    if (name == "can" + std::to_string(bus)) return bus;
  }
  return {};
}

std::string drive_names(const Drives& drives) {
  std::string names;
  for (int j = 0; j < sim::kJointCount; ++j) {
    if (!drives[std::size_t(j)]) continue;
    names += (names.empty() ? "" : ", ") + std::string(sim::joint_name(sim::Joint(j)));
  }
  return names.empty() ? "no drive" : names;
}

sim::Joint need_drive(const FaultSpec& fault, const Drives& drives) {
  const std::optional<sim::Joint> joint = joint_of(fault.target);
  if (!joint || !drives[std::size_t(*joint)]) {
    fail(fault, "must be a drive of this rig: " + drive_names(drives));
  }
  return *joint;
}

std::optional<sim::Joint> drive_of(protocol::Node node) {
  if (node == protocol::Node::kToeDrive) return sim::Joint::kToe;
  if (node == protocol::Node::kHipDrive) return sim::Joint::kHip;
  if (node == protocol::Node::kKneeDrive) return sim::Joint::kKnee;
  return {};
}

std::optional<FrameTarget> node_target(const FaultSpec& fault, const Drives& drives) {
  FrameTarget target;
  target.node = fault.target;
  if (joint_of(fault.target)) {
    need_drive(fault, drives);
    return target;
  }
  const bool known =
      fault.target == kFootNode || fault.target == kSyncNode || fault.target == kSupervisorNode;
  if (!known) return {};
  return target;
}

FrameTarget need_node(const FaultSpec& fault, const Drives& drives) {
  if (const auto target = node_target(fault, drives)) return *target;
  fail(fault, "must be a node of this rig: foot, sync, supervisor, " + drive_names(drives));
}

FrameTarget need_frames(const FaultSpec& fault, const Drives& drives) {
  FrameTarget target;
  if (const auto bus = bus_of(fault.target)) {
    target.bus = bus;
    return target;
  }
  if (const auto node = node_target(fault, drives)) return *node;
  std::string names;
  for (const protocol::MessageSpec& message : protocol::kMessages) {
    if (message.name == fault.target) {
      for (const protocol::Node node : {message.sender, message.receiver}) {
        const std::optional<sim::Joint> joint = drive_of(node);
        if (joint && !drives[std::size_t(*joint)]) {
          fail(fault, "this rig has no such drive, only " + drive_names(drives));
        }
      }
      target.id = message.id;
      return target;
    }
    names += ", " + std::string(message.name);
  }
  fail(fault, "must be a bus (can0, can1), a node (foot, sync, supervisor, " + drive_names(drives) +
                  ") or a message (" + names.substr(2) + ")");
}

FaultTarget frames_of(const FaultSpec& fault, const Drives& drives, FrameEffectKind effect) {
  FaultTarget target;
  target.effect = effect;
  target.frames = need_frames(fault, drives);
  return target;
}

FaultTarget node_of(const FaultSpec& fault, const Drives& drives, FrameEffectKind effect) {
  FaultTarget target;
  target.effect = effect;
  target.frames = need_node(fault, drives);
  return target;
}

FaultTarget drive_fault(const FaultSpec& fault, const Drives& drives, sim::DriveEffectKind effect) {
  FaultTarget target;
  target.drive_effect = effect;
  target.joint = need_drive(fault, drives);
  return target;
}

FaultTarget restart_of(const FaultSpec& fault, const Drives& drives) {
  if (fault.target != kFootNode && !joint_of(fault.target)) {
    fail(fault, "must be foot or a drive of this rig: " + drive_names(drives));
  }
  FaultTarget target = node_of(fault, drives, FrameEffectKind::kDead);
  target.joint = joint_of(fault.target);
  return target;
}

FaultTarget estop_of(const FaultSpec& fault) {
  FaultTarget target;
  if (fault.target == "line") return target;
  const std::optional<int> bus = bus_of(fault.target);
  if (!bus) fail(fault, "must be line (the button's wire), can0 or can1 (the frame on that bus)");
  target.floods = true;
  target.bus = *bus;
  return target;
}

FaultTarget flood_of(const FaultSpec& fault) {
  const std::optional<int> bus = bus_of(fault.target);
  if (!bus) fail(fault, "must be can0 or can1");
  FaultTarget target;
  target.floods = true;
  target.bus = *bus;
  return target;
}

}  // namespace

FaultTarget find_target(const FaultSpec& fault, const Drives& drives) {
  using D = sim::DriveEffectKind;
  using F = FrameEffectKind;
  switch (fault.kind) {
    case FaultKind::kDrop:
      return frames_of(fault, drives, F::kDrop);
    case FaultKind::kDelay:
      return frames_of(fault, drives, F::kDelay);
    case FaultKind::kReorder:
      return frames_of(fault, drives, F::kReorder);
    case FaultKind::kDuplicate:
      return frames_of(fault, drives, F::kDuplicate);
    case FaultKind::kCorrupt:
      return frames_of(fault, drives, F::kCorrupt);
    case FaultKind::kSyncJitter:
      if (fault.target != "Sync") fail(fault, "must be Sync, or left out");
      return frames_of(fault, drives, F::kJitter);
    case FaultKind::kFlood:
      return flood_of(fault);
    case FaultKind::kBusOff:
      return node_of(fault, drives, F::kBusOff);
    case FaultKind::kNodeSilent:
      return node_of(fault, drives, F::kSilent);
    case FaultKind::kNodeRestart:
      return restart_of(fault, drives);
    case FaultKind::kEncoderJump:
      return drive_fault(fault, drives, D::kEncoderJump);
    case FaultKind::kEncoderStuck:
      return drive_fault(fault, drives, D::kEncoderStuck);
    case FaultKind::kEncoderDrift:
      return drive_fault(fault, drives, D::kEncoderDrift);
    case FaultKind::kEncoderNoise:
      return drive_fault(fault, drives, D::kEncoderNoise);
    case FaultKind::kEncoderOffset:
      return drive_fault(fault, drives, D::kEncoderOffset);
    case FaultKind::kTorqueLoss:
      return drive_fault(fault, drives, D::kTorqueLoss);
    case FaultKind::kStall:
      return drive_fault(fault, drives, D::kStall);
    case FaultKind::kBrownOut:
      if (fault.target != kFootNode) fail(fault, "must be foot, or left out");
      return {};
    case FaultKind::kEstop:
      return estop_of(fault);
  }
  return {};
}

bool unseen_by_bus(const FaultSpec& fault, const FaultTarget& target) {
  if (fault.kind == FaultKind::kBrownOut) return true;
  if (fault.kind == FaultKind::kEstop && !target.floods) return true;
  if (!target.frames) return false;
  if (target.frames->node) return *target.frames->node == kFootNode;
  if (!target.frames->id) return true;  // all frames of a bus, the foot's among them
  for (const protocol::MessageSpec& message : protocol::kMessages) {
    if (message.id == *target.frames->id) return message.sender == protocol::Node::kFoot;
  }
  return false;
}

}  // namespace hoof::bridge
