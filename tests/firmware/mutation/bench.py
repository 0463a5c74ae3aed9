"""Builds a mutant into the safety tests and runs them."""

import os
import re
import shutil
import subprocess

KILLED, SURVIVED, NOT_COMPILING = "killed", "survived", "not compiling"

_FLAGS = ["-std=c++20", "-O0", "-g0", "-w", "-ffp-contract=off", "-fno-math-errno"]
_LONGEST_RUN_S = 30       # the whole suite takes two on an idle core
_NUMBERS = "limits_test"  # states each compiled number once more
_SLOW = "[slow]"          # tests that are asked only when all others have passed


class Bench:
    """Objects of the tests as the build made them, those of the safety code as built here.

    A mutant of a .cpp needs one unit compiled. A mutant of a header first meets the header's own
    test alone, then that of all numbers, compiled with it; should they pass, all that includes the
    header is built anew.
    """

    def __init__(self, plan, folder):
        self.plan = plan
        self.root = plan["root"]
        self.folder = folder
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        self.tests = {os.path.basename(o).split(".")[0]: o for o in plan["test_objects"]}
        self.units = {}
        for path in plan["sources"]:
            self.units[path] = os.path.join(folder, _name(path) + ".o")
            _must(self._compiler(self.root) + ["-c", self._full(path), "-o", self.units[path]])
        self.includes = {path: self._includes_of(path) for path in self._all_files()}
        self.catch = os.path.join(folder, "catch.h")
        with open(self.catch, "w") as file:
            file.write("#include <catch2/catch.hpp>\n")
        _must(self._compiler(self.root) + ["-x", "c++-header", self.catch, "-o",
                                           self.catch + ".gch"])

    def passes_unbroken(self):
        program = os.path.join(self.folder, "unbroken")
        self._link(list(self.tests.values()), list(self.units.values()), program)
        return self._run(program) == SURVIVED

    def judge(self, mutant, text, slot):
        """Runs one mutant in the folder of the worker `slot`."""
        place = os.path.join(self.folder, f"worker-{slot}")
        shutil.rmtree(place, ignore_errors=True)
        broken = os.path.join(place, mutant.path)
        os.makedirs(os.path.dirname(broken))
        with open(broken, "w") as file:
            file.write(text[:mutant.start] + mutant.replacement + text[mutant.end:])
        if mutant.path.endswith(".h"):
            return self._judge_header(mutant, place)
        unit = os.path.join(place, "broken.o")
        if not _call(self._compiler(self.root) + ["-c", broken, "-o", unit]):
            return NOT_COMPILING
        units = [unit] + [o for path, o in self.units.items() if path != mutant.path]
        return self._link_and_run(self._own_first(mutant.path), units, place)

    def _judge_header(self, mutant, place):
        for own in dict.fromkeys((_name(mutant.path) + "_test", _NUMBERS)):
            if own not in self.tests:
                continue
            test = self._rebuild(f"{self.plan['tests']}/{own}.cpp", place)
            if test is None:
                return NOT_COMPILING
            if self._link_and_run([], [test] + list(self.units.values()), place) == KILLED:
                return KILLED
        units = []
        for path, built in self.units.items():
            if mutant.path in self.includes[path]:
                built = self._rebuild(path, place)
            units.append(built)
        if None in units:
            return NOT_COMPILING
        tests = []
        for name, built in self._own_first(mutant.path, names=True):
            path = f"{self.plan['tests']}/{name}.cpp"
            tests.append(self._rebuild(path, place) if mutant.path in self.includes[path] else built)
        if None in tests:
            return NOT_COMPILING
        return self._link_and_run(tests, units, place)

    def _own_first(self, path, names=False):
        own = _name(path) + "_test"
        ordered = sorted(self.tests.items(), key=lambda item: item[0] != own)
        return ordered if names else [built for _, built in ordered]

    def _rebuild(self, path, place):
        """Compiles a unit or a test against the broken header in `place`."""
        built = os.path.join(place, _name(path) + ".o")
        catch = ["-include", self.catch] if path.endswith("_test.cpp") else []
        done = _call(self._compiler(place, self.root) + catch + ["-c", self._full(path), "-o", built])
        return built if done else None

    def _link_and_run(self, tests, units, place):
        program = os.path.join(place, "broken")
        self._link(tests, units, program)
        return self._run(program)

    def _link(self, tests, units, program):
        # Of an inline function or constant the linker keeps the copy that it meets first.
        _must([self.plan["compiler"], *units, *tests, *self.plan["libraries"], "-o", program])

    def _run(self, program):
        """Tests that fail, crash or do not end have killed."""
        for which in ("~" + _SLOW, _SLOW):
            try:
                done = subprocess.run([program, which, "--abort"],
                                      timeout=_LONGEST_RUN_S, stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL, check=False)
            except subprocess.TimeoutExpired:
                return KILLED
            if done.returncode != 0:
                return KILLED
        return SURVIVED

    def _compiler(self, *folders):
        return [self.plan["compiler"], *_FLAGS, *[f"-I{folder}" for folder in folders]]

    def _full(self, path):
        return os.path.join(self.root, path)

    def _all_files(self):
        tests = [f"{self.plan['tests']}/{name}.cpp" for name in self.tests]
        return tests + list(self.plan["sources"])

    def _includes_of(self, path):
        """All files of ours that this one includes, directly or not."""
        found, waiting = set(), [path]
        while waiting:
            with open(self._full(waiting.pop())) as file:
                for included in re.findall(r'#include "([^"]+)"', file.read()):
                    if included not in found:
                        found.add(included)
                        waiting.append(included)
        return found


def _name(path):
    return os.path.splitext(os.path.basename(path))[0]


def _call(command):
    return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          check=False).returncode == 0


def _must(command):
    subprocess.run(command, check=True)
