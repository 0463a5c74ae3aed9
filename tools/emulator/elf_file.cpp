#include "tools/emulator/elf_file.h"

#include <cxxabi.h>
#include <elf.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {
namespace {

class Bytes {
 public:
  explicit Bytes(const std::string& path) : path_(path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error(path + ": cannot be opened");
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
  }

  template <typename T>
  T at(std::size_t offset) const {
    require(offset, sizeof(T));
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }

  std::vector<std::uint8_t> piece(std::size_t offset, std::size_t size) const {
    require(offset, size);
    const auto begin = bytes_.begin() + std::ptrdiff_t(offset);
    return {begin, begin + std::ptrdiff_t(size)};
  }

  std::string text(std::size_t offset) const {
    require(offset, 1);
    const char* begin = bytes_.data() + offset;
    return {begin, strnlen(begin, bytes_.size() - offset)};
  }

 private:
  void require(std::size_t offset, std::size_t size) const {
    if (offset > bytes_.size() || size > bytes_.size() - offset) {
      throw std::runtime_error(path_ + ": ends before it should");
    }
  }

  std::string path_;
  std::vector<char> bytes_;
};

void read_symbols(const Bytes& file, const Elf32_Ehdr& header, ElfFile& elf) {
  const auto section = [&](std::size_t i) {
    return file.at<Elf32_Shdr>(header.e_shoff + i * header.e_shentsize);
  };
  for (std::size_t i = 0; i < header.e_shnum; ++i) {
    const Elf32_Shdr table = section(i);
    if (table.sh_type != SHT_SYMTAB) continue;
    const Elf32_Shdr names = section(table.sh_link);
    for (std::size_t at = 0; at < table.sh_size; at += sizeof(Elf32_Sym)) {
      const auto s = file.at<Elf32_Sym>(table.sh_offset + at);
      if (s.st_shndx == SHN_UNDEF) continue;
      const bool function = ELF32_ST_TYPE(s.st_info) == STT_FUNC;
      const std::string name = file.text(names.sh_offset + s.st_name);
      if (name.empty() || name[0] == '$') continue;  // marks of code and data
      elf.symbols.push_back({name, function ? s.st_value & ~1u : s.st_value, s.st_size, function});
    }
  }
  std::stable_sort(elf.symbols.begin(), elf.symbols.end(),
                   [](const auto& a, const auto& b) { return a.address < b.address; });
}

std::string readable(const std::string& mangled) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> name(
      abi::__cxa_demangle(mangled.c_str(), nullptr, nullptr, &status), std::free);
  return status == 0 ? name.get() : mangled;
}

}  // namespace

const ElfFile::Symbol* ElfFile::function_at(std::uint32_t address) const {
  const Symbol* found = nullptr;
  for (const Symbol& s : symbols) {
    if (s.address > address) break;
    if (s.is_function && address - s.address < s.size) found = &s;
  }
  return found;
}

std::optional<std::uint32_t> ElfFile::address_of(const std::string& name) const {
  for (const Symbol& s : symbols) {
    if (s.name == name) return s.address;
  }
  return std::nullopt;
}

std::string ElfFile::place(std::uint32_t address) const {
  const Symbol* function = function_at(address);
  if (function == nullptr) return hex(address);
  return hex(address) + " (" + readable(function->name) + ")";
}

ElfFile read_elf_file(const std::string& path) {
  const Bytes file(path);
  const auto header = file.at<Elf32_Ehdr>(0);
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS32 ||
      header.e_machine != EM_ARM) {
    throw std::runtime_error(path + ": is not a 32-bit Arm ELF file");
  }
  ElfFile elf;
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    const auto p = file.at<Elf32_Phdr>(header.e_phoff + i * header.e_phentsize);
    if (p.p_type != PT_LOAD || p.p_filesz == 0) continue;
    elf.segments.push_back({p.p_paddr, p.p_vaddr, file.piece(p.p_offset, p.p_filesz)});
  }
  read_symbols(file, header, elf);
  return elf;
}

}  // namespace hoof::tools::emulator
