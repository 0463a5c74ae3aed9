// The whole firmware with three plain drives behind the codec, on buses that the fuzzer holds.
// Every poll is watched.
#pragma once

#include <array>

#include "firmware/app/control_loop.h"
#include "hal/in_process/ram_flash.h"
#include "hal/in_process/soft_board.h"
#include "hal/stepped_clock.h"
#include "tests/firmware/control/joint_plant.h"
#include "tests/fuzz/fuzz_bus.h"
#include "tests/fuzz/loop_watch.h"

namespace hoof::tests::fuzz {

/// A drive as the bus sees it; answers each command with its state.
struct RigDrive {
  firmware::control::test::JointPlant plant;
  double zero_rad = 0.0;  // reading = plant angle - zero
  bool silent = false;
  std::uint8_t error = 0;
  float temperature_C = 25.0f;
  bool entered = false;
  int age_ms = 1000;  // since the last command
  firmware::protocol::DriveOrder last;

  /// Takes a frame that the foot sent; the answer goes to `bus`.
  void take(firmware::protocol::Drive which, const hal::CanFrame& frame, FuzzBus& bus);
  /// A millisecond; the torque ends 20 ms after the last command.
  void run();
};

class LoopRig {
 public:
  explicit LoopRig(const firmware::app::Parameters& parameters);

  /// One millisecond of SYNC, poll, answers, motion.
  void beat();
  /// The same without SYNC.
  void silence();
  void poll();
  void jump_clock(std::int64_t step_ns) { clock_.advance_to(clock_.now_ns() + step_ns); }
  void send_sync(std::uint32_t number);
  /// Puts an order with the expected counter, or another, on the bus, behind a connection.
  void send_order(firmware::protocol::SupervisorOrder order, std::uint8_t counter_error,
                  bool break_crc);
  /// A write or a service with the expected counter, or another.
  template <typename M>
  void send_service(M request, std::uint8_t counter_error) {
    request.counter = static_cast<std::uint8_t>(expected_counter_ + counter_error);
    buses_[0].arriving.push_back(encode(request));
  }
  void connect(std::uint8_t who, std::uint32_t hash);

  FuzzBus& bus(std::size_t index) { return buses_[index % buses_.size()]; }
  RigDrive& drive(std::size_t index) { return drives_[index % drives_.size()]; }
  firmware::app::ControlLoop& loop() { return loop_; }
  hal::SoftBoard& board() { return board_; }
  LoopWatch& watch() { return watch_; }

 private:
  void deliver();
  void follow(const firmware::protocol::ServiceAnswer& answer);

  std::array<FuzzBus, firmware::protocol::kBusCount> buses_;
  hal::SteppedClock clock_;
  hal::SoftBoard board_;
  /// Small: a set of parameters each, and a log of two records.
  hal::RamFlash flash_{{512, 512, 700}};
  firmware::app::Storage storage_{flash_};
  std::array<RigDrive, firmware::protocol::kDriveCount> drives_;
  firmware::app::ControlLoop loop_;
  LoopWatch watch_;
  std::uint32_t tick_ = 0;
  std::uint8_t expected_counter_ = 0;
};

}  // namespace hoof::tests::fuzz
