// What is kept of a fault over the reset that ends it.
#pragma once

#include <cstdint>

namespace hoof::firmware::stm32f405 {

/// Ends of the firmware's own making.
enum class Panic : std::uint32_t {
  kAborted = 1,  // abort(), also from the C++ library's own checks
  kPureVirtualCall = 2,
  kMainEnded = 3,
  kRestart = 4,  // no crash: restart_on_request()
};

/// Filled in by the fault handlers, in RAM that start-up leaves alone. Whole where the CRC fits.
struct CrashRecord {
  static constexpr std::uint32_t kMagic = 0x4846'4352;  // "HFCR"

  std::uint32_t magic;
  std::uint32_t count;      // crashes since the power came on
  std::uint32_t exception;  // 2 NMI (the crystal failed), 3 hard, 4 memory, 5 bus, 6 usage fault,
                            // from 16 on an interrupt nobody serves; 0 a Panic
  std::uint32_t panic;      // Panic, else 0
  std::uint32_t pc;         // where it happened; 0 where the frame could not be pushed
  std::uint32_t lr;
  std::uint32_t psr;
  std::uint32_t sp;  // of the frame; below the stack: it overflowed
  std::uint32_t cfsr;
  std::uint32_t hfsr;
  std::uint32_t mmfar;  // address of a memory fault, valid as CFSR says
  std::uint32_t bfar;   // of a bus fault
  std::uint32_t crc;    // CRC-32 of all words before

  bool whole() const;
};

/// As the last crash left it; not whole after the power was off.
const CrashRecord& crash_record();

/// Resets on purpose, and leaves a record that says so.
[[noreturn]] void restart_on_request();
/// Whether the last reset was that. Once: the next call denies it.
bool take_restart_request();

/// Records and resets.
[[noreturn]] void panic(Panic reason);

extern "C" {
/// Vector of every exception that is not served otherwise.
void hoof_fault();
}

}  // namespace hoof::firmware::stm32f405
