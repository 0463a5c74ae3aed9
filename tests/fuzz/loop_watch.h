// What must hold after every poll of the control loop, whatever came in. Judged from outside: by
// the frames that went in and came out, and by the loop's telemetry.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/app/control_loop.h"
#include "firmware/protocol/codec.h"
#include "hal/in_process/ram_flash.h"
#include "hal/in_process/soft_board.h"
#include "tests/fuzz/fuzz_bus.h"

namespace hoof::tests::fuzz {

class LoopWatch {
 public:
  using Buses = std::array<FuzzBus*, firmware::protocol::kBusCount>;

  explicit LoopWatch(firmware::control::JointPresence presence) : presence_(presence) {}

  /// Looks at the frames that the coming poll will take.
  void before(Buses buses, const firmware::app::ControlLoop& loop, std::int64_t now_ns);
  /// Looks at what the poll made of them; aborts at the first demand that is not met.
  void after(const firmware::app::ControlLoop& loop);
  void before(const hal::SoftBoard& board, const hal::RamFlash& flash);
  void after(const hal::SoftBoard& board, const hal::RamFlash& flash,
             const firmware::app::ControlLoop& loop);
  /// The program itself called emergency_stop().
  void stopped_by_program() { emergency_ = true; }

 private:
  /// What one poll took in.
  struct Heard {
    bool emergency_stop = false;
    bool sync = false;
    bool start = false;  // an order that may start motion, CRC right
    bool reset = false;  // an order that may clear faults, CRC right
  };

  void hear(const hal::CanFrame& frame, std::size_t bus);
  void hear_order(const hal::CanFrame& frame);
  void check_modes(const firmware::app::ControlLoop& loop);
  void check_freshness(const firmware::app::ControlLoop& loop);
  void check_sent(const firmware::app::ControlLoop& loop);
  void check_drive_frame(std::size_t joint, const hal::CanFrame& frame,
                         firmware::control::Mode mode);
  void check_command(std::size_t joint, const firmware::protocol::DriveCommand& command,
                     firmware::control::Mode mode);
  void check_telemetry(const firmware::app::ControlLoop& loop);
  void check_rate(std::size_t joint, const firmware::app::Telemetry& telemetry);

  firmware::control::JointPresence presence_;
  Buses buses_{};
  std::int64_t now_ns_ = 0;
  Heard heard_;
  std::uint32_t frames_ = 0;  // handed to the loop since start

  firmware::control::Mode mode_before_ = firmware::control::Mode::kOff;
  firmware::control::FaultBits faults_before_ = 0;
  std::uint32_t ticks_before_ = 0;
  firmware::control::PerJoint<float> torque_before_Nm_{};
  std::size_t erases_before_ = 0;
  std::uint32_t feeds_before_ = 0;
  std::uint32_t parameters_before_ = 0;  // CRC of all values

  firmware::control::PerJoint<firmware::protocol::DriveReply> measured_{};
  firmware::control::PerJoint<std::int64_t> replied_ns_{};
  std::int64_t synced_ns_ = 0;
  std::int64_t moving_since_ns_ = 0;  // first tick in a mode that moves
  bool moving_ticked_ = false;
  bool emergency_ = false;
};

}  // namespace hoof::tests::fuzz
