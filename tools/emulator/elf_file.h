// The image's ELF file: what a programmer would write into flash, and the names of its functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hoof::tools::emulator {

struct ElfFile {
  struct Segment {
    std::uint32_t load_address;  // where it lies in flash
    std::uint32_t run_address;   // where it is when it runs; start-up copies what differs
    std::vector<std::uint8_t> bytes;
  };
  struct Symbol {
    std::string name;  // as the linker has it, mangled
    std::uint32_t address;
    std::uint32_t size;
    bool is_function;
  };

  std::vector<Segment> segments;
  std::vector<Symbol> symbols;  // by address

  /// The function that holds the address.
  const Symbol* function_at(std::uint32_t address) const;
  /// Nothing where there is none of this (mangled) name.
  std::optional<std::uint32_t> address_of(const std::string& name) const;
  /// "0x08010234 (hoof::firmware::app::ControlLoop::poll())", for messages.
  std::string place(std::uint32_t address) const;
};

/// @throws std::runtime_error with the path where the file is no 32-bit Arm ELF file
ElfFile read_elf_file(const std::string& path);

}  // namespace hoof::tools::emulator
