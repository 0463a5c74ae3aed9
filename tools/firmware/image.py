"""An ELF image for the board: sections, symbols, words, disassembly."""

import dataclasses
import re
import struct
import subprocess

PREFIX = "arm-none-eabi-"


@dataclasses.dataclass(frozen=True)
class Section:
    name: str
    address: int
    size: int
    content: bytes  # empty where nothing is loaded
    allocated: bool
    load_address: int
    file_offset: int = 0


@dataclasses.dataclass(frozen=True)
class Symbol:
    name: str
    address: int  # without the Thumb bit
    size: int
    is_function: bool


@dataclasses.dataclass(frozen=True)
class Instruction:
    address: int
    mnemonic: str  # without width suffix
    operands: str


def run(tool, *arguments, text=None):
    return subprocess.run([PREFIX + tool, *arguments], check=True, capture_output=True, text=True,
                          input=text).stdout


class Image:
    def __init__(self, path):
        self.path = path
        with open(path, "rb") as file:
            self._bytes = file.read()
        if self._bytes[:5] != b"\x7fELF\x01":
            raise ValueError(f"{path}: not a 32-bit ELF file")
        self.sections = self._read_sections()
        self.symbols = self._read_symbols()
        self.functions = {s.address: s for s in self.symbols if s.is_function}
        self.demangled = self._demangle()

    def _header_table(self):
        offset, = struct.unpack_from("<I", self._bytes, 32)
        size, count, names = struct.unpack_from("<HHH", self._bytes, 46)
        rows = [struct.unpack_from("<10I", self._bytes, offset + i * size) for i in range(count)]
        return rows, rows[names][4]

    def _segments(self):
        offset, = struct.unpack_from("<I", self._bytes, 28)
        size, count = struct.unpack_from("<HH", self._bytes, 42)
        return [struct.unpack_from("<8I", self._bytes, offset + i * size) for i in range(count)]

    def _string(self, offset):
        return self._bytes[offset:self._bytes.index(b"\0", offset)].decode()

    def _read_sections(self):
        rows, names = self._header_table()
        sections = []
        for name, kind, flags, address, offset, size, *_ in rows:
            loaded = kind not in (0, 8)  # neither the empty one nor NOBITS
            load_address = address
            for p_type, p_offset, p_vaddr, p_paddr, p_filesz, *_ in self._segments():
                if p_type == 1 and loaded and p_offset <= offset < p_offset + p_filesz:
                    load_address = p_paddr + offset - p_offset
            sections.append(Section(self._string(names + name), address, size,
                                    self._bytes[offset:offset + size] if loaded else b"",
                                    bool(flags & 2), load_address, offset))
        return sections

    def _read_symbols(self):
        rows, _ = self._header_table()
        table = next(row for row in rows if row[1] == 2)
        strings = rows[table[6]][4]
        symbols = []
        for at in range(table[4], table[4] + table[5], 16):
            name, value, size, info, _, index = struct.unpack_from("<IIIBBH", self._bytes, at)
            kind = info & 0xF
            if index == 0 or kind > 2 or name == 0:
                continue
            function = kind == 2
            symbols.append(Symbol(self._string(strings + name), value & ~1 if function else value,
                                  size, function))
        # $t, $d mark code and data within sections.
        return [s for s in symbols if not s.name.startswith("$")]

    def _demangle(self):
        names = sorted({s.name for s in self.symbols})
        return dict(zip(names, run("c++filt", text="\n".join(names)).split("\n")))

    def section(self, name):
        return next((s for s in self.sections if s.name == name), None)

    def loaded_sections(self):
        return [s for s in self.sections if s.allocated and s.content]

    def word(self, address):
        """The word at an address, or None where the image loads nothing."""
        for section in self.loaded_sections():
            if section.address <= address <= section.address + len(section.content) - 4:
                return struct.unpack_from("<I", section.content, address - section.address)[0]
        return None

    def words(self):
        """All aligned words that are loaded, as (address, word)."""
        for section in self.loaded_sections():
            first = -section.address % 4
            for at in range(first, len(section.content) - 3, 4):
                yield section.address + at, struct.unpack_from("<I", section.content, at)[0]

    def name_of(self, address):
        symbol = self.functions.get(address)
        return self.demangled[symbol.name] if symbol else f"0x{address:08x}"

    def code(self):
        """Instructions of each function, by its address."""
        # Code may lie in writable sections, too: those the image copies to RAM.
        sections = [f"--section={s.name}" for s in self.loaded_sections()]
        listing = run("objdump", "--disassemble", "--no-show-raw-insn", *sections, self.path)
        code, current = {}, None
        for line in listing.splitlines():
            head = re.match(r"([0-9a-f]{8}) <.*>:$", line)
            if head:
                address = int(head[1], 16)
                current = code.setdefault(address, []) if address in self.functions else None
                continue
            body = re.match(r"\s*([0-9a-f]+):\t(\S+)\s*(.*)$", line)
            if body and current is not None and not body[2].startswith("."):
                mnemonic = body[2].removesuffix(".w").removesuffix(".n")
                current.append(Instruction(int(body[1], 16), mnemonic, body[3]))
        return code
