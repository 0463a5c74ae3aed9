// The registers of a bxCAN controller, as the image reads and writes them.
#include <algorithm>

#include "tools/emulator/bxcan.h"

namespace hoof::tools::emulator {
namespace {

enum Offset {
  kMaster = 0x00,
  kMasterStatus = 0x04,
  kTransmitStatus = 0x08,
  kFifo0 = 0x0C,
  kFifo1 = 0x10,
  kInterrupts = 0x14,
  kErrors = 0x18,
  kTiming = 0x1C,
  kMailbox = 0x180,
  kFifoOutput = 0x1B0,
  kFilters = 0x200
};

// MCR
constexpr std::uint32_t kInitialise = 1u << 0, kSleep = 1u << 1, kKnownControl = 0x0001'00FF;
// MSR
constexpr std::uint32_t kErrorFlag = 1u << 2;
// TSR, of mailbox 0
constexpr std::uint32_t kCompleted = 1u << 0, kResult = 0xF, kAbort = 1u << 7;
// RFxR
constexpr std::uint32_t kFull = 1u << 3, kOverrun = 1u << 4, kRelease = 1u << 5;
// TIxR
constexpr std::uint32_t kRequest = 1u << 0;
// IER: all that have a model
constexpr std::uint32_t kKnownInterrupts = 0x8F7F;

constexpr Cycles kElevenBits = 11 * kCyclesPerMicrosecond;

}  // namespace

std::uint32_t BxCan::master_status() const {
  constexpr std::uint32_t kLevelsOfPins = 0xC00;  // RX, SAMP: recessive
  return (initialising_ ? 1u : 0) | (sleeping_ ? 2u : 0) | (error_flag_ ? kErrorFlag : 0) |
         kLevelsOfPins;
}

std::uint32_t BxCan::transmit_status() const {
  std::uint32_t value = 0;
  int pending = 0;
  for (std::size_t i = 0; i < kMailboxes; ++i) {
    value |= mailboxes_[i].result << (8 * i);
    if (mailboxes_[i].pending) ++pending;
    if (!mailboxes_[i].pending) value |= 1u << (26 + i);  // TME
  }
  // CODE: the next empty mailbox, or the one of lowest priority. LOW: that one, of several.
  std::size_t lowest = 0;
  for (std::size_t i = 1; i < kMailboxes; ++i) {
    if (mailboxes_[i].identifier >= mailboxes_[lowest].identifier) lowest = i;
  }
  std::size_t code = lowest;
  for (std::size_t i = kMailboxes; i-- > 0;) {
    if (!mailboxes_[i].pending) code = i;
  }
  if (pending == int(kMailboxes)) value |= 1u << (29 + lowest);
  return value | std::uint32_t(code) << 24;
}

std::uint32_t BxCan::fifo_status(std::size_t i) const {
  const Fifo& f = fifos_[i];
  return std::uint32_t(f.frames.size()) | (f.frames.size() == kFifoDepth ? kFull : 0) |
         (f.overrun ? kOverrun : 0);
}

std::uint32_t BxCan::error_status() const {
  const hal::BusStatus s = wire_->status();
  const bool off = s.bus_off || recovering_;
  const bool warning = s.transmit_error_count >= 96 || s.receive_error_count >= 96;
  return (warning ? 1u : 0) | (s.error_passive ? 2u : 0) | (off ? 4u : 0) | last_error_ << 4 |
         std::uint32_t{s.transmit_error_count} << 16 | std::uint32_t{s.receive_error_count} << 24;
}

std::uint32_t BxCan::read_mailbox(std::uint32_t offset) const {
  const auto pick = [offset](const auto& m) {
    switch (offset % 16 / 4) {
      case 0:
        return m.identifier;
      case 1:
        return m.length;
      case 2:
        return m.low;
      default:
        return m.high;
    }
  };
  if (offset < kFifoOutput) return pick(mailboxes_[(offset - kMailbox) / 16]);
  const Fifo& f = fifos_[(offset - kFifoOutput) / 16];
  return f.frames.empty() ? 0 : pick(f.frames.front());  // the part shows what was there before
}

std::uint32_t BxCan::read(std::uint32_t offset) {
  leave_initialisation_if_due();
  switch (offset) {
    case kMaster:
      return control_;
    case kMasterStatus:
      return master_status();
    case kTransmitStatus:
      return transmit_status();
    case kFifo0:
      return fifo_status(0);
    case kFifo1:
      return fifo_status(1);
    case kInterrupts:
      return interrupts_;
    case kErrors:
      return error_status();
    case kTiming:
      return timing_;
    default:
      break;
  }
  if (offset >= kMailbox && offset < kFifoOutput + 32) return read_mailbox(offset);
  std::uint32_t value = 0;
  if (number_ != 1 || !filters_.read(offset, value)) no_such_register(offset);
  return value;
}

void BxCan::write_master(std::uint32_t value) {
  if ((value & ~kKnownControl) != 0)
    throw EmulatorError("bxCAN: MCR " + hex(value) + " has no model");
  const bool joins = (control_ & kInitialise) != 0 && (value & kInitialise) == 0;
  control_ = value;
  sleeping_ = (value & kSleep) != 0 && (value & kInitialise) == 0;
  if ((value & kInitialise) != 0) {
    initialising_ = true;
    recovering_ = false;
  } else if (joins) {
    joins_ = time_.now + kElevenBits;
  }
}

void BxCan::write_transmit_status(std::uint32_t value) {
  for (std::size_t i = 0; i < kMailboxes; ++i) {
    Transmit& m = mailboxes_[i];
    const std::uint32_t bits = value >> (8 * i);
    if ((bits & kCompleted) != 0) m.result = 0;
    m.result &= ~(bits & kResult);
    if ((bits & kAbort) == 0 || !m.pending) continue;
    // What is on the wire ends there, and its mailbox is full until then.
    if (m.offered && !wire_->withdraw(frame_in(m))) continue;
    m.pending = m.offered = false;
    m.identifier &= ~kRequest;
    m.result = kCompleted;
  }
}

void BxCan::write_fifo_status(std::size_t i, std::uint32_t value) {
  Fifo& f = fifos_[i];
  if ((value & kRelease) != 0 && !f.frames.empty()) f.frames.erase(f.frames.begin());
  if ((value & kOverrun) != 0) f.overrun = false;
}

void BxCan::write_mailbox(std::uint32_t offset, std::uint32_t value) {
  if (offset >= kFifoOutput) throw EmulatorError("bxCAN: the output of a FIFO is written");
  Transmit& m = mailboxes_[(offset - kMailbox) / 16];
  if (m.pending) throw EmulatorError("bxCAN: a mailbox is written before its frame has left");
  switch (offset % 16 / 4) {
    case 0:
      m.identifier = value;
      break;
    case 1:
      m.length = value;
      break;
    case 2:
      m.low = value;
      break;
    default:
      m.high = value;
      break;
  }
  if (offset % 16 != 0 || (value & kRequest) == 0) return;
  m.pending = true;
  m.result = 0;
  offer_pending();
}

void BxCan::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case kMaster:
      write_master(value);
      break;
    case kMasterStatus:
      if ((value & kErrorFlag) != 0) error_flag_ = false;
      break;
    case kTransmitStatus:
      write_transmit_status(value);
      break;
    case kFifo0:
      write_fifo_status(0, value);
      break;
    case kFifo1:
      write_fifo_status(1, value);
      break;
    case kInterrupts:
      if ((value & ~kKnownInterrupts) != 0) throw EmulatorError("bxCAN: IER " + hex(value));
      interrupts_ = value;
      break;
    case kErrors:
      last_error_ = value >> 4 & 7;
      break;
    case kTiming:
      if (!initialising_) throw EmulatorError("bxCAN: BTR written outside initialisation");
      timing_ = value;
      break;
    default:
      if (offset >= kMailbox && offset < kFifoOutput + 32) {
        write_mailbox(offset, value);
      } else if (number_ != 1 || !filters_.write(offset, value)) {
        no_such_register(offset);
      }
  }
  update_lines();
}

}  // namespace hoof::tools::emulator
