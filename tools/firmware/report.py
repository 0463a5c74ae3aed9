#!/usr/bin/env python3
"""What an image needs of the board: flash, RAM, worst-case stack, and what must not be in it.

    tools/firmware/report.py build/release/stm32f405/.../hoof-stm32f405.elf --build DIR

Exit status: 0 within all bounds, 1 where one is missed, 2 for wrong input."""

import argparse
import hashlib
import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True

from call_graph import CallGraph  # noqa: E402
from image import Image  # noqa: E402
from stack_bound import EXCEPTION_FRAME, StackBound, StackError, read_frames  # noqa: E402

FAULT_STACK = 512
BOOT_FLASH = 16 * 1024  # sector 0
BOOT_STACK = 4096  # below the application's crash record
PACKED = (".boot", ".spare")  # in the ELF file, not of the image
MARKS = 32  # at the end of its slot, where a header stands at its begin

FORBIDDEN = [
    ("heap", r"(_?(malloc|free|calloc|realloc|memalign)(_r)?|_?sbrk(_r)?|_Zn[wa].*|_Zd[la].*)"),
    ("exceptions", r"(__cxa_(throw|rethrow|begin_catch|allocate_exception).*|_Unwind_.*"
                   r"|__gxx_personality.*|_ZSt9terminatev)"),
    ("run-time types", r"(_ZTI.*|_ZTS.*|__dynamic_cast)"),
    ("software doubles", r"(__aeabi_(d|cd)[a-z0-9]+|__aeabi_[a-z]+2d|__[a-z]+df[0-9a-z]*"
                         r"|__(fix|fixuns)df[sd]i|__float[a-z]*df|__truncdfsf2|__extend[a-z]*df2)"),
    ("libm", r"_*(ieee754_)?(sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|exp|exp2|expm1|log|log2"
             r"|log10|log1p|pow|sqrt|cbrt|hypot|fmod|rem_pio2|kernel_(sin|cos|tan))f?"),
    ("text output", r"_?([a-z]*printf|puts|putchar|fwrite|fputs|_*dtoa|_*svfi?printf)(_r)?"),
]


def folder_of(name):
    """The folder that a demangled name belongs to, by its namespace."""
    found = re.search(r"\bhoof::(?:firmware::)?([a-z0-9_]+)::", name)
    if found:
        folder = {"stm32f405": "board"}.get(found[1], found[1])
        return folder if "hoof::hal::" not in found[0] else "hal"
    if name.startswith(("hoof_", "main", "guard variable for main")):
        return "board"
    return "libraries"


def is_ram(address):
    return 0x10000000 <= address < 0x10010000 or 0x20000000 <= address < 0x40000000


