// The firmware as a whole: read, decide, gate, write, once per SYNC.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/app/inbox.h"
#include "firmware/app/order_desk.h"
#include "firmware/app/outbox.h"
#include "firmware/app/ownership.h"
#include "firmware/app/parameters.h"
#include "firmware/app/service_desk.h"
#include "firmware/app/storage.h"
#include "firmware/app/telemetry.h"
#include "firmware/app/update_desk.h"
#include "firmware/control/foot_controller.h"
#include "firmware/safety/board_heat.h"
#include "firmware/safety/cycle_watch.h"
#include "firmware/safety/overrun.h"
#include "firmware/safety/supply.h"
#include "firmware/safety/torque_gate.h"
#include "hal/board.h"
#include "hal/can_bus.h"
#include "hal/clock.h"

namespace hoof::firmware::app {

/// Arithmetic counts SYNC ticks of one millisecond each, so a slow master only makes it slow. The
/// local clock is for one thing: to notice that SYNC or a drive has fallen silent.
///
/// Owns no thread and no timer: call poll() at least once per millisecond of the clock, and
/// whenever a frame may have arrived.
class ControlLoop {
 public:
  using Buses = std::array<hal::CanBus*, protocol::kBusCount>;

  /// @param buses two connections; they may lead to one wire
  /// @param storage from which the parameters were loaded; null where nothing is kept
  /// @param slots null where the firmware cannot be updated
  /// All but the parameters must outlive the loop.
  ControlLoop(Buses buses, const hal::Clock& clock, hal::Board& board, const Parameters& parameters,
              Storage* storage = nullptr, hal::ImageSlots* slots = nullptr);
  ControlLoop(const ControlLoop&) = delete;
  ControlLoop& operator=(const ControlLoop&) = delete;

  void poll();

  /// When poll() would next do something without any frame having come: silence to be noticed, a
  /// heartbeat, a frame to be sent again. Not after now where that is already the case. Tells a
  /// simulator when it need not ask; between two calls of poll() it does not change.
  std::int64_t next_due_ns() const;

  /// Whether a frame waits that the bus did not take: only then poll() is of use when one has been
  /// sent.
  bool waits_for_room() const { return some_exit_unsent_ || !outbox_.empty(); }

  /// Ends the operation from this side, as the order to stop would: a leg is let down, then off.
  void request_stop() { controller_.order_stop(); }
  /// Torque off at once, as the e-stop frame would.
  void emergency_stop();
  /// Sends every drive its exit frame once more: the last thing before the program ends.
  void release_drives() { write({}); }

  const Telemetry& telemetry() const { return telemetry_; }
  const Parameters& parameters() const { return parameters_; }
  control::Mode mode() const { return controller_.mode(); }
  control::FaultBits faults() const { return controller_.faults(); }

 private:
  // Functions that are not to be merged into others are stages of the tick, whose cost is told
  // (tests/tools/emulator/tick_cost.cpp).

  void examine_start();
  void watch_buses();
  void watch_sync(std::int64_t now_ns);
  void watch_button();
  void read(std::int64_t now_ns);
  void answer_orders(std::int64_t now_ns);
  void answer_services(std::int64_t now_ns);
  void adopt_parameters();
  void watch_update(std::int64_t now_ns);
  void run_due_tick(std::int64_t now_ns);
  [[gnu::noinline]] void tick(std::int64_t now_ns, std::uint32_t elapsed_ticks);
  void adopt_toe_zero();
  [[gnu::noinline]] void write(const control::PerJoint<control::JointWish>& joints);
  void send_exit_again();
  void note_exit_unsent();
  void keep_fault_log(std::int64_t now_ns);
  [[gnu::noinline]] void trace();
  [[gnu::noinline]] void record(std::int64_t now_ns);
  protocol::Heartbeat next_heartbeat() const;
  std::int64_t heartbeat_due_ns() const;
  [[gnu::noinline]] void send_heartbeat_if_due(std::int64_t now_ns);
  void queue(const hal::CanFrame& frame);
  void trip(control::FaultBits faults);

  Buses buses_;
  const hal::Clock& clock_;
  hal::Board& board_;
  Storage* storage_;
  Parameters parameters_;
  Counters counters_;
  Inbox inbox_;
  control::FootController controller_;
  safety::TorqueGate gate_;
  safety::CycleWatch cycle_;
  safety::OverrunWatch overrun_;
  safety::SupplyWatch supply_;
  safety::BoardHeatWatch heat_;
  Ownership ownership_;
  OrderDesk orders_;
  UpdateDesk update_;
  ServiceDesk services_;
  Outbox outbox_;
  Telemetry telemetry_;

  bool synced_ = false;
  std::int64_t last_sync_ns_ = 0;
  std::int64_t last_tick_ns_ = 0;
  control::PerJoint<bool> exit_unsent_{};  // an e-stop's exit frame that the bus did not take
  bool some_exit_unsent_ = false;
  control::Mode mode_before_ = control::Mode::kOff;  // at the begin of this poll
  control::FaultBits logged_faults_ = 0;
  std::int64_t log_step_ns_ = 0;
  protocol::Heartbeat heartbeat_;
  bool heartbeat_sent_ = false;
  std::int64_t heartbeat_ns_ = 0;
};

}  // namespace hoof::firmware::app
