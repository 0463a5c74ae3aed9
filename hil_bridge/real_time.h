// Ticks by the wall's clock, for a firmware that has a clock of its own: a board, or hoof-firmware.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hil_bridge/bus_telemetry.h"
#include "hil_bridge/deadline_schedule.h"
#include "hil_bridge/firmware_node.h"
#include "hil_bridge/lock_step.h"

namespace hoof::bridge {

/// Asks the system for what a real-time loop needs: SCHED_FIFO, memory that is not paged out, and
/// timers without slack. @return what was refused, in words, with what would grant it
std::vector<std::string> become_real_time();

/// Sleeps to absolute deadlines of CLOCK_MONOTONIC, answering what comes in meanwhile. The plant's
/// millisecond is computed at its start, so it is up to a millisecond old when a command finds it.
/// rest() throws std::runtime_error where the plant falls behind for good.
class RealTimePace final : public Pace {
 public:
  explicit RealTimePace(std::int64_t period_ns) : period_ns_(period_ns) {}

  /// A socket whose frames end the wait for the deadline early. Before the first tick.
  void watch(int descriptor) { descriptors_.push_back(descriptor); }

  std::uint32_t rest(const std::function<void()>& poll) override;

  /// Nothing before the first tick.
  const std::optional<DeadlineSchedule>& schedule() const { return schedule_; }

 private:
  void wait_for_frames(std::int64_t until_ns) const;

  std::int64_t period_ns_;
  std::vector<int> descriptors_;
  std::optional<DeadlineSchedule> schedule_;
};

/// A foot that is on the real bus by itself: this node only listens.
class BusFoot final : public FirmwareNode {
 public:
  /// @param name of the interfaces, for messages
  BusFoot(hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock, std::string name)
      : buses_{&bus0, &bus1}, clock_(clock), name_(std::move(name)) {}

  void poll(std::uint32_t tick) override;
  const firmware::app::Telemetry& telemetry() const override { return telemetry_.latest(); }
  const std::string& lost() const override { return lost_; }

 private:
  std::array<hal::CanBus*, 2> buses_;
  const hal::Clock& clock_;
  std::string name_;
  BusTelemetry telemetry_;
  std::uint64_t heard_frames_ = 0;
  std::int64_t heard_ns_ = 0;
  std::uint32_t heard_tick_ = 0;
  std::string lost_;
};

}  // namespace hoof::bridge
