// hoof-firmware --clock lock-step: the control loop at the pace of a simulator in another process.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "firmware/app/control_loop.h"
#include "firmware/board/host/lock_step_clock.h"
#include "firmware/board/host/options.h"
#include "firmware/board/stepped_connection.h"
#include "hal/in_process/soft_board.h"
#include "hal/lock_step_frame.h"
#include "hal/socketcan/socketcan_bus.h"

namespace hoof::firmware::board {

/// Lives by the wall's clock until a simulator begins; then time is what the simulator says
/// (hal/lock_step_frame.h). A simulator that says nothing for options.patience_s is taken for dead:
/// time runs on by the wall, and the loop's own time-outs act.
class LockStepFoot {
 public:
  /// @throws std::runtime_error naming the interface and what to do
  LockStepFoot(const Options& options, const app::Parameters& parameters, app::Storage* storage);

  /// Until `interrupted`; then lets the leg down and leaves with the drives off.
  void run(const std::atomic<bool>& interrupted);

  const app::ControlLoop& loop() const { return *loop_; }
  /// Frames that the kernel lost on the way here.
  std::uint64_t dropped() const {
    return socket0_->status().dropped + (socket1_ ? socket1_->status().dropped : 0);
  }

 private:
  static constexpr std::size_t kMostWaiting = 4096;  // of a flood from elsewhere
  using Connection = SteppedConnection<hal::SocketCanBus, kMostWaiting>;

  void start_loop(const app::Parameters& parameters);
  void free_step();
  void listen(std::int64_t longest_ns);
  void drain_bus1();
  void take(const hal::CanFrame& frame);
  void begin();
  void step(const hal::lock_step::Go& go);
  void run_on(const char* why);
  void answer(std::int64_t time_ns);
  void mind_silence();
  void flush();
  void send_now(const hal::CanFrame& frame);

  hal::MonotonicClock wall_;
  std::int64_t patience_ns_;
  app::Storage* storage_;
  std::unique_ptr<hal::SocketCanBus> socket0_;
  std::unique_ptr<hal::SocketCanBus> socket1_;  // null where one interface carries both buses
  std::array<std::unique_ptr<Connection>, protocol::kBusCount> buses_;
  LockStepClock clock_;
  hal::SoftBoard board_;
  std::optional<app::ControlLoop> loop_;
  bool heard_ = false;  // the simulator, since mind_silence() was called last
  std::optional<std::int64_t> silent_since_ns_;  // by the wall
};

}  // namespace hoof::firmware::board
