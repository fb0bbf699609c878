"""Kills workers of a divided run at random moments, lets others go on, and compares the record with that of an undisturbed run.

  scripts/find-faults kills [CYCLES]            so many cycles, default 200
  scripts/find-faults kills --record [CYCLES]   adds the figures to results/trust

A cycle gives the shards of one run (`cscd run --shards`) to one to three workers, kills them with SIGKILL after a random time, one to
three times over, and lets the command finish without workers. After each kill every result that has its name has to be whole, and the
record at the end has to equal the undisturbed one byte by byte. Builds the program first; 200 cycles take a few minutes.
Exit status: 0 all equal, 1 something differs, 2 it could not run.
"""
import gzip
import json
import pathlib
import random
import subprocess
import tempfile
import time

from script import ROOT, build, install, parser_of, refuse
from trust import write_record

BUILD = "build-release"
RUN = ("run", "--scene", "urchin", "--frames", "100:110", "--strategy", "base,drvbc", "--counts", "--shard-intervals", "2")
SEED = 2014  # of workers, moments and numbers of kills


def start(folder, worker):
    return subprocess.Popen([ROOT / BUILD / "cscd", *RUN, "--shards", folder, *worker], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def finish(folder):
    """Measures what is missing, and joins all shards; the bytes of the record."""
    record = folder.parent / f"{folder.name}.json"
    process = start(folder, ["--json", record])
    errors = process.communicate()[1].decode(errors="replace").strip()
    if process.returncode != 0:
        refuse(f"cscd {' '.join(RUN)} ended with status {process.returncode}: {errors}")
    return record.read_bytes()


def broken_results(folder):
    """Names of results that are not whole, and why."""
    for path in sorted(folder.glob("*.json*")):
        try:
            data = path.read_bytes()
            json.loads(gzip.decompress(data) if path.suffix == ".gz" else data)
        except (OSError, EOFError, ValueError) as error:
            yield f"{path.name}: {error}"


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--record", action="store_true")
    parser.add_argument("cycles", type=int, nargs="?", default=200)
    options = parser.parse_args()
    if options.cycles < 1:
        refuse(f"{options.cycles} cycles; give at least 1")
    install("build")
    build(BUILD, "release", "cscd")
    draw = random.Random(SEED)
    kills = at_work = partly_done = broken = differ = 0
    with tempfile.TemporaryDirectory(prefix="kills-") as scratch:
        scratch, began = pathlib.Path(scratch), time.monotonic()
        truth = finish(scratch / "undisturbed")
        whole, shards = time.monotonic() - began, len(list((scratch / "undisturbed").glob("*.json*")))
        for cycle in range(options.cycles):
            folder = scratch / f"cycle-{cycle}"
            for _ in range(draw.randint(1, 3)):
                count = draw.randint(1, 3)
                workers = [start(folder, ["--worker", f"{i + 1}/{count}"]) for i in range(count)]
                time.sleep(draw.uniform(0, whole))
                for worker in workers:
                    at_work += worker.poll() is None
                    worker.kill()
                kills += count
                for worker in workers:
                    worker.communicate()
                partly_done += 0 < len(list(folder.glob("*.json*"))) < shards
                for text in broken_results(folder):
                    broken += 1
                    print(f"cycle {cycle}: not whole: {text}")
            if finish(folder) != truth:
                differ += 1
                print(f"cycle {cycle}: the record differs")
    figures = [["cycles", options.cycles], ["shards of the run", shards], ["workers killed", kills], ["killed at work", at_work],
               ["times that some of the shards had results", partly_done], ["results that were not whole", broken],
               ["records that differ", differ]]
    print("\n".join(f"{name}: {number}" for name, number in figures))
    if options.record:
        write_record({
            "kind": "kill-cycles", "title": "Workers killed and work resumed",
            "says": "Workers of a run in shards are killed with SIGKILL at random moments, and the same command without workers finishes. "
                    "Every result that has its name has to be whole, and the record has to equal that of an undisturbed run byte by byte.",
            "command": f"scripts/find-faults kills --record {options.cycles}",
            "headline": f"{differ} records differ in {options.cycles} cycles, {kills} workers killed", "figures": figures, "tables": []})
    return 1 if differ or broken else 0
