#include "tools/emulator/emulated_firmware.h"

#include <stdexcept>

#include "firmware/app/storage.h"
#include "firmware/protocol/dictionary.h"

namespace hoof::tools::emulator {
namespace {

constexpr Cycles kHeartbeatPeriod =
    firmware::protocol::spec(firmware::protocol::Message::kHeartbeat).cycle_ms *
    kCyclesPerMillisecond;

/// Its counter has four bits: this many later it is what it was in the first.
constexpr int kHeartbeatCounts = 16;

}  // namespace

hal::RamFlash flash_with(const firmware::app::Parameters& parameters) {
  hal::RamFlash flash = blank_flash();
  firmware::app::Storage storage(flash);
  firmware::app::Parameters ignored;
  storage.load(ignored);  // readies the fault log, too
  if (storage.store(parameters, firmware::control::Mode::kOff) != firmware::app::StoreResult::kOk) {
    throw std::invalid_argument("the parameters cannot be stored: a value is out of its range");
  }
  return flash;
}

Cycles run_to_start(Board& board) {
  board.power_on();
  // The second heartbeat comes with the first tick a period after the first, the others a period
  // on.
  const Cycles second = board.now() + kHeartbeatPeriod;
  while (board.next_tick() < second) board.advance_to(board.next_tick());
  const Cycles start = board.next_tick() + (kHeartbeatCounts - 1) * kHeartbeatPeriod;
  while (board.next_tick() < start) board.advance_to(board.next_tick());
  return start;
}

EmulatedFirmware::EmulatedFirmware(const ElfFile& image, hal::RamFlash flash, Buses buses,
                                   Buses listeners, const hal::Clock& clock)
    : flash_(std::move(flash)), board_(image, flash_), listeners_(listeners), clock_(clock) {
  start_ = run_to_start(board_);
  for (std::size_t bus = 0; bus < Board::kBuses; ++bus) {
    board_.connect(bus, wire_of(*buses[bus]));
  }
}

void EmulatedFirmware::act_on_board() {
  if (asked_.pressed != acted_.pressed) board_.press_emergency_stop(asked_.pressed);
  if (asked_.low != acted_.low) board_.set_supply_low(asked_.low);
  if (asked_.volts != acted_.volts) {
    BoardVoltages voltages = board_.voltages();
    voltages.supply_V = double(asked_.volts);
    board_.set_voltages(voltages);
  }
  acted_ = asked_;
}

bool EmulatedFirmware::restart(hal::ResetCause cause) {
  board_.advance_to(start_ + cycles_of_ns(clock_.now_ns()));  // now, and not when it ran last
  cause == hal::ResetCause::kPowerOn ? board_.power_on() : board_.reset(cause);
  return true;
}

void EmulatedFirmware::poll(std::uint32_t) {
  const std::int64_t now_ns = clock_.now_ns();
  hal::CanFrame frame;
  for (hal::CanBus* listener : listeners_) {
    while (listener->receive(frame)) told_.take(frame, now_ns);
  }
  act_on_board();
  board_.advance_to(start_ + cycles_of_ns(now_ns));
}

bridge::FirmwareMaker emulated_firmware(const std::string& image,
                                        const firmware::app::Parameters& parameters,
                                        bridge::Wires& wires) {
  return [elf = read_elf_file(image), parameters, &wires](hal::CanBus& bus0, hal::CanBus& bus1,
                                                          const hal::Clock& clock) {
    return std::make_unique<EmulatedFirmware>(
        elf, flash_with(parameters), EmulatedFirmware::Buses{&bus0, &bus1},
        EmulatedFirmware::Buses{&wires.attach(0, "recorder"), &wires.attach(1, "recorder")}, clock);
  };
}

}  // namespace hoof::tools::emulator
