// What the linker script knows: where memory begins and ends.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hoof::firmware::stm32f405 {

/// The stack lies at the bottom of RAM: growing too far it leaves RAM, instead of eating data.
inline constexpr std::uintptr_t kStackBottom = 0x2000'0000;
inline constexpr std::uintptr_t kStackBytes = 4096;
inline constexpr std::uintptr_t kStackTop = kStackBottom + kStackBytes;

/// What the stack holds where it was never used.
inline constexpr std::uint32_t kStackPaint = 0xA5A5'A5A5;

inline constexpr std::uintptr_t kBootLoader = 0x0800'0000;  // sector 0
inline constexpr std::uintptr_t kParameters = 0x0800'4000;  // sectors 1 to 3
inline constexpr std::uintptr_t kImages = 0x0802'0000;      // sectors 5 and 6
inline constexpr std::uintptr_t kImageBytes = 128 * 1024;   // of each

extern "C" {
// Their addresses are the values.
extern const std::uint32_t hoof_vectors;
extern std::uint32_t hoof_stack_bottom;
extern std::uint32_t hoof_stack_top;
extern std::uint32_t hoof_fault_stack_top;
extern std::uint32_t hoof_data_start;
extern std::uint32_t hoof_data_end;
extern const std::uint32_t hoof_data_load;
extern std::uint32_t hoof_bss_start;
extern std::uint32_t hoof_bss_end;
using Constructor = void (*)();
extern const Constructor hoof_constructors_start;
extern const Constructor hoof_constructors_end;
}

/// Which of the two this image is linked for.
inline std::size_t running_slot() {
  return (reinterpret_cast<std::uintptr_t>(&hoof_vectors) - kImages) / kImageBytes;
}

}  // namespace hoof::firmware::stm32f405
