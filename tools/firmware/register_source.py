"""Where a register's value may come from, at one instruction of a function: backwards along every
path to the instructions that wrote it."""

import re

CONDITION = r"(?:eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le|hs|lo)"
JUMP = re.compile(rf"(?:b{CONDITION}?|cbn?z)$")
NO_WAY_ON = re.compile(r"(?:b|bx|udf)$")
CALL = re.compile(r"blx?$|bl[a-z]{2}$")  # not blt, ble, bls: branches on a condition
CHANGED_BY_CALLS = ("r0", "r1", "r2", "r3", "ip", "lr")
# These leave their first operand alone.
WRITES_NOTHING = re.compile(r"(cmp|cmn|tst|teq|str|push|b|cb|it|nop|v|stm|dsb|isb|cps|msr)")


def jump_target(instruction):
    found = re.search(r"\b([0-9a-f]+) <", instruction.operands)
    return int(found[1], 16) if found else None


def writes(instruction, register):
    """Whether the instruction may change the register."""
    mnemonic, operands = instruction.mnemonic, instruction.operands
    if CALL.match(mnemonic):
        return register in CHANGED_BY_CALLS
    if mnemonic == "pop" or mnemonic.startswith("ldm"):
        return True  # perhaps; what a register list spans is not looked at
    if mnemonic.startswith(("ldrd", "umull", "smull", "umlal", "smlal")):
        return register in re.findall(r"\w+", operands)[:2]
    if re.search(rf"\[{register}, #-?\d+\]!|\[{register}\], #", operands):
        return True
    if mnemonic.startswith("vmov"):
        return operands.startswith(register + ",")
    return not WRITES_NOTHING.match(mnemonic) and operands.startswith(register + ",")


class Flow:
    """The instructions of one function, each with those that may run right before it."""

    def __init__(self, instructions):
        self._instructions = instructions
        index = {each.address: i for i, each in enumerate(instructions)}
        self._before = [[] for _ in instructions]
        self._jumps_by_table = any(each.mnemonic in ("tbb", "tbh") or
                                   re.match(r"(mov|add|ldr).* pc,", f"{each.mnemonic} "
                                            f"{each.operands}") for each in instructions)
        for i, each in enumerate(instructions):
            target = jump_target(each) if JUMP.match(each.mnemonic) else None
            if target in index:
                self._before[index[target]].append(i)
            if not NO_WAY_ON.match(each.mnemonic) and i + 1 < len(instructions):
                self._before[i + 1].append(i)

    def sources(self, at, register):
        """The instructions that may have written the register before instruction number `at`, or
        None where it may have come from outside the function or by ways unknown."""
        if self._jumps_by_table:
            return None
        found, seen, to_do = [], set(), [at]
        while to_do:
            i = to_do.pop()
            if not self._before[i]:
                return None  # the function's entry, or a place nothing is seen to lead to
            for earlier in self._before[i]:
                if earlier in seen:
                    continue
                seen.add(earlier)
                each = self._instructions[earlier]
                if writes(each, register):
                    found.append(each)
                    if not re.match(rf"(ldr|mov){CONDITION}$", each.mnemonic):
                        continue  # written for certain
                if earlier == 0:
                    return None
                to_do.append(earlier)
        return found
