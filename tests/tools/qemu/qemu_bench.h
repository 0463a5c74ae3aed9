// A whole test with the board's image in QEMU in the firmware's place.
#pragma once

#include <iostream>

#include "tests/tools/emulator/image_bench.h"
#include "tools/qemu/qemu_firmware.h"
#include "tools/run/errors.h"

namespace hoof::test {

/// By the wall, on a crowded machine.
inline constexpr std::int64_t kPatience_ns = 60'000'000'000;

/// CTest takes the line for a test that was skipped.
inline bool qemu_is_here() {
  try {
    tools::qemu::find_qemu();
    return true;
  } catch (const tools::UserError& error) {
    std::cout << "SKIPPED: " << error.what() << std::endl;
    return false;
  }
}

inline FirmwareOn in_qemu(const tools::RunSettings& run) {
  return [&run](bridge::Wires& wires) {
    return tools::qemu::qemu_firmware(image_file(), run.parameters, wires, kPatience_ns);
  };
}

}  // namespace hoof::test
