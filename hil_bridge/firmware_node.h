// Whoever answers SYNC in a run: the control loop in this process, or one elsewhere on the bus.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "firmware/app/control_loop.h"
#include "hal/in_process/soft_board.h"

namespace hoof::bridge {

class FirmwareNode {
 public:
  virtual ~FirmwareNode() = default;

  /// Once per exchange interval, when the plant stands at the present time.
  /// @param tick number of the SYNC sent last, to name what is not answered
  virtual void poll(std::uint32_t tick) = 0;

  /// What is known of the firmware's last tick: all of it in this process, else what the bus tells.
  virtual const firmware::app::Telemetry& telemetry() const = 0;
  virtual firmware::control::Mode mode() const { return telemetry().mode; }
  virtual firmware::control::FaultBits faults() const { return telemetry().faults; }

  /// The board under the firmware, its button and its supply; null where it is out of reach.
  virtual hal::SoftBoard* board() { return nullptr; }

  /// Ends the firmware where it is and starts it anew, knowing nothing but its parameters.
  /// @return false where that cannot be done from here
  virtual bool restart(hal::ResetCause) { return false; }

  /// Who does not answer any more, since which tick; empty while all is well.
  virtual const std::string& lost() const {
    static const std::string none;
    return none;
  }
};

/// Makes the node of a run on its two connections; the clock is that of the run.
using FirmwareMaker = std::function<std::unique_ptr<FirmwareNode>(
    hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock)>;

class LocalFirmware final : public FirmwareNode {
 public:
  LocalFirmware(hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock,
                const firmware::app::Parameters& parameters)
      : buses_{&bus0, &bus1}, clock_(clock), parameters_(parameters) {
    loop_.emplace(buses_, clock_, board_, parameters_);
  }

  void poll(std::uint32_t) override { loop_->poll(); }
  const firmware::app::Telemetry& telemetry() const override { return loop_->telemetry(); }
  firmware::control::Mode mode() const override { return loop_->mode(); }
  firmware::control::FaultBits faults() const override { return loop_->faults(); }
  hal::SoftBoard* board() override { return &board_; }
  bool restart(hal::ResetCause cause) override {
    board_.cause = cause;
    loop_.emplace(buses_, clock_, board_, parameters_);
    return true;
  }

 private:
  firmware::app::ControlLoop::Buses buses_;
  const hal::Clock& clock_;
  firmware::app::Parameters parameters_;
  hal::SoftBoard board_;
  std::optional<firmware::app::ControlLoop> loop_;  // always there; it can start anew
};

inline FirmwareMaker local_firmware(const firmware::app::Parameters& parameters) {
  return [parameters](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
    return std::make_unique<LocalFirmware>(bus0, bus1, clock, parameters);
  };
}

}  // namespace hoof::bridge