class Report:
    def __init__(self, arguments):
        self.arguments = arguments
        self.image = Image(arguments.elf)
        self.code = self.image.code()
        self.missed = []

    def gate(self, what, value, bound, unit):
        good = value <= bound
        if not good:
            self.missed.append(f"{what}: {value:,} {unit}, bound {bound:,}")
        return "within" if good else "OVER"

    def flash(self):
        loaded = [s for s in self.image.loaded_sections() if s.size and s.name not in PACKED]
        print("flash")
        for section in loaded:
            print(f"  {section.name:<14}{section.size:>8,}  at 0x{section.load_address:08x}")
        total = sum(s.size for s in loaded)
        if self.image.section(".header"):
            print(f"  {'marks':<14}{MARKS:>8,}  at the end of the slot")
            total += MARKS
        bound = self.arguments.flash
        print(f"  {'total':<14}{total:>8,}  of {bound:,} bytes: "
              f"{self.gate('flash', total, bound, 'bytes')}")
        self._folders(loaded, total)

    def _folders(self, loaded, total):
        sizes, seen = {}, set()
        for symbol in self.image.symbols:
            inside = any(s.address <= symbol.address < s.address + s.size for s in loaded)
            if not inside or symbol.address in seen or symbol.size == 0:
                continue
            seen.add(symbol.address)
            folder = folder_of(self.image.demangled[symbol.name])
            sizes[folder] = sizes.get(folder, 0) + symbol.size
        sizes["unnamed"] = total - sum(sizes.values())  # texts, constants, padding
        print("  by folder (of each symbol's namespace)")
        for folder, size in sorted(sizes.items(), key=lambda item: -item[1]):
            print(f"    {folder:<14}{size:>8,}")

    def ram(self):
        # By address: a section that holds code alone is not marked writable.
        parts = [s for s in self.image.sections if s.allocated and s.size and is_ram(s.address)]
        print("RAM")
        for section in parts:
            print(f"  {section.name:<14}{section.size:>8,}  at 0x{section.address:08x}")
        total, bound = sum(s.size for s in parts), self.arguments.ram
        print(f"  {'total':<14}{total:>8,}  of {bound:,} bytes, stack included: "
              f"{self.gate('RAM', total, bound, 'bytes')}")
        data = [s for s in self.image.symbols if not s.is_function and s.size > 64 and
                any(p.address <= s.address < p.address + p.size for p in parts)]
        print("  largest objects")
        for symbol in sorted(data, key=lambda s: -s.size)[:5]:
            print(f"    {self.image.demangled[symbol.name]:<52}{symbol.size:>8,}")

    def stack(self):
        print("stack, worst case by the compiler's frames along the image's calls")
        try:
            self._stack()
        except StackError as error:
            self.missed.append(f"stack: {error}")
            print(f"  no bound: {error}")

    def _stack(self):
        graph = CallGraph(self.image, self.code)
        bound = StackBound(self.image, self.code, graph,
                           read_frames(self.arguments.build, self.arguments.elf))
        start = {s.name: s.address for s in self.image.functions.values()}
        main, calls = bound.chain(start["hoof_start"])
        for address, frame in calls:
            print(f"    {frame:>5}  {self.image.name_of(address)[:86]}")
        print(f"  {'main':<28}{main:>6,}")
        served = set(graph.vectors()) - {start["hoof_reset"], start["hoof_fault"]}
        interrupts = [(bound.chain(address)[0], self.image.name_of(address)) for address in served]
        interrupt, name = max(interrupts, default=(0, "no interrupt"))
        print(f"  {'one interrupt':<28}{interrupt + EXCEPTION_FRAME:>6,}  "
              f"{name}; all have one priority, none nests")
        print(f"  {'entry of a fault':<28}{EXCEPTION_FRAME:>6,}  goes on on a stack of its own")
        total = main + interrupt + 2 * EXCEPTION_FRAME
        limit = self.arguments.stack
        print(f"  {'total':<28}{total:>6,}  of {limit:,} bytes: "
              f"{self.gate('stack', total, limit, 'bytes')}")
        fault, _ = bound.chain(start["hoof_record_fault"])
        print(f"  {'fault handler':<28}{fault:>6,}  of {FAULT_STACK:,} bytes: "
              f"{self.gate('stack of the fault handler', fault, FAULT_STACK, 'bytes')}")
        self._indirect(graph)
        self._code_in_ram(graph)

    @staticmethod
    def _indirect(graph):
        calls = [(node.name, count) for node in graph.nodes.values() for _, count in node.indirect]
        print(f"  {len(calls)} calls through pointers, each taken as the deepest of those that it "
              f"can reach ({max((c for _, c in calls), default=0)} at most); no recursion")

    def _code_in_ram(self, graph):
        """What runs from RAM does so while flash cannot be read."""
        for address, node in graph.nodes.items():
            if not is_ram(address):
                continue
            for callee in node.callees:
                if not is_ram(callee):
                    self.missed.append(f"{node.name} runs from RAM and calls "
                                       f"{self.image.name_of(callee)} in flash")

    def forbidden(self):
        self._forbidden(self.image, "image")

    def _forbidden(self, image, name):
        print(f"must not be in the {name}")
        for what, pattern in FORBIDDEN:
            found = sorted(s.name for s in image.symbols if re.fullmatch(pattern, s.name))
            print(f"  {what:<18}{', '.join(found) if found else 'none'}")
            if found:
                self.missed.append(f"{what} in the {name}: {', '.join(found)}")

    def boot(self):
        """The boot loader: a program of its own, of which a part of the bounds is another."""
        if not self.arguments.boot:
            return
        image = Image(self.arguments.boot)
        code = image.code()
        print("boot loader")
        total = sum(s.size for s in image.loaded_sections())
        print(f"  {'flash':<28}{total:>6,}  of {BOOT_FLASH:,} bytes: "
              f"{self.gate('flash of the boot loader', total, BOOT_FLASH, 'bytes')}")
        try:
            graph = CallGraph(image, code)
            bound = StackBound(image, code, graph,
                               read_frames(self.arguments.build, self.arguments.boot))
            start = {s.name: s.address for s in image.functions.values()}
            deepest, calls = bound.chain(start["hoof_boot"])
            for address, frame in calls:
                print(f"    {frame:>5}  {image.name_of(address)[:86]}")
            deepest += EXCEPTION_FRAME
            print(f"  {'stack, one fault entry':<28}{deepest:>6,}  of {BOOT_STACK:,} bytes: "
                  f"{self.gate('stack of the boot loader', deepest, BOOT_STACK, 'bytes')}")
        except StackError as error:
            self.missed.append(f"stack of the boot loader: {error}")
        self._forbidden(image, "boot loader")

    def files(self):
        print("files, SHA-256")
        for path in [self.arguments.elf, *self.arguments.bin]:
            with open(path, "rb") as file:
                print(f"  {hashlib.sha256(file.read()).hexdigest()}  {path}")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("elf")
    parser.add_argument("--build", required=True, help="folder with the compiler's .ci files")
    parser.add_argument("--boot", help="the boot loader's ELF file")
    parser.add_argument("--bin", nargs="*", default=[], help="files to print the hash of, too")
    parser.add_argument("--flash", type=int, default=128 * 1024, help="bound in bytes")
    parser.add_argument("--ram", type=int, default=64 * 1024, help="bound in bytes")
    parser.add_argument("--stack", type=int, default=4096, help="bound in bytes")
    try:
        report = Report(parser.parse_args())
    except (OSError, ValueError) as error:
        print(f"hoof firmware: {error}", file=sys.stderr)
        return 2
    for part in (report.flash, report.ram, report.stack, report.forbidden, report.boot,
                 report.files):
        part()
    for line in report.missed:
        print(f"hoof firmware: {line}", file=sys.stderr)
    return 1 if report.missed else 0


if __name__ == "__main__":
    sys.exit(main())
