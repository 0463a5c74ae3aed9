// Registers of the bxCAN peripheral (STM32F1, F2, F4).
//
// Sources: RM0090 rev. 19, 32.9; checked against the device header of ST's cmsis_device_f4
// (stm32f405xx.h, CAN_TypeDef and the bits CAN_*) and against the SVD figures for base, interrupts
// and offsets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/register.h"

namespace hoof::hal::bxcan {

inline constexpr std::size_t kMailboxes = 3;
inline constexpr std::size_t kFifos = 2;
inline constexpr std::uint32_t kFifoDepth = 3;
inline constexpr std::size_t kFilterBanks = 28;

/// A transmit mailbox, or the output of a receive FIFO.
struct Mailbox {
  Register identifier;  // TIxR, RIxR
  Register length;      // TDTxR, RDTxR
  Register low;         // bytes 0 to 3, byte 0 lowest
  Register high;        // bytes 4 to 7
};

struct FilterBank {
  Register first;
  Register second;
};

struct Registers {
  Register MCR;
  Register MSR;
  Register TSR;
  std::array<Register, kFifos> RFR;
  Register IER;
  Register ESR;
  Register BTR;
  std::array<Register, 88> reserved_020;
  std::array<Mailbox, kMailboxes> transmit;
  std::array<Mailbox, kFifos> receive;
  std::array<Register, 12> reserved_1D0;
  // From here on only in CAN1, for both controllers.
  Register FMR;
  Register FM1R;
  Register reserved_208;
  Register FS1R;
  Register reserved_210;
  Register FFA1R;
  Register reserved_218;
  Register FA1R;
  std::array<Register, 8> reserved_220;
  std::array<FilterBank, kFilterBanks> filter;
};

static_assert(offsetof(Registers, RFR) == 0x00C && offsetof(Registers, BTR) == 0x01C);
static_assert(offsetof(Registers, transmit) == 0x180 && offsetof(Registers, receive) == 0x1B0);
static_assert(offsetof(Registers, FMR) == 0x200 && offsetof(Registers, FS1R) == 0x20C);
static_assert(offsetof(Registers, FFA1R) == 0x214 && offsetof(Registers, FA1R) == 0x21C);
static_assert(offsetof(Registers, filter) == 0x240 && sizeof(Registers) == 0x320);

namespace mcr {
inline constexpr std::uint32_t kInitialisationRequest = 1u << 0;  // INRQ
inline constexpr std::uint32_t kDebugFreeze = 1u << 16;           // DBF
}  // namespace mcr

namespace msr {
inline constexpr std::uint32_t kInitialisation = 1u << 0;  // INAK
inline constexpr std::uint32_t kErrorInterrupt = 1u << 2;  // ERRI, cleared by writing 1
}  // namespace msr

namespace tsr {
constexpr std::uint32_t request_completed(std::size_t mailbox) {
  return 1u << (8 * mailbox);
}
constexpr std::uint32_t transmission_ok(std::size_t mailbox) {
  return 2u << (8 * mailbox);
}
constexpr std::uint32_t abort(std::size_t mailbox) {
  return 0x80u << (8 * mailbox);
}
constexpr std::uint32_t empty(std::size_t mailbox) {
  return 1u << (26 + mailbox);
}
inline constexpr std::uint32_t kAbortAll = abort(0) | abort(1) | abort(2);
inline constexpr std::uint32_t kAllEmpty = empty(0) | empty(1) | empty(2);
inline constexpr std::uint32_t kAllCompleted =
    request_completed(0) | request_completed(1) | request_completed(2);
constexpr std::uint32_t transmissions_ok(std::uint32_t status) {
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < kMailboxes; ++i)
    count += (status & transmission_ok(i)) != 0 ? 1u : 0u;
  return count;
}
}  // namespace tsr

namespace rfr {
inline constexpr std::uint32_t kPending = 0x3;      // FMP, number of frames
inline constexpr std::uint32_t kOverrun = 1u << 4;  // FOVR, cleared by writing 1
inline constexpr std::uint32_t kRelease = 1u << 5;  // RFOM
}  // namespace rfr

namespace ier {
inline constexpr std::uint32_t kMailboxEmpty = 1u << 0;    // TMEIE
inline constexpr std::uint32_t kFifo0Pending = 1u << 1;    // FMPIE0
inline constexpr std::uint32_t kFifo1Pending = 1u << 4;    // FMPIE1
inline constexpr std::uint32_t kBusOff = 1u << 10;         // BOFIE
inline constexpr std::uint32_t kLastErrorCode = 1u << 11;  // LECIE
inline constexpr std::uint32_t kErrors = 1u << 15;         // ERRIE
}  // namespace ier

namespace esr {
inline constexpr std::uint32_t kErrorPassive = 1u << 1;   // EPVF
inline constexpr std::uint32_t kBusOff = 1u << 2;         // BOFF
inline constexpr std::uint32_t kLastErrorCode = 7u << 4;  // LEC; 7 is written by software: none yet
inline constexpr std::uint32_t kNoErrorYet = 7u << 4;
constexpr std::uint8_t transmit_errors(std::uint32_t esr) {
  return static_cast<std::uint8_t>(esr >> 16);
}
constexpr std::uint8_t receive_errors(std::uint32_t esr) {
  return static_cast<std::uint8_t>(esr >> 24);
}
}  // namespace esr

namespace identifier {
inline constexpr std::uint32_t kTransmit = 1u << 0;  // TXRQ
inline constexpr std::uint32_t kRemote = 1u << 1;    // RTR
inline constexpr std::uint32_t kExtended = 1u << 2;  // IDE
inline constexpr unsigned kStandardShift = 21;
inline constexpr unsigned kExtendedShift = 3;
}  // namespace identifier

namespace fmr {
inline constexpr std::uint32_t kInitialisation = 1u << 0;  // FINIT
inline constexpr unsigned kFirstBankOfCan2Shift = 8;       // CAN2SB, 6 bits
inline constexpr std::uint32_t kFirstBankOfCan2Mask = 0x3Fu << kFirstBankOfCan2Shift;
}  // namespace fmr

}  // namespace hoof::hal::bxcan
