// A firmware in another process, in lock-step with this one.
#pragma once

#include <array>
#include <deque>

#include "hal/clock.h"
#include "hal/lock_step_frame.h"
#include "hil_bridge/bus_telemetry.h"
#include "hil_bridge/firmware_node.h"
#include "hil_bridge/foot_line.h"
#include "hil_bridge/wires.h"

namespace hoof::bridge {

/// Stands on the run's simulated wires in the foot's place: what arrives there goes to the other
/// process at the simulated time of its arrival, and what that process sends comes out here at the
/// same time. So the wires, with their arbitration and frame times, are the same ones as with the
/// firmware in this process, and so is every frame on them (hal/lock_step_frame.h).
///
/// Frames of others on the interface (an order, an e-stop, a foreign node) go onto the simulated
/// wires, too; the firmware has had them already.
class RemoteFoot final : public FirmwareNode {
 public:
  /// Starts the firmware anew at simulated time 0.
  /// @param line, buses, visitors, clock must outlive this; visitors: connections of their own for
  /// frames of others
  /// @param patience_ns longest wait for an answer, by the wall
  /// @throws std::runtime_error where the firmware does not begin
  RemoteFoot(FootLine& line, std::array<hal::CanBus*, kBusCount> buses,
             std::array<hal::CanBus*, kBusCount> visitors, const hal::Clock& clock,
             std::int64_t patience_ns);
  ~RemoteFoot();

  void poll(std::uint32_t tick) override;
  const firmware::app::Telemetry& telemetry() const override { return telemetry_.latest(); }
  const std::string& lost() const override { return lost_; }

 private:
  bool forward_arrivals();
  bool is_visitor_s(const hal::CanFrame& frame);
  void send(int bus, const hal::CanFrame& frame);
  void flush_line();
  void go(bool answer);
  bool await_done(std::int64_t time_ns);
  bool take(int interface, const hal::CanFrame& frame, std::int64_t time_ns);
  void put_on_wire(int bus, const hal::CanFrame& frame);
  int free_mailboxes(int bus) const;
  void flush();

  FootLine& line_;
  std::array<hal::CanBus*, kBusCount> buses_;
  std::array<hal::CanBus*, kBusCount> visitors_;
  const hal::Clock& clock_;
  std::int64_t patience_ns_;
  std::array<std::deque<hal::CanFrame>, kBusCount> waiting_;  // for a free mailbox
  std::deque<hal::CanFrame> visitors_frames_;  // on the simulated wires, not to be forwarded
  std::int64_t due_ns_ = 0;                    // the firmware must be polled then, frames or not
  bool left_ = false;                          // it said so
  BusTelemetry telemetry_;
  std::string lost_;
};

}  // namespace hoof::bridge
