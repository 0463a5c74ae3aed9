// The board's image, run by QEMU, in the firmware's place on the buses of a lock-step run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/app/parameters.h"
#include "hil_bridge/firmware_node.h"
#include "hil_bridge/remote_foot.h"
#include "hil_bridge/wires.h"
#include "tools/emulator/elf_file.h"
#include "tools/qemu/qemu_line.h"

namespace hoof::tools::qemu {

/// What a programmer and the firmware's own storage write: the image, and these parameters.
/// @throws std::invalid_argument where a value is out of its range; std::runtime_error where the
/// image does not fit
std::vector<std::uint8_t> flash_contents(const emulator::ElfFile& image,
                                         const firmware::app::Parameters& parameters);

class QemuFirmware final : public bridge::FirmwareNode {
 public:
  using Buses = std::array<hal::CanBus*, bridge::kBusCount>;

  /// @param flash as QemuMachine has it  @param buses of the foot
  /// @param visitors connections of their own (RemoteFoot)
  /// @param patience_ns longest wait for an answer, by the wall
  /// @throws std::runtime_error where the image does not begin
  QemuFirmware(const std::vector<std::uint8_t>& flash, Buses buses, Buses visitors,
               const hal::Clock& clock, std::int64_t patience_ns);

  void poll(std::uint32_t tick) override { foot_.poll(tick); }
  const firmware::app::Telemetry& telemetry() const override { return foot_.telemetry(); }
  const std::string& lost() const override { return foot_.lost(); }

  QemuMachine& machine() { return line_.machine(); }

 private:
  QemuLine line_;
  bridge::RemoteFoot foot_;
};

/// @param image file of `hoof firmware build`
/// @param wires of the run; must outlive the node
/// @throws UserError where there is no QEMU; std::runtime_error where there is no image
bridge::FirmwareMaker qemu_firmware(const std::string& image,
                                    const firmware::app::Parameters& parameters,
                                    bridge::Wires& wires, std::int64_t patience_ns);

}  // namespace hoof::tools::qemu
