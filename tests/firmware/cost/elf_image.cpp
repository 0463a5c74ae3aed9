#include "tests/firmware/cost/elf_image.h"

#include <elf.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace hoof::tests::cost {
namespace {

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error(path + ": cannot be opened");
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
  }

  template <typename T>
  T at(std::size_t offset) const {
    T value;
    check(offset, sizeof value);
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }

  std::vector<unsigned char> slice(std::size_t offset, std::size_t size) const {
    check(offset, size);
    const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(offset);
    return {begin, begin + static_cast<std::ptrdiff_t>(size)};
  }

  std::string text(std::size_t offset) const {
    check(offset, 1);
    const auto* begin = reinterpret_cast<const char*>(bytes_.data()) + offset;
    return {begin, strnlen(begin, bytes_.size() - offset)};
  }

 private:
  void check(std::size_t offset, std::size_t size) const {
    if (offset > bytes_.size() || size > bytes_.size() - offset) {
      throw std::runtime_error(path_ + ": ends before it should");
    }
  }

  std::string path_;
  std::vector<unsigned char> bytes_;
};

void read_symbols(const Reader& file, const Elf32_Ehdr& header, ElfImage& image) {
  for (int i = 0; i < header.e_shnum; ++i) {
    const auto section =
        file.at<Elf32_Shdr>(header.e_shoff + static_cast<std::size_t>(i) * header.e_shentsize);
    if (section.sh_type != SHT_SYMTAB) continue;
    const auto names =
        file.at<Elf32_Shdr>(header.e_shoff + std::size_t{section.sh_link} * header.e_shentsize);
    for (std::size_t at = 0; at < section.sh_size; at += sizeof(Elf32_Sym)) {
      const auto symbol = file.at<Elf32_Sym>(section.sh_offset + at);
      if (symbol.st_shndx == SHN_UNDEF) continue;
      image.symbols[file.text(names.sh_offset + symbol.st_name)] = symbol.st_value;
    }
  }
}

}  // namespace

std::uint32_t ElfImage::symbol(const std::string& name) const {
  const auto found = symbols.find(name);
  if (found == symbols.end()) throw std::runtime_error("the image has no symbol " + name);
  return found->second;
}

ElfImage read_elf(const std::string& path) {
  const Reader file(path);
  const auto header = file.at<Elf32_Ehdr>(0);
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS32 ||
      header.e_machine != EM_ARM) {
    throw std::runtime_error(path + ": is not a 32-bit Arm ELF file");
  }
  ElfImage image;
  for (int i = 0; i < header.e_phnum; ++i) {
    const auto segment =
        file.at<Elf32_Phdr>(header.e_phoff + static_cast<std::size_t>(i) * header.e_phentsize);
    if (segment.p_type != PT_LOAD) continue;
    image.segments.push_back({segment.p_vaddr, file.slice(segment.p_offset, segment.p_filesz)});
  }
  read_symbols(file, header, image);
  return image;
}

}  // namespace hoof::tests::cost
