"""The deepest stack an image can need: the compiler's frames along the longest chain of calls."""

import glob
import os
import re

# The core pushes 26 words on entry of an exception that interrupts floating point, and one more to
# align (ARM DDI 0403E, B1.5.7).
EXCEPTION_FRAME = 27 * 4


class StackError(Exception):
    """No bound can be given."""


def read_frames(build_folder, elf):
    """Frames as the compiler states them (-fcallgraph-info=su), by mangled name. What was linked as
    one (NAME.elf.ltrans...) counts for that image alone: others may be of another day."""
    frames = {}
    for path in sorted(glob.glob(f"{build_folder}/**/*.ci", recursive=True)):
        linked, is_linked, _ = os.path.basename(path).partition(".ltrans")
        if is_linked and linked != os.path.basename(elf):
            continue
        with open(path, encoding="utf-8") as file:
            text = file.read()
        for title, size, kind in re.findall(
                r'node: \{ title: "([^"]*)" label: "[^"]*?(\d+) bytes \(([a-z,]+)\)', text):
            name = title.rsplit(":", 1)[-1]
            if kind == "dynamic":
                frames[name] = None
            elif frames.get(name, 0) is not None:
                frames[name] = max(frames.get(name, 0), int(size))
    return frames


def depth_of(instructions):
    """How deep the instructions of one function push, read in their order: an early return pops,
    so the count never goes below what came before it by more than was pushed."""
    depth = deepest = 0
    for each in instructions:
        operands = each.operands
        count = 0
        listed = re.search(r"\{(.*)\}", operands)
        if listed:
            for part in listed[1].split(","):
                ends = re.findall(r"\d+", part)
                count += int(ends[1]) - int(ends[0]) + 1 if "-" in part and len(ends) == 2 else 1
        if each.mnemonic == "push" or (each.mnemonic in ("stmdb", "stmfd") and
                                       operands.startswith("sp!")):
            depth += 4 * count
        elif each.mnemonic == "vpush":
            depth += (8 if "d" in operands else 4) * count
        elif re.match(r"subw?$", each.mnemonic) and re.match(r"sp,", operands):
            amount = re.search(r"#(\d+)", operands)
            if not amount:
                return None  # as much as a register says
            depth += int(amount[1])
        elif each.mnemonic in ("str", "strd") and re.search(r"\[sp, #-(\d+)\]!", operands):
            depth += int(re.search(r"\[sp, #-(\d+)\]!", operands)[1])
        deepest = max(deepest, depth)
    return deepest


class StackBound:
    def __init__(self, image, code, graph, frames):
        self._image = image
        self._graph = graph
        self._frames = {address: self._frame(address, code[address], frames) for address in code}
        self._deepest = {}

    def _frame(self, address, instructions, frames):
        """The compiler's figure; for libraries, and should it be smaller, what the code pushes."""
        pushed = depth_of(instructions)
        names = [s.name for s in self._image.symbols if s.is_function and s.address == address]
        stated = [frames[name] for name in names if name in frames]
        if None in stated or (pushed is None and not stated):
            return None
        return max(stated) if stated else pushed

    def chain(self, root):
        """@return the bytes, and the functions with their frames, of the deepest chain of calls"""
        loop = self._graph.cycle(root)
        if loop:
            raise StackError("recursion: " + " -> ".join(self._image.name_of(a) for a in loop))
        return self._walk(root)

    def _walk(self, address):
        if address not in self._deepest:
            frame = self._frames[address]
            if frame is None:
                raise StackError(f"a frame without bound: {self._image.name_of(address)}")
            chains = [self._walk(c) for c in self._graph.nodes[address].callees]
            below, calls = max(chains, key=lambda c: c[0], default=(0, []))
            self._deepest[address] = (frame + below, [(address, frame)] + calls)
        return self._deepest[address]
