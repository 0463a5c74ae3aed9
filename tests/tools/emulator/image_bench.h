// A whole test with the board's image in the firmware's place, on the rigid floor.
#pragma once

#include <cstdlib>
#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "firmware/app/received_ids.h"
#include "firmware/protocol/codec.h"
#include "hal/in_process/soft_board.h"
#include "tests/hil_bridge/rigid_bench.h"
#include "tools/emulator/emulated_firmware.h"

namespace hoof::test {

/// What `tools/hoof firmware build` made (the CTest fixture board_image).
inline std::string image_file() {
  return HOOF_BOARD_IMAGE;
}

struct RunRecord {
  std::vector<SeenFrame> frames;
  bridge::SessionResult result;
};

/// Makes the maker of a firmware for the wires of a run.
using FirmwareOn = std::function<bridge::FirmwareMaker(bridge::Wires&)>;

inline FirmwareOn host(const tools::RunSettings& run) {
  return [&run](bridge::Wires&) { return bridge::local_firmware(run.parameters); };
}

/// What a board's controller has received and its filters let through.
class WakingBus final : public hal::CanBus {
 public:
  WakingBus(hal::CanBus& inner, std::size_t bus) : inner_(inner) {
    firmware::app::for_each_received_id(bus, [this](std::uint32_t id) { ids_.insert(id); });
  }

  /// @param for_room also where something was sent
  /// @return true where something came since the last call
  bool wakes(bool for_room) {
    const std::size_t had = waiting_.size();
    hal::CanFrame frame;
    while (inner_.receive(frame)) {
      if (!frame.extended && ids_.count(frame.id) != 0) waiting_.push_back(frame);
    }
    const std::uint64_t sent = inner_.status().sent;
    const bool wakes = waiting_.size() > had || (for_room && sent != sent_);
    sent_ = sent;
    return wakes;
  }

  hal::SendResult send(const hal::CanFrame& frame) override { return inner_.send(frame); }
  void withdraw(std::uint32_t id) override { inner_.withdraw(id); }
  hal::BusStatus status() const override { return inner_.status(); }
  bool receive(hal::CanFrame& frame) override {
    if (waiting_.empty()) return false;
    frame = waiting_.front();
    waiting_.pop_front();
    return true;
  }

 private:
  hal::CanBus& inner_;
  std::set<std::uint32_t> ids_;
  std::deque<hal::CanFrame> waiting_;
  std::uint64_t sent_ = 0;
};

/// What is asked of a board, its supply as a converter tells it that is read and started anew once
/// a millisecond, behind the turn of the loop.
class MeasuringBoard final : public hal::Board {
 public:
  hal::SoftBoard asked;

  void convert() { told_V_ = std::exchange(sampled_V_, asked.volts); }

  hal::ResetCause reset_cause() const override { return asked.reset_cause(); }
  void feed_watchdog() override { asked.feed_watchdog(); }
  bool emergency_stop_pressed() const override { return asked.emergency_stop_pressed(); }
  void allow_drives(bool allowed) override { asked.allow_drives(allowed); }
  bool supply_low() const override { return asked.supply_low(); }
  float supply_V() const override { return told_V_; }
  float temperature_C() const override { return asked.temperature_C(); }

 private:
  float sampled_V_ = 0, told_V_ = 0;
};

/// The loop in this process, polled when a board's would be: after what its buses brought, where a
/// frame waits for room also after what they took, and with SysTick every millisecond. Whoever
/// polls more often notices sooner that something is missing.
class HostAtBoardPace final : public bridge::FirmwareNode {
 public:
  HostAtBoardPace(hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock,
                  const firmware::app::Parameters& parameters)
      : buses_{WakingBus(bus0, 0), WakingBus(bus1, 1)}, clock_(clock), parameters_(parameters) {
    start();
  }

  void poll(std::uint32_t) override {
    const bool for_room = loop_->waits_for_room();
    const bool by_bus0 = buses_[0].wakes(for_room), by_bus1 = buses_[1].wakes(for_room);
    const bool by_break = board_.asked.pressed && !was_pressed_;
    was_pressed_ = board_.asked.pressed;
    const bool by_tick = clock_.now_ns() % 1'000'000 == 0;
    if (by_bus0 || by_bus1 || by_break || by_tick) loop_->poll();
    if (by_tick) board_.convert();
  }
  const firmware::app::Telemetry& telemetry() const override { return loop_->telemetry(); }
  firmware::control::Mode mode() const override { return loop_->mode(); }
  firmware::control::FaultBits faults() const override { return loop_->faults(); }
  hal::SoftBoard* board() override { return &board_.asked; }
  /// As a board, which polls once before it first sleeps.
  bool restart(hal::ResetCause cause) override {
    board_.asked.cause = cause;
    start();
    loop_->poll();
    return true;
  }

 private:
  void start() {
    const firmware::app::ControlLoop::Buses buses{&buses_[0], &buses_[1]};
    loop_.emplace(buses, clock_, board_, parameters_);
  }

  std::array<WakingBus, 2> buses_;
  const hal::Clock& clock_;
  firmware::app::Parameters parameters_;
  MeasuringBoard board_;
  bool was_pressed_ = false;
  std::int64_t polled_ns_ = 0, tick_ns_ = 0;        // last; a tick of SysTick
  std::optional<firmware::app::ControlLoop> loop_;  // always there; it can start anew
};

inline FirmwareOn host_at_board_pace(const tools::RunSettings& run) {
  return [&run](bridge::Wires&) {
    return [&run](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
      return std::make_unique<HostAtBoardPace>(bus0, bus1, clock, run.parameters);
    };
  };
}

inline FirmwareOn image(const tools::RunSettings& run) {
  return [&run](bridge::Wires& wires) {
    return tools::emulator::emulated_firmware(image_file(), run.parameters, wires);
  };
}

/// @param most_ticks then the run ends
inline RunRecord record_run(const tools::RunSettings& run, const FirmwareOn& firmware,
                            std::uint32_t most_ticks = UINT32_MAX) {
  RunRecord record;
  const auto experiment = rigid_bench(run);
  const auto wires = bridge::in_process_wires([&](int bus, const hal::CanFrame& frame) {
    record.frames.push_back({bus, frame});
  });
  std::uint32_t ticks = 0;
  bridge::FaultTimeline faults(run.faults, run.has_drives());
  bridge::SessionSettings settings = tools::session_settings(run);
  if (!run.faults.empty()) settings.faults = &faults;
  record.result =
      bridge::run_session(*experiment, firmware(*wires), *wires, settings,
                          [&](const bridge::TickRecord&) { return ++ticks < most_ticks; });
  return record;
}

inline bool is_command(const hal::CanFrame& frame) {
  for (const auto drive : firmware::protocol::kDrives) {
    if (frame.id == firmware::protocol::command_spec(drive).id) return true;
  }
  return false;
}

}  // namespace hoof::test
