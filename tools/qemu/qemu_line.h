// The way to an image in QEMU: its two serial lines.
#pragma once

#include <array>

#include "hil_bridge/foot_line.h"
#include "hil_bridge/wires.h"
#include "tools/qemu/qemu_machine.h"
#include "tools/qemu/slcan_client.h"

namespace hoof::tools::qemu {

class QemuLine final : public bridge::FootLine {
 public:
  /// Starts the machine and waits until the image has opened both lines.
  /// @param flash as QemuMachine has it  @param patience_ns longest wait for that, by the wall
  /// @throws std::runtime_error saying what did not come
  QemuLine(const std::vector<std::uint8_t>& flash, std::int64_t patience_ns);

  std::string foot() const override { return "the image in QEMU"; }
  std::string advice() const override;
  bool one_interface() const override { return false; }
  hal::CanBus& bus(int index) override { return clients_[std::size_t(index)]; }
  void wait(std::int64_t longest_ns) override { clients_[0].wait(longest_ns); }
  /// Waits until the image has taken the frames of bus 1.
  bool flush() override;
  std::string gone() override;

  QemuMachine& machine() { return machine_; }

 private:
  QemuMachine machine_;
  std::array<SlcanClient, bridge::kBusCount> clients_;
};

}  // namespace hoof::tools::qemu
