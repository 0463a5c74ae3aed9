// A whole test with the board's image in the firmware's place, on the rigid floor.
#pragma once

#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "firmware/protocol/codec.h"
#include "tests/hil_bridge/rigid_bench.h"
#include "tools/emulator/emulated_firmware.h"

namespace hoof::test {

/// What `tools/hoof firmware build` made (the CTest fixture board_image).
inline std::string image_file() {
  return HOOF_BOARD_IMAGE;
}

inline bridge::SessionSettings session_settings(const tools::RunSettings& run) {
  bridge::SessionSettings s;
  s.has_toes = run.foot.has_toes;
  s.toe_rad = run.toe_rad();
  s.firmware_leg = run.firmware_leg();
  s.frequency_Hz = run.traction.frequency_Hz;
  return s;
}

struct RunRecord {
  std::vector<SeenFrame> frames;
  bridge::SessionResult result;
};

/// Makes the maker of a firmware for the wires of a run.
using FirmwareOn = std::function<bridge::FirmwareMaker(bridge::Wires&)>;

inline FirmwareOn host(const tools::RunSettings& run) {
  return [&run](bridge::Wires&) { return bridge::local_firmware(run.parameters); };
}

inline FirmwareOn image(const tools::RunSettings& run) {
  return [&run](bridge::Wires& wires) {
    return tools::emulator::emulated_firmware(image_file(), run.parameters, wires);
  };
}

/// @param most_ticks then the run ends
inline RunRecord record_run(const tools::RunSettings& run, const FirmwareOn& firmware,
                            std::uint32_t most_ticks = UINT32_MAX) {
  RunRecord record;
  const auto experiment = rigid_bench(run);
  const auto wires = bridge::in_process_wires([&](int bus, const hal::CanFrame& frame) {
    record.frames.push_back({bus, frame});
  });
  std::uint32_t ticks = 0;
  record.result =
      bridge::run_session(*experiment, firmware(*wires), *wires, session_settings(run),
                          [&](const bridge::TickRecord&) { return ++ticks < most_ticks; });
  return record;
}

inline bool is_command(const hal::CanFrame& frame) {
  for (const auto drive : firmware::protocol::kDrives) {
    if (frame.id == firmware::protocol::command_spec(drive).id) return true;
  }
  return false;
}

}  // namespace hoof::test
