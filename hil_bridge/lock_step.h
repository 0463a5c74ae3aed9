// The real firmware and the simulated plant on one clock: SYNC k, the firmware's answer over the
// buses, one millisecond of plant, SYNC k + 1. However slow the sand is, control notices nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "firmware/app/control_loop.h"
#include "hal/stepped_clock.h"
#include "hil_bridge/drive_node.h"
#include "hil_bridge/firmware_node.h"
#include "hil_bridge/supervisor.h"
#include "hil_bridge/wires.h"
#include "sim/experiments/experiment.h"

namespace hoof::bridge {

/// Torques at the joint and the drives' orders, as seen over one tick.
struct TickTorques {
  std::array<double, sim::kJointCount> mean_Nm{};    // gear on joint
  std::array<double, sim::kJointCount> peak_Nm{};    // largest magnitude of any exchange interval
  std::array<double, sim::kJointCount> limited_s{};  // time for which the drive's own limit clipped
  std::array<double, sim::kJointCount> push_Nm{};    // largest of a motor along its rotor's motion
};

/// Ties the ticks of a run to something outside, for instance to the wall's clock.
class Pace {
 public:
  virtual ~Pace() = default;

  /// The tick's plant time is done: comes back when the next tick is due.
  /// @param poll takes and answers what has come in; may be called any number of times
  /// @return ticks that have become due, at least 1; the plant must go on by all of them
  virtual std::uint32_t rest(const std::function<void()>& poll) = 0;
};

class LockStep {
 public:
  static constexpr std::int64_t kTick_ns = 1'000'000;

  /// @throws std::invalid_argument where the plant's exchange interval does not divide a tick
  LockStep(sim::Experiment& experiment, const firmware::app::Parameters& parameters, Wires& wires);

  /// With a firmware that may be elsewhere, and at a pace that is not the plant's own where `pace`
  /// is not null; it must outlive this.
  LockStep(sim::Experiment& experiment, const FirmwareMaker& firmware, Wires& wires,
           Pace* pace = nullptr);

  /// One control period. @throws std::runtime_error when the plant diverges
  void tick();

  Supervisor& supervisor() { return supervisor_; }
  const Supervisor& supervisor() const { return supervisor_; }
  FirmwareNode& firmware() { return *firmware_; }
  const FirmwareNode& firmware() const { return *firmware_; }
  const TickTorques& torques() const { return torques_; }
  std::uint32_t ticks() const { return tick_; }
  std::int64_t now_ns() const { return clock_.now_ns(); }

 private:
  void send_sync();
  void poll_nodes();
  void exchange(bool first, bool last);

  sim::Experiment& experiment_;
  Wires& wires_;
  hal::SteppedClock clock_;
  std::array<hal::CanBus*, kBusCount> master_{};
  std::unique_ptr<FirmwareNode> firmware_;
  Supervisor supervisor_;
  std::vector<DriveNode> drives_;
  std::int64_t exchange_ns_;
  Pace* pace_ = nullptr;
  std::uint32_t tick_ = 0;
  std::uint32_t due_ticks_ = 1;  // more than one only where a pace went on without us
  TickTorques torques_;
};

}  // namespace hoof::bridge
