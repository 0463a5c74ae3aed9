// The board's image with a supply that can fail, and one tool on its bus.
#pragma once

#include <optional>

#include "firmware/protocol/codec.h"
#include "hal/in_process/in_process_bus.h"
#include "hal/stepped_clock.h"
#include "hil_bridge/service_client.h"
#include "tools/emulator/board.h"
#include "tools/emulator/can_wire.h"

namespace hoof::test {

/// The board on a wire with one tool; its flash outlives it, as real flash does a supply.
class PoweredBoard {
 public:
  explicit PoweredBoard(hal::RamFlash& flash)
      : board_(image(), flash),
        client_(
            desk_, clock_, [this] { pass(); }, 2, kPatience_ns) {
    board_.connect(0, tools::emulator::wire_of(bus0_.attach("foot")));
    board_.connect(1, tools::emulator::wire_of(bus1_.attach("foot")));
    board_.power_on();
    start_ = board_.now();
  }

  static const tools::emulator::ElfFile& image() {
    static const tools::emulator::ElfFile elf = tools::emulator::read_elf_file(HOOF_BOARD_IMAGE);
    return elf;
  }

  bridge::ServiceClient& client() { return client_; }
  tools::emulator::Board& board() { return board_; }

  void run_ms(int ms) {
    for (int i = 0; i < 2 * ms; ++i) pass();
  }

  std::optional<firmware::protocol::Heartbeat> heartbeat() {
    hal::CanFrame frame;
    while (listener_.receive(frame)) {
      firmware::protocol::Heartbeat h;
      if (decode(frame, h) == firmware::protocol::DecodeResult::kOk) heartbeat_ = h;
    }
    return heartbeat_;
  }

 private:
  static constexpr std::int64_t kStep_ns = 500'000;
  static constexpr std::int64_t kPatience_ns = 4'000'000'000;  // an erase takes up to 1 s here

  void pass() {
    clock_.advance_to(clock_.now_ns() + kStep_ns);
    bus0_.advance_to(clock_.now_ns());
    bus1_.advance_to(clock_.now_ns());
    board_.advance_to(start_ + tools::emulator::cycles_of_ns(clock_.now_ns()));
  }

  hal::SteppedClock clock_;
  hal::InProcessBus bus0_{{.name = "can0", .bit_rates = {}}};
  hal::InProcessBus bus1_{{.name = "can1", .bit_rates = {}}};
  hal::CanBus& desk_ = bus0_.attach("desk");
  hal::CanBus& listener_ = bus0_.attach("listener");
  tools::emulator::Board board_;
  bridge::ServiceClient client_;
  tools::emulator::Cycles start_ = 0;
  std::optional<firmware::protocol::Heartbeat> heartbeat_;
};

}  // namespace hoof::test
