#include "tools/emulator/system_control.h"

namespace hoof::tools::emulator {
namespace {

enum Offset {
  kCpuId = 0x00,
  kInterruptState = 0x04,
  kVectorTable = 0x08,
  kResetControl = 0x0C,
  kSleep = 0x10,
  kConfiguration = 0x14,
  kPriority4 = 0x18,
  kPriority8 = 0x1C,
  kPriority12 = 0x20,
  kHandlers = 0x24,
  kCfsr = 0x28,
  kHfsr = 0x2C,
  kMmfar = 0x34,
  kBfar = 0x38,
  kCoprocessors = 0x88,
  kMpuType = 0x90,
  kMpuControl = 0x94,
  kMpuNumber = 0x98,
  kMpuBase = 0x9C,
  kMpuAttributes = 0xA0,
};

constexpr std::uint32_t kCortexM4 = 0x410F'C241;
constexpr std::uint32_t kKey = 0x05FA'0000;
constexpr std::uint32_t kSystemReset = 1u << 2;
constexpr std::uint32_t kFaultEnables = 7u << 16;
constexpr std::uint32_t kForced = 1u << 30;
constexpr std::uint32_t kAlignStack = 1u << 9;  // CCR.STKALIGN, set after reset

}  // namespace

void SystemControl::reset() {
  vector_table_ = 0;
  reset_requested_ = false;
  prigroup_ = sleep_ = 0;
  configuration_ = kAlignStack;
  cfsr_ = hfsr_ = 0;
  coprocessors_ = 0;
  mpu_control_ = mpu_number_ = 0;
  regions_ = {};
}

std::uint32_t SystemControl::interrupt_state() const {
  return std::uint32_t(nvic_.active()) | std::uint32_t(nvic_.highest_pending()) << 12 |
         (nvic_.thread_next() ? 1u << 11 : 0) |
         (nvic_.pending(exception::kSysTick) ? 1u << 26 : 0) |
         (nvic_.pending(exception::kPendSv) ? 1u << 28 : 0) |
         (nvic_.pending(exception::kNmi) ? 1u << 31 : 0);
}

void SystemControl::write_interrupt_state(std::uint32_t value) {
  if ((value & 1u << 25) != 0) nvic_.unpend(exception::kSysTick);
  if ((value & 1u << 26) != 0) nvic_.pend(exception::kSysTick);
  if ((value & 1u << 27) != 0) nvic_.unpend(exception::kPendSv);
  if ((value & 1u << 28) != 0) nvic_.pend(exception::kPendSv);
  if ((value & 1u << 31) != 0) nvic_.pend(exception::kNmi);
}

void SystemControl::write_reset_control(std::uint32_t value) {
  if ((value & 0xFFFF'0000) != kKey) return;  // as the part: without the key nothing happens
  prigroup_ = value >> 8 & 7;
  nvic_.set_group_bits(prigroup_);
  if ((value & kSystemReset) != 0) reset_requested_ = true;
}

std::uint32_t SystemControl::read_priorities(std::uint32_t first) const {
  std::uint32_t value = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    value |= std::uint32_t(nvic_.priority(int(first + i)) & 0xFF) << (8 * i);
  }
  return value;
}

std::uint32_t SystemControl::read(std::uint32_t offset) {
  switch (offset) {
    case kCpuId:
      return kCortexM4;
    case kInterruptState:
      return interrupt_state();
    case kVectorTable:
      return vector_table_;
    case kResetControl:
      return 0xFA05'0000 | prigroup_ << 8;
    case kSleep:
      return sleep_;
    case kConfiguration:
      return configuration_;
    case kPriority4:
      return read_priorities(4);
    case kPriority8:
      return read_priorities(8);
    case kPriority12:
      return read_priorities(12);
    case kHandlers:
      return (nvic_.enabled(exception::kMemoryFault) ? 1u << 16 : 0) |
             (nvic_.enabled(exception::kBusFault) ? 1u << 17 : 0) |
             (nvic_.enabled(exception::kUsageFault) ? 1u << 18 : 0);
    case kCfsr:
      return cfsr_;
    case kHfsr:
      return hfsr_;
    case kMmfar:
      return mmfar_;
    case kBfar:
      return bfar_;
    case kCoprocessors:
      return coprocessors_;
    case kMpuType:
      return 8u << 8;
    case kMpuControl:
      return mpu_control_;
    case kMpuNumber:
      return mpu_number_;
    case kMpuBase:
      return regions_[mpu_number_].base | mpu_number_;
    case kMpuAttributes:
      return regions_[mpu_number_].attributes;
    default:
      no_such_register(offset);
  }
}

void SystemControl::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case kInterruptState:
      return write_interrupt_state(value);
    case kVectorTable:
      vector_table_ = value & 0x3FFF'FF80;
      return;
    case kResetControl:
      return write_reset_control(value);
    case kSleep:
      if ((value & 6) != 0) throw EmulatorError("SCB: deep sleep and sleep on exit have no model");
      sleep_ = value;
      return;
    case kConfiguration:
      configuration_ = value;
      return;
    case kPriority4:
    case kPriority8:
    case kPriority12:
      for (std::uint32_t i = 0; i < 4; ++i) {
        nvic_.set_priority(int(offset - kPriority4 + 4 + i), std::uint8_t(value >> (8 * i)));
      }
      return;
    case kHandlers:
      if ((value & ~kFaultEnables) != 0) throw EmulatorError("SCB: SHCSR written beyond enables");
      nvic_.enable(exception::kMemoryFault, (value & 1u << 16) != 0);
      nvic_.enable(exception::kBusFault, (value & 1u << 17) != 0);
      nvic_.enable(exception::kUsageFault, (value & 1u << 18) != 0);
      return;
    case kCfsr:
      cfsr_ &= ~value;
      return;
    case kHfsr:
      hfsr_ &= ~value;
      return;
    case kCoprocessors:
      coprocessors_ = value;
      return;
    case kMpuControl:
      mpu_control_ = value & 7;
      return;
    case kMpuNumber:
      mpu_number_ = value & 7;
      return;
    case kMpuBase:
      if ((value & 0x10) != 0) mpu_number_ = value & 7;
      regions_[mpu_number_].base = value & ~0x1Fu;
      return;
    case kMpuAttributes:
      regions_[mpu_number_].attributes = value;
      return;
    default:
      no_such_register(offset);
  }
}

