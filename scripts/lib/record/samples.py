"""Times one program in six layouts, to show how often `cscd compare` errs on this machine.

  scripts/record samples BUILD --out samples.json.gz     BUILD is a ninja folder in which cscd is built
  CSCD_COMPARE_SAMPLES=samples.json.gz BUILD/bench_compare_test --gtest_filter='KeptSamples.*'

The second command draws comparisons from the samples and prints the rates: false reports in 200 comparisons of the program with
itself, and how often of 100 a stage that is 5 or 3 % slower is found. bench/compare/kept_samples.json.gz is such a file. In a
round each layout runs once, in an order drawn from the seed, with the options of scripts/compare-commits on the scene hand.
"""
import gzip
import json
import pathlib
import random
import shutil

from commits import FRAME_RANGE, OPTIONS
from layouts import link_layout
from script import answer_of, parser_of, refuse

LAYOUTS = 6
LEAST_ROUNDS = 20  # bench/compare/kept_samples_test.cpp draws 20 rounds of a layout
KEPT_ROWS = ("drvbc_fast", "drvbc_fast_complete")
TIMED = ["--scene", "hand", "--strategy", "drvbc,drvbc_fast,drvbc_fast_complete", *OPTIONS]
CONTACTS = ["--scene", "hand_contact", "--strategy", "base,drvbc_fast,drvbc_fast_complete", "--frames", FRAME_RANGE, "--time-every",
            "4", "--verify-every", "4", "--time-contacts", "1", "--repetitions", "2"]


def without_times(record):
    for row in record["strategies"]:
        row.pop("ms", None)
    return record


def main():
    parser = parser_of(__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=24, help=f"default 24, at least {LEAST_ROUNDS}")
    parser.add_argument("--seed", type=int, default=1, help="of the layouts and of their order in a round; default 1")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="where the samples go")
    options = parser.parse_args()
    if options.rounds < LEAST_ROUNDS:
        refuse(f"--rounds: at least {LEAST_ROUNDS}")
    if not (options.build / "cscd").exists():
        refuse(f"{options.build}: holds no cscd; build it there first")
    seeds = range(LAYOUTS * options.seed, LAYOUTS * (options.seed + 1))
    programs = {str(seed): link_layout(options.build, seed) for seed in seeds}
    order, processes, common = random.Random(options.seed), [], None
    contacts = without_times(answer_of(options.build / "cscd", "run", *CONTACTS))
    for number in range(options.rounds):
        for layout in order.sample(sorted(programs), LAYOUTS):
            record = answer_of(programs[layout], "run", *TIMED)
            kept = {row["name"]: row["ms"] for row in record["strategies"] if row["name"] in KEPT_ROWS}
            environment = record["environment"]
            processes.append({"layout": layout, "round": number, "date": environment["date"],
                              "load": environment["load_average"][0], "ms": kept})
            common = common or without_times(record)
        print(f"round {number + 1} of {options.rounds}, load {processes[-1]['load']:.1f}", flush=True)
    common["strategies"] = [row for row in common["strategies"] if row["name"] in KEPT_ROWS]
    document = json.dumps({"record": common, "contacts": contacts, "processes": processes}).encode()
    options.out.write_bytes(gzip.compress(document, mtime=0))
    for program in programs.values():
        shutil.rmtree(program.parent, ignore_errors=True)
