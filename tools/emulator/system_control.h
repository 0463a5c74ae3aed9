// The core's system control block and its memory protection unit.
//
// Source: ARM DDI 0403E, B3.2 and B3.5.
#pragma once

#include <array>
#include <cstdint>

#include "tools/emulator/nvic.h"
#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

/// Why a fault was raised: bits of CFSR.
namespace fault_status {
inline constexpr std::uint32_t kInstructionAccess = 1u << 0;
inline constexpr std::uint32_t kDataAccess = 1u << 1;
inline constexpr std::uint32_t kMemoryStacking = 1u << 4;
inline constexpr std::uint32_t kMemoryAddress = 1u << 7;
inline constexpr std::uint32_t kInstructionBus = 1u << 8;
inline constexpr std::uint32_t kPreciseData = 1u << 9;
inline constexpr std::uint32_t kBusStacking = 1u << 12;
inline constexpr std::uint32_t kBusAddress = 1u << 15;
inline constexpr std::uint32_t kUndefined = 1u << 16;
inline constexpr std::uint32_t kInvalidReturn = 1u << 18;
}  // namespace fault_status

class SystemControl final : public Peripheral {
 public:
  explicit SystemControl(Nvic& nvic) : nvic_(nvic) {}

  // Registers from 0xE000ED00 on, the MPU's from 0xE000ED90 on included.
  const char* name() const override { return "SCB"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  std::uint32_t vector_table() const { return vector_table_; }
  /// AIRCR.SYSRESETREQ was written.
  bool reset_requested() const { return reset_requested_; }

  /// Notes a fault. @return the exception that it raises: its own, or hard fault
  int raise(std::uint32_t status, std::uint32_t address, const Masks& masks);

  /// Whether the MPU forbids the address (to privileged code too).
  bool forbidden(std::uint32_t address) const;

 private:
  struct Region {
    std::uint32_t base = 0;
    std::uint32_t attributes = 0;
  };

  std::uint32_t interrupt_state() const;
  void write_interrupt_state(std::uint32_t value);
  void write_reset_control(std::uint32_t value);
  std::uint32_t read_priorities(std::uint32_t first) const;

  Nvic& nvic_;
  std::uint32_t vector_table_ = 0;
  bool reset_requested_ = false;
  std::uint32_t prigroup_ = 0;
  std::uint32_t sleep_ = 0;
  std::uint32_t configuration_ = 0;
  std::uint32_t cfsr_ = 0;
  std::uint32_t hfsr_ = 0;
  std::uint32_t mmfar_ = 0;
  std::uint32_t bfar_ = 0;
  std::uint32_t coprocessors_ = 0;
  std::uint32_t mpu_control_ = 0;
  std::uint32_t mpu_number_ = 0;
  std::array<Region, 8> regions_{};
};

}  // namespace hoof::tools::emulator
