#!/usr/bin/env python3
"""Breaks the safety code in one place after another and asks whether its tests notice.

Every relation, connective, arithmetic operator, sign, number, truth value, condition, bound,
statement, return value and case label of firmware/safety is changed, one at a time; each mutant is
compiled and the safety tests run over it. A mutant that no test notices must stand in
equivalent.txt with the reason why nobody could; a reason that no longer fits is an error, too.

  mutate.py PLAN.json                        all mutants (the build writes the plan)
  mutate.py PLAN.json --only heat.cpp        those of one file
  mutate.py PLAN.json --shard 0/4            every fourth
  mutate.py PLAN.json --list --only heat.cpp what would be done

Exit status: 0 no survivor without a reason; 1 survivors or stale reasons; 2 wrong usage, or the
tests fail on the code as it is.
"""

import argparse
import json
import os
import queue
import resource
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import bench
from cpp_source import Source
from operators import mutants_of


def key_of(mutant):
    """What names a mutant in equivalent.txt: nothing that a new line elsewhere would change."""
    again = f" (line {mutant.repeat + 1} of its kind)" if mutant.repeat else ""
    return (os.path.basename(mutant.path), mutant.line + again, mutant.what)


def read_reasons(path):
    """Blocks of four lines, `file:`, `line:`, `change:`, `reason:` (which may go on over more)."""
    reasons, entry, field = {}, {}, None

    def close():
        if not entry:
            return
        if set(entry) != {"file", "line", "change", "reason"}:
            sys.exit(f"mutate: {path}: an entry has {sorted(entry)}, not file, line, change, reason")
        reasons[entry["file"], entry["line"], entry["change"]] = entry["reason"]
        entry.clear()

    with open(path) as file:
        for line in file:
            line = line.rstrip("\n")
            if not line.strip():
                close()
            elif not line.startswith("#"):
                name, separator, value = line.partition(": ")
                if separator and not line.startswith(" "):
                    field = name
                    entry[field] = value
                else:
                    entry[field] += " " + line.strip()
    close()
    return reasons


def judge_all(mutants, texts, the_bench, jobs, argued):
    """The verdict on each mutant, in the order given."""
    slots = queue.Queue()
    for slot in range(jobs):
        slots.put(slot)

    def judge(mutant):
        slot = slots.get()
        try:
            return the_bench.judge(mutant, texts[mutant.path], slot)
        finally:
            slots.put(slot)

    verdicts = []
    with ThreadPoolExecutor(jobs) as workers:
        for mutant, verdict in zip(mutants, workers.map(judge, mutants)):
            verdicts.append(verdict)
            if verdict == bench.SURVIVED and key_of(mutant) not in argued:
                print_entry(f"SURVIVED {mutant.path}:{mutant.number}", key_of(mutant))
            if len(verdicts) % 100 == 0:
                print(f"{len(verdicts)} of {len(mutants)} done", flush=True)
    return verdicts


def print_entry(head, key):
    """As it would stand in equivalent.txt."""
    print("{}\nfile: {}\nline: {}\nchange: {}\n".format(head, *key), flush=True)


def print_table(mutants, verdicts, argued):
    print(f"{'file':22}{'mutants':>9}{'killed':>9}{'equivalent':>12}{'survivors':>11}"
          f"{'not compiling':>15}")
    names = sorted({os.path.basename(m.path) for m in mutants})
    for name in names + ["all"]:
        rows = [(m, v) for m, v in zip(mutants, verdicts)
                if name in ("all", os.path.basename(m.path))]
        counts = [sum(v == bench.KILLED for _, v in rows),
                  sum(v == bench.SURVIVED and key_of(m) in argued for m, v in rows),
                  sum(v == bench.SURVIVED and key_of(m) not in argued for m, v in rows)]
        broken = sum(v == bench.NOT_COMPILING for _, v in rows)
        print(f"{name:22}{len(rows) - broken:9}{counts[0]:9}{counts[1]:12}{counts[2]:11}"
              f"{broken:15}")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plan", help="written by the build: compiler, sources, objects")
    parser.add_argument("--only", help="a file name, for instance heat.cpp")
    parser.add_argument("--shard", default="0/1", help="K/N: every N-th mutant, from the K-th")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--list", action="store_true", help="name the mutants, run none")
    return parser.parse_args()


def main():
    options = arguments()
    with open(options.plan) as file:
        plan = json.load(file)
    everything = []
    texts = {}
    for path in plan["files"]:
        with open(os.path.join(plan["root"], path)) as file:
            texts[path] = file.read()
        everything += mutants_of(Source(path, texts[path]))
    assert len({key_of(m) for m in everything}) == len(everything), "two mutants of one name"
    reasons = read_reasons(os.path.join(os.path.dirname(__file__), "equivalent.txt"))
    stale = [key for key in reasons if key not in {key_of(m) for m in everything}]

    part, parts = map(int, options.shard.split("/"))
    chosen = [m for m in everything if options.only in (None, os.path.basename(m.path))][part::parts]
    if options.list:
        for m in chosen:
            print(f"{m.path}:{m.number}: {m.what}   in   {m.line}")
        return 0

    start_s = time.monotonic()
    the_bench = bench.Bench(plan, plan["folder"])
    if not the_bench.passes_unbroken():
        print("mutate: the tests fail on the code as it is", file=sys.stderr)
        return 2
    verdicts = judge_all(chosen, texts, the_bench, options.jobs, reasons)

    survivors = [m for m, v in zip(chosen, verdicts)
                 if v == bench.SURVIVED and key_of(m) not in reasons]
    stale += [key_of(m) for m, v in zip(chosen, verdicts)
              if v != bench.SURVIVED and key_of(m) in reasons]
    for key in stale:
        print_entry("STALE reason in equivalent.txt: no such mutant, or a test kills it", key)
    print_table(chosen, verdicts, reasons)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{time.monotonic() - start_s:.0f} s by the clock with {options.jobs} at a time, "
          f"{used.ru_utime + used.ru_stime:.0f} s of processor time")
    return 1 if survivors or stale else 0


if __name__ == "__main__":
    sys.exit(main())
