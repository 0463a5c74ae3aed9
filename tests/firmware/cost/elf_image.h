// A linked 32-bit little-endian ELF file: what goes into memory, and its symbols.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hoof::tests::cost {

struct Segment {
  std::uint32_t address;
  std::vector<unsigned char> bytes;
};

struct ElfImage {
  std::vector<Segment> segments;
  std::map<std::string, std::uint32_t> symbols;

  // Throws std::runtime_error when there is none of that name.
  std::uint32_t symbol(const std::string& name) const;
};

// Throws std::runtime_error with the path when the file is not such an image.
ElfImage read_elf(const std::string& path);

}  // namespace hoof::tests::cost
