"""Who calls whom in an image, read from its instructions: what the linker left out is out.

A call through a register goes to a known function where the register was loaded with a literal;
else, where it was loaded from a table at an offset, to any function that stands at that place of
any virtual table; else to every function whose address is anywhere in the image. A function whose
address is in the image outside virtual tables is always among the possible targets, too.
"""

import dataclasses
import re

from image import Image
from register_source import CALL, CONDITION, Flow

BRANCH = re.compile(rf"(?:bl|b|blx){CONDITION}?$")


@dataclasses.dataclass
class Node:
    name: str
    callees: set
    indirect: list  # (address of the call, number of possible targets)


class CallGraph:
    def __init__(self, image: Image, code):
        self._image = image
        self._code = code
        self._starts = sorted(code)
        self._vectors = self._extent("kVectorTable")
        self._constructors = self._extent_between("hoof_constructors_start",
                                                  "hoof_constructors_end")
        self._virtual_tables = [(s.address, s.size) for s in image.symbols
                                if s.name.startswith("_ZTV")]
        self._pointers, self._constructor_targets = self._find_addresses()
        self.nodes = {address: self._read(address) for address in code}

    def _extent(self, part_of_name):
        for symbol in self._image.symbols:
            if part_of_name in symbol.name and not symbol.is_function:
                return range(symbol.address, symbol.address + symbol.size)
        return range(0)

    def _extent_between(self, first, last):
        at = {s.name: s.address for s in self._image.symbols}
        return range(at[first], at[last]) if first in at and last in at else range(0)

    def vectors(self):
        """Addresses of the handlers, from reset on."""
        words = [self._image.word(a) for a in list(self._vectors)[4::4]]
        return [word & ~1 for word in words if word]

    def _find_addresses(self):
        """Functions whose address stands in the image, outside vectors and virtual tables; and
        those among the constructors of static objects."""
        tables = [range(a, a + size) for a, size in self._virtual_tables]
        pointers, constructors = set(), set()
        for address, word in self._image.words():
            if word % 2 == 0 or word - 1 not in self._code or address in self._vectors:
                continue
            if address in self._constructors:
                constructors.add(word - 1)
            elif not any(address in table for table in tables):
                pointers.add(word - 1)
        return pointers, constructors

    def _function_at(self, address):
        """The function that an address lies in."""
        for start in reversed(self._starts):
            if start <= address:
                return start
        return None

    def _virtual(self, slot=None):
        """Functions at one place of the virtual tables, or at any."""
        found = set()
        for table, size in self._virtual_tables:
            for at in range(table + 8, table + size, 4):  # behind offset and type
                word = self._image.word(at)
                if word and word % 2 and word - 1 in self._code:
                    if slot is None or at == table + 8 + 4 * slot:
                        found.add(word - 1)
        return found

    def _read(self, start):
        node = Node(self._image.name_of(start), set(), [])
        instructions = self._code[start]
        flow = Flow(instructions)
        for i, instruction in enumerate(instructions):
            mnemonic, operands = instruction.mnemonic, instruction.operands
            target = re.match(r"([0-9a-f]+) <", operands)
            if BRANCH.match(mnemonic) and target:
                callee = self._function_at(int(target[1], 16))
                if callee != start or CALL.match(mnemonic):
                    node.callees.add(callee)
                continue
            register = self._called_register(mnemonic, operands)
            if register is None or self._jumps_by_own_table(start, instructions, i):
                continue
            loads = [instruction] if register == "pc" else flow.sources(i, register)
            known, targets = self._resolve(start, loads)
            node.callees |= targets
            if not known:
                node.indirect.append((instruction.address, len(targets)))
        return node

    def _jumps_by_own_table(self, start, instructions, i):
        """Whether this is how a switch is compiled: `ldr pc` from a table of places in the same
        function, which stands right behind it."""
        table = re.search(r"pc, \[(r\d+), r\d+, lsl #2\]", instructions[i].operands)
        if not table or i == 0:
            return False
        base = re.match(rf"{table[1]}, pc, #\d+\s+@ \(adr {table[1]}, ([0-9a-f]+) ",
                        instructions[i - 1].operands)
        word = self._image.word(int(base[1], 16)) if base else None
        return word is not None and self._function_at(word & ~1) == start

    @staticmethod
    def _called_register(mnemonic, operands):
        """The register through which the instruction calls or jumps; "pc" where it loads it."""
        call = re.match(rf"(blx|bx){CONDITION}?$", mnemonic)
        if call:
            register = operands.split()[0]
            return None if register == "lr" and call[1] == "bx" else register
        if re.match(rf"mov{CONDITION}?$", mnemonic) and operands.startswith("pc, "):
            return operands.split()[1] if "lr" not in operands else None
        if mnemonic.startswith("ldr") and operands.startswith("pc, ") and "[sp]" not in operands:
            return "pc"
        return None

    def _resolve(self, start, loads):
        """@return whether the targets are known for certain, and the targets"""
        if self._image.name_of(start).endswith("run_constructors()"):
            return False, set(self._constructor_targets)
        if loads is None:
            return False, self._virtual() | self._pointers
        known, targets = True, set()
        for load in loads:
            one_known, some = self._loaded(load)
            known = known and one_known
            targets |= some
        return known, targets

    def _loaded(self, load):
        """What a register that was written by this instruction may point to."""
        literal = re.search(r"\[pc.*@ \(?([0-9a-f]+) <", load.operands)
        place = re.search(r"\[(?!pc|sp)\w+(?:, #(\d+))?\]$", load.operands)
        if load.mnemonic.startswith("ldr") and literal:
            word = self._image.word(int(literal[1], 16))
            if word and word % 2 and word - 1 in self._code:
                return True, {word - 1}
        elif load.mnemonic.startswith("ldr") and place:
            return False, self._virtual(int(place[1] or 0) // 4) | self._pointers
        return False, self._virtual() | self._pointers

    def cycle(self, root):
        """A path from the root that comes back to itself, as addresses; empty where there is none."""
        state, path = {}, []

        def visit(address):
            state[address] = "open"
            path.append(address)
            for callee in sorted(self.nodes[address].callees):
                if state.get(callee) == "open":
                    return path[path.index(callee):] + [callee]
                if callee not in state:
                    found = visit(callee)
                    if found:
                        return found
            path.pop()
            state[address] = "closed"
            return []

        return visit(root)
