// One bxCAN controller on a wire: three mailboxes, two FIFOs of three, error state, interrupts.
//
// Source: RM0090 rev. 19, 32.4, 32.7 and 32.9.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/emulator/can_filters.h"
#include "tools/emulator/can_wire.h"
#include "tools/emulator/nvic.h"
#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class BxCan final : public Peripheral {
 public:
  static constexpr std::size_t kMailboxes = 3;
  static constexpr std::size_t kFifoDepth = 3;

  /// @param number 1 or 2: CAN1 has the registers of the filters
  /// @param first_interrupt of transmit, receive 0, receive 1, status
  /// @param clock_MHz of the peripheral's bus
  BxCan(int number, const BoardTime& time, Nvic& nvic, CanFilters& filters, int first_interrupt,
        std::function<std::uint32_t()> clock_MHz);

  const char* name() const override { return number_ == 1 ? "CAN1" : "CAN2"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  /// What the former wire has not taken is offered to this one.
  void connect(std::unique_ptr<CanWire> wire);

  /// Takes over what has happened on the wire since the last call. What does not fit into the FIFOs
  /// waits on the wire until they are emptied, or until `overrun`.
  /// @return whether frames wait for a place in a FIFO
  bool advance(bool overrun = false);

 private:
  struct Received {
    std::uint32_t identifier = 0, length = 0, low = 0, high = 0;
  };
  struct Transmit {
    std::uint32_t identifier = 0, length = 0, low = 0, high = 0;
    bool pending = false;
    bool offered = false;
    std::uint32_t result = 0;  // RQCP, TXOK, ALST, TERR
  };
  struct Fifo {
    std::vector<Received> frames;
    bool overrun = false;
  };

  static hal::CanFrame frame_in(const Transmit& mailbox);
  bool on_bus() const;
  void leave_initialisation_if_due();
  void offer_pending();
  void complete_sent();
  bool receive(bool overrun);
  void watch_errors();
  void put(const hal::CanFrame& frame, const CanFilters::Match& match);
  void update_lines();

  std::uint32_t master_status() const;
  std::uint32_t transmit_status() const;
  std::uint32_t fifo_status(std::size_t i) const;
  std::uint32_t error_status() const;
  std::uint32_t read_mailbox(std::uint32_t offset) const;
  void write_master(std::uint32_t value);
  void write_transmit_status(std::uint32_t value);
  void write_fifo_status(std::size_t i, std::uint32_t value);
  void write_mailbox(std::uint32_t offset, std::uint32_t value);
  void require_bit_rate() const;

  int number_;
  const BoardTime& time_;
  Nvic& nvic_;
  CanFilters& filters_;
  int first_interrupt_;
  std::function<std::uint32_t()> clock_MHz_;
  std::unique_ptr<CanWire> wire_ = silent_wire();

  std::uint32_t control_ = 0;
  std::uint32_t interrupts_ = 0;
  std::uint32_t timing_ = 0;
  std::uint32_t last_error_ = 0;  // LEC
  bool initialising_ = false;
  bool sleeping_ = true;
  bool error_flag_ = false;  // MSR.ERRI
  bool recovering_ = false;  // from bus-off, counting idle sequences
  Cycles joins_ = 0;         // when initialisation is left
  hal::BusStatus former_;
  std::array<Transmit, kMailboxes> mailboxes_;
  std::array<Fifo, 2> fifos_;
};

}  // namespace hoof::tools::emulator
