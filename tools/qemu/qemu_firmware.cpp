#include "tools/qemu/qemu_firmware.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "tools/emulator/emulated_firmware.h"
#include "tools/emulator/flash_controller.h"

namespace hoof::tools::qemu {
namespace {

/// QEMU starts in half a second, on a crowded machine in some.
constexpr std::int64_t kLeastForStart_ns = 20'000'000'000;

void put(std::vector<std::uint8_t>& flash, std::uint32_t address,
         const std::vector<std::uint8_t>& bytes) {
  if (address < QemuMachine::kFlashStart ||
      address - QemuMachine::kFlashStart + bytes.size() > flash.size()) {
    throw std::runtime_error("the image has bytes outside the flash");
  }
  std::copy(bytes.begin(), bytes.end(), flash.begin() + (address - QemuMachine::kFlashStart));
}

std::vector<std::uint8_t> bytes_of(const hal::RamFlash& flash) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t sector = 0; sector < flash.sector_count(); ++sector) {
    for (std::size_t word = 0; word < flash.sector_words(sector); ++word) {
      const hal::Nonvolatile::Word value = flash.read(sector, word);
      for (int i = 0; i < 4; ++i) bytes.push_back(std::uint8_t(value >> (8 * i)));
    }
  }
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> flash_contents(const emulator::ElfFile& image,
                                         const firmware::app::Parameters& parameters) {
  std::vector<std::uint8_t> flash(QemuMachine::kFlashBytes, 0xFF);
  put(flash, emulator::FlashController::kDataStart, bytes_of(emulator::flash_with(parameters)));
  for (const auto& segment : image.segments) put(flash, segment.load_address, segment.bytes);
  return flash;
}

QemuFirmware::QemuFirmware(const std::vector<std::uint8_t>& flash, Buses buses, Buses visitors,
                           const hal::Clock& clock, std::int64_t patience_ns)
    : line_(flash, std::max(patience_ns, kLeastForStart_ns)),
      foot_(line_, buses, visitors, clock, patience_ns) {}

bridge::FirmwareMaker qemu_firmware(const std::string& image,
                                    const firmware::app::Parameters& parameters,
                                    bridge::Wires& wires, std::int64_t patience_ns) {
  find_qemu();
  return [flash = flash_contents(emulator::read_elf_file(image), parameters), &wires, patience_ns](
             hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
    return std::make_unique<QemuFirmware>(
        flash, QemuFirmware::Buses{&bus0, &bus1},
        QemuFirmware::Buses{&wires.attach(0, "visitor"), &wires.attach(1, "visitor")}, clock,
        patience_ns);
  };
}

}  // namespace hoof::tools::qemu