int SystemControl::raise(std::uint32_t status, std::uint32_t address, const Masks& masks) {
  cfsr_ |= status;
  int exception = exception::kUsageFault;
  if ((status & 0xFF) != 0) exception = exception::kMemoryFault;
  if ((status & 0xFF00) != 0) exception = exception::kBusFault;
  if ((status & fault_status::kMemoryAddress) != 0) mmfar_ = address;
  if ((status & fault_status::kBusAddress) != 0) bfar_ = address;
  // A fault that may not run where it happened becomes a hard fault (B1.5.14).
  const bool possible =
      nvic_.enabled(exception) && nvic_.priority(exception) < nvic_.running_priority(masks);
  if (possible) return exception;
  hfsr_ |= kForced;
  return exception::kHardFault;
}

bool SystemControl::forbidden(std::uint32_t address) const {
  if ((mpu_control_ & 1) == 0) return false;
  for (std::size_t i = regions_.size(); i-- > 0;) {  // the highest number wins
    const Region& r = regions_[i];
    if ((r.attributes & 1) == 0) continue;
    const std::uint32_t bits = (r.attributes >> 1 & 0x1F) + 1;
    const std::uint64_t size = std::uint64_t{1} << bits;
    if (address < r.base || address - r.base >= size) continue;
    if ((r.attributes >> 8 & 0xFF) != 0) throw EmulatorError("MPU: subregions have no model");
    return (r.attributes >> 24 & 7) == 0;
  }
  return (mpu_control_ & 4) == 0;  // PRIVDEFENA
}

}  // namespace hoof::tools::emulator
