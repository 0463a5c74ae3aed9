// A bxCAN peripheral for tests: what its registers do, after RM0090, 32.7 to 32.9. No wire: the
// test says when a frame goes out, comes in, or fails.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "hal/bxcan/registers.h"

namespace hoof::tests {

struct SimulatedFrame {
  std::uint32_t identifier = 0;  // as in RIxR, TIxR, without TXRQ
  std::uint32_t length = 0;
  std::uint32_t low = 0;
  std::uint32_t high = 0;
};

class SimulatedBxCan final : public hal::RegisterWatcher {
 public:
  SimulatedBxCan();
  ~SimulatedBxCan();
  SimulatedBxCan(const SimulatedBxCan&) = delete;

  hal::bxcan::Registers registers;
  bool present = true;         // else its registers read 0 and forget what is written
  bool hears_idle_bus = true;  // else it never leaves initialisation
  std::size_t reads = 0;
  std::vector<std::string> faults;  // what software may not do

  /// The next frame by the rules of TXFP = 0, gone out and acknowledged.
  std::optional<SimulatedFrame> transmit();
  /// A frame comes in. @return false when it was lost: the FIFO was full
  bool receive(std::size_t fifo, const SimulatedFrame& frame);
  /// Into the FIFO that the filters of this controller say. @return the FIFO, or none
  std::optional<std::size_t> filtered(std::size_t controller, std::uint32_t identifier) const;
  void error(std::uint32_t last_error_code, std::uint8_t transmit_errors,
             std::uint8_t receive_errors);
  void go_bus_off();
  /// 128 times eleven recessive bits were heard.
  void hear_recovery();

  std::uint32_t on_read(hal::Register& accessed) override;
  void on_write(hal::Register& accessed, std::uint32_t value) override;

 private:
  bool initialising() const { return (registers.MSR.stored() & 1) != 0; }
  bool write_mailbox(hal::Register& accessed, std::uint32_t value);
  void write_status(std::uint32_t value);
  bool write_fifo(hal::Register& accessed, std::uint32_t value);
  void show(std::size_t fifo);

  std::deque<SimulatedFrame> fifos_[2];
  bool recovering_ = false;
};

}  // namespace hoof::tests
