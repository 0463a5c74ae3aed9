#include "tests/hal/bxcan/simulated_bxcan.h"

namespace hoof::tests {
namespace {

constexpr std::uint32_t kTransmitRequest = 1;
constexpr std::uint32_t kAllEmpty = 0x1C00'0000;
constexpr std::uint32_t kBusOff = 4;

}  // namespace

SimulatedBxCan::SimulatedBxCan() {
  registers.MCR.store(0x0001'0002);  // asleep
  registers.MSR.store(0x0000'0C02);
  registers.TSR.store(kAllEmpty);
  hal::Register::watcher = this;
}

SimulatedBxCan::~SimulatedBxCan() {
  hal::Register::watcher = nullptr;
}

std::uint32_t SimulatedBxCan::on_read(hal::Register& accessed) {
  ++reads;
  return present ? accessed.stored() : 0;
}

void SimulatedBxCan::on_write(hal::Register& accessed, std::uint32_t value) {
  if (!present) return;
  if (&accessed == &registers.MCR) {
    accessed.store(value);
    if ((value & 1) != 0) {
      registers.MSR.store((registers.MSR.stored() | 1) & ~2u);
    } else if (hears_idle_bus) {
      if (initialising() && (registers.ESR.stored() & kBusOff) != 0) recovering_ = true;
      registers.MSR.store(registers.MSR.stored() & ~3u);
    }
  } else if (&accessed == &registers.BTR) {
    if (!initialising()) faults.push_back("bit timing written outside initialisation");
    accessed.store(value);
  } else if (&accessed == &registers.ESR) {
    accessed.store((accessed.stored() & ~0x70u) | (value & 0x70u));
  } else if (&accessed == &registers.MSR) {
    accessed.store(accessed.stored() & ~(value & 0x1C));
  } else if (&accessed == &registers.TSR) {
    write_status(value);
  } else if (!write_fifo(accessed, value) && !write_mailbox(accessed, value)) {
    accessed.store(value);
  }
}

void SimulatedBxCan::write_status(std::uint32_t value) {
  std::uint32_t status = registers.TSR.stored();
  for (unsigned i = 0; i < 3; ++i) {
    if ((value >> (8 * i) & 1) != 0) status &= ~(0xFu << (8 * i));
    const bool pending = (status >> (26 + i) & 1) == 0;
    if ((value >> (8 * i + 7) & 1) != 0 && pending) {
      status |= 1u << (26 + i) | 1u << (8 * i);  // empty, completed, not transmitted
      registers.transmit[i].identifier.store(registers.transmit[i].identifier.stored() &
                                             ~kTransmitRequest);
    }
  }
  registers.TSR.store(status);
}

bool SimulatedBxCan::write_mailbox(hal::Register& accessed, std::uint32_t value) {
  for (unsigned i = 0; i < 3; ++i) {
    hal::bxcan::Mailbox& mailbox = registers.transmit[i];
    const bool mine = &accessed >= &mailbox.identifier && &accessed <= &mailbox.high;
    if (!mine) continue;
    const std::uint32_t status = registers.TSR.stored();
    if ((status >> (26 + i) & 1) == 0) {
      faults.push_back("mailbox written that is not empty");
      return true;
    }
    accessed.store(value);
    if (&accessed == &mailbox.identifier && (value & kTransmitRequest) != 0) {
      registers.TSR.store(status & ~(1u << (26 + i) | 0xFu << (8 * i)));
    }
    return true;
  }
  return false;
}

bool SimulatedBxCan::write_fifo(hal::Register& accessed, std::uint32_t value) {
  for (std::size_t fifo = 0; fifo < 2; ++fifo) {
    if (&accessed != &registers.RFR[fifo]) continue;
    std::uint32_t status = accessed.stored() & ~(value & 0x18);  // FULL and FOVR, by writing 1
    accessed.store(status);
    if ((value & 0x20) != 0) {
      if (fifos_[fifo].empty()) {
        faults.push_back("empty FIFO released");
      } else {
        fifos_[fifo].pop_front();
      }
      show(fifo);
    }
    return true;
  }
  return false;
}

void SimulatedBxCan::show(std::size_t fifo) {
  hal::Register& status = registers.RFR[fifo];
  status.store((status.stored() & ~3u) | static_cast<std::uint32_t>(fifos_[fifo].size()));
  const SimulatedFrame frame = fifos_[fifo].empty() ? SimulatedFrame{} : fifos_[fifo].front();
  registers.receive[fifo].identifier.store(frame.identifier);
  registers.receive[fifo].length.store(frame.length);
  registers.receive[fifo].low.store(frame.low);
  registers.receive[fifo].high.store(frame.high);
}

std::optional<SimulatedFrame> SimulatedBxCan::transmit() {
  std::optional<unsigned> first;
  for (unsigned i = 0; i < 3; ++i) {
    if ((registers.TSR.stored() >> (26 + i) & 1) != 0) continue;
    const auto key = [this](unsigned n) { return registers.transmit[n].identifier.stored(); };
    if (!first || key(i) < key(*first)) first = i;
  }
  if (!first) return std::nullopt;
  hal::bxcan::Mailbox& mailbox = registers.transmit[*first];
  const SimulatedFrame frame{mailbox.identifier.stored() & ~kTransmitRequest,
                             mailbox.length.stored(), mailbox.low.stored(), mailbox.high.stored()};
  mailbox.identifier.store(frame.identifier);
  registers.TSR.store(registers.TSR.stored() | 1u << (26 + *first) | 3u << (8 * *first));
  return frame;
}

bool SimulatedBxCan::receive(std::size_t fifo, const SimulatedFrame& frame) {
  const bool lost = fifos_[fifo].size() == 3;
  if (lost) {
    fifos_[fifo].back() = frame;  // RFLM = 0
    registers.RFR[fifo].store(registers.RFR[fifo].stored() | 0x10);
  } else {
    fifos_[fifo].push_back(frame);
  }
  show(fifo);
  return !lost;
}

std::optional<std::size_t> SimulatedBxCan::filtered(std::size_t controller,
                                                    std::uint32_t identifier) const {
  const std::uint32_t split = registers.FMR.stored() >> 8 & 0x3F;
  if ((registers.FMR.stored() & 1) != 0) return std::nullopt;
  for (std::uint32_t bank = 0; bank < 28; ++bank) {
    const auto on = [bank](const hal::Register& r) { return (r.stored() >> bank & 1) != 0; };
    if (!on(registers.FA1R) || (bank >= split) != (controller == 1)) continue;
    if (!on(registers.FS1R) || on(registers.FM1R)) continue;  // not a form that is simulated
    const std::uint32_t mask = registers.filter[bank].second.stored();
    if (((identifier ^ registers.filter[bank].first.stored()) & mask) != 0) continue;
    return on(registers.FFA1R) ? 1 : 0;
  }
  return std::nullopt;
}

void SimulatedBxCan::error(std::uint32_t last_error_code, std::uint8_t transmit_errors,
                           std::uint8_t receive_errors) {
  const std::uint32_t passive = transmit_errors > 127 || receive_errors > 127 ? 2 : 0;
  registers.ESR.store((registers.ESR.stored() & kBusOff) | passive | last_error_code << 4 |
                      std::uint32_t{transmit_errors} << 16 | std::uint32_t{receive_errors} << 24);
  registers.MSR.store(registers.MSR.stored() | 4);
}

void SimulatedBxCan::go_bus_off() {
  registers.ESR.store(registers.ESR.stored() | kBusOff);
  registers.MSR.store(registers.MSR.stored() | 4);
  recovering_ = false;
}

void SimulatedBxCan::hear_recovery() {
  if (recovering_) registers.ESR.store(registers.ESR.stored() & ~(kBusOff | 0xFFFF'0002));
}

}  // namespace hoof::tests
