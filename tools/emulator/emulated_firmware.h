// The board's image in the firmware's place on the buses of a lock-step run.
#pragma once

#include <memory>
#include <string>

#include "firmware/app/parameters.h"
#include "hal/in_process/soft_board.h"
#include "hil_bridge/bus_telemetry.h"
#include "hil_bridge/firmware_node.h"
#include "hil_bridge/wires.h"
#include "tools/emulator/board.h"

namespace hoof::tools::emulator {

/// Data sectors with this set stored in them, by the firmware's own code, as after the service that
/// stores parameters. @throws std::invalid_argument where a value is out of its range
hal::RamFlash flash_with(const firmware::app::Parameters& parameters);

/// Powers the board on and lets it run alone for 1.6 s, until its 17th heartbeat is due, which is
/// the first once more: time 0 of a run, as it is for a loop that starts in process.
/// @return board time then
Cycles run_to_start(Board& board);

class EmulatedFirmware final : public bridge::FirmwareNode {
 public:
  using Buses = std::array<hal::CanBus*, Board::kBuses>;

  /// Time 0 of the run is where run_to_start() ends.
  /// @param buses of the board  @param listeners connections of their own, to know what it tells
  EmulatedFirmware(const ElfFile& image, hal::RamFlash flash, Buses buses, Buses listeners,
                   const hal::Clock& clock);

  void poll(std::uint32_t tick) override;
  const firmware::app::Telemetry& telemetry() const override { return told_.latest(); }
  /// What is asked of it acts with the next poll: button, early warning, supply (0: nothing is
  /// wired).
  hal::SoftBoard* board() override { return &asked_; }
  bool restart(hal::ResetCause cause) override;

  Board& emulated_board() { return board_; }
  hal::RamFlash& flash() { return flash_; }

 private:
  void act_on_board();

  hal::RamFlash flash_;
  Board board_;
  hal::SoftBoard asked_, acted_;
  Buses listeners_;
  const hal::Clock& clock_;
  bridge::BusTelemetry told_;
  Cycles start_ = 0;  // board time at time 0 of the run
};

/// @param image file of `hoof firmware build`
/// @param wires of the run; must outlive the node  @throws std::runtime_error where there is none
bridge::FirmwareMaker emulated_firmware(const std::string& image,
                                        const firmware::app::Parameters& parameters,
                                        bridge::Wires& wires);

}  // namespace hoof::tools::emulator
