#include "tools/emulator/core.h"

#include <array>

namespace hoof::tools::emulator {
namespace {

constexpr std::uint32_t kThumb = 1u << 24;        // xPSR.T
constexpr std::uint32_t kFrameAligned = 1u << 9;  // of the pushed xPSR
constexpr std::uint32_t kFpActive = 1u << 2;      // CONTROL.FPCA
constexpr std::uint32_t kProcessStack = 1u << 1;  // CONTROL.SPSEL
constexpr std::uint32_t kBasicFrame = 0x20, kFpFrame = 0x68;

// EXC_RETURN (B1.5.8)
constexpr std::uint32_t kReturn = 0xFFFF'FFE1;
constexpr std::uint32_t kNoFp = 1u << 4, kToThread = 1u << 3, kToProcessStack = 1u << 2;

}  // namespace

Masks Core::masks() const {
  const Cpu::MaskRegisters m = cpu_.masks();
  return {(m.primask & 1) != 0, (m.faultmask & 1) != 0, std::uint8_t(m.basepri)};
}

void Core::reset(std::uint32_t vectors) {
  locked_up_ = false;
  std::uint32_t first[2] = {};
  cpu_.read_memory(vectors, first, sizeof first);
  CoreRegisters r;
  r.lr = 0xFFFF'FFFF;
  r.sp = first[0] & ~3u;
  r.pc = first[1];
  r.xpsr = kThumb;
  cpu_.set_masks({});
  cpu_.set_registers(r);
}

Core::Stop Core::run() {
  for (;;) {
    if (const int exception = due()) enter(exception);
    if (locked_up_) return Stop::kLockedUp;
    switch (cpu_.run()) {
      case Cpu::Stop::kSleep:
        if (!wakes()) return Stop::kAsleep;
        break;
      case Cpu::Stop::kExceptionReturn:
        return_from_exception();
        break;
      case Cpu::Stop::kCheckpoint:
        break;
      case Cpu::Stop::kFault:
        if (!take_fault()) return Stop::kLockedUp;
        break;
      case Cpu::Stop::kRequested:
        return Stop::kResetRequested;
      case Cpu::Stop::kStuck:
        return Stop::kStuck;
    }
  }
}

/// Pushes what the handler may change; with floating-point state also s0 to s15 and FPSCR. (The
/// part leaves their place free and fills it when the handler first uses the FPU: same contents
/// after.)
bool Core::push_frame(CoreRegisters& r) {
  if ((r.control & kProcessStack) != 0) throw EmulatorError("the process stack has no model");
  const bool fp = (r.control & kFpActive) != 0;
  const bool misaligned = (r.sp & 4) != 0;
  const std::uint32_t frame = (r.sp - (fp ? kFpFrame : kBasicFrame)) & ~7u;
  const std::array<std::uint32_t, 8> words = {
      r.r0, r.r1, r.r2, r.r3, r.r12, r.lr, r.pc, r.xpsr | (misaligned ? kFrameAligned : 0)};
  bool good = !control_.forbidden(frame) && cpu_.write_memory(frame, words.data(), sizeof words);
  if (fp && good) {
    std::array<std::uint32_t, 18> state{};
    cpu_.read_fp(std::span<std::uint32_t, 17>(state.data(), 17));
    good = cpu_.write_memory(frame + kBasicFrame, state.data(), sizeof state);
  }
  r.lr = kReturn | (fp ? 0 : kNoFp) | (nvic_.active() == 0 ? kToThread : 0);
  r.sp = frame;
  return good;
}

void Core::enter(int exception) {
  CoreRegisters r = cpu_.registers();
  if (!push_frame(r)) {
    // The stack is used up: the derived fault comes instead, on what stack there is (B1.5.10).
    const bool mpu = control_.forbidden(r.sp);
    const std::uint32_t status = mpu ? fault_status::kMemoryStacking : fault_status::kBusStacking;
    last_fault_ = {status, r.sp};
    const int fault = control_.raise(status, r.sp, masks());
    if (fault == exception::kHardFault && nvic_.active() == exception::kHardFault) {
      locked_up_ = true;
      return;
    }
    exception = fault;
  }
  go_to_handler(exception, r);
}

void Core::go_to_handler(int exception, CoreRegisters r) {
  std::uint32_t handler = 0;
  cpu_.read_memory(control_.vector_table() + 4 * std::uint32_t(exception), &handler, 4);
  nvic_.activate(exception);
  ++counts_.exceptions;
  r.pc = handler;
  r.xpsr = kThumb | std::uint32_t(exception);
  r.control &= ~(kFpActive | kProcessStack);
  cpu_.set_registers(r);
}

/// The next handler on the same frame.
void Core::tail_chain(int exception, std::uint32_t exception_return) {
  CoreRegisters r = cpu_.registers();
  r.lr = exception_return;
  ++counts_.tail_chained;
  go_to_handler(exception, r);
}

void Core::return_from_exception() {
  CoreRegisters r = cpu_.registers();
  const std::uint32_t value = r.pc | 1;
  if ((value & kToProcessStack) != 0) throw EmulatorError("the process stack has no model");
  const int ended = nvic_.active();
  nvic_.deactivate(ended);
  if (ended != exception::kNmi) {
    Cpu::MaskRegisters m = cpu_.masks();
    if (m.faultmask != 0) {
      m.faultmask = 0;
      cpu_.set_masks(m);
    }
  }
  if (const int exception = due()) return tail_chain(exception, value);
  std::array<std::uint32_t, 8> words{};
  cpu_.read_memory(r.sp, words.data(), sizeof words);
  const bool fp = (value & kNoFp) == 0;
  if (fp) {
    std::array<std::uint32_t, 17> state{};
    cpu_.read_memory(r.sp + kBasicFrame, state.data(), sizeof state);
    cpu_.write_fp(state);
  }
  r.r0 = words[0], r.r1 = words[1], r.r2 = words[2], r.r3 = words[3];
  r.r12 = words[4], r.lr = words[5], r.pc = words[6];
  r.xpsr = words[7] & ~kFrameAligned;
  r.sp += (fp ? kFpFrame : kBasicFrame) + ((words[7] & kFrameAligned) != 0 ? 4 : 0);
  r.control = (r.control & ~kFpActive) | (fp ? kFpActive : 0);
  cpu_.set_registers(r);
}

/// @return false where the fault cannot be handled any more
bool Core::take_fault() {
  Cpu::Fault fault = cpu_.fault();
  const bool data = fault.status == fault_status::kPreciseData;
  if (data && control_.forbidden(fault.address)) {
    fault.status = fault_status::kDataAccess | fault_status::kMemoryAddress;
  } else if (data) {
    fault.status |= fault_status::kBusAddress;
  } else if (fault.status == fault_status::kInstructionBus && control_.forbidden(fault.address)) {
    fault.status = fault_status::kInstructionAccess;
  }
  last_fault_ = fault;
  const int exception = control_.raise(fault.status, fault.address, masks());
  const int running = nvic_.active();
  if (exception == exception::kHardFault &&
      (running == exception::kHardFault || running == exception::kNmi)) {
    return false;
  }
  enter(exception);
  return !locked_up_;
}

}  // namespace hoof::tools::emulator
