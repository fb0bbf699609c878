"""Makes small mistakes in the engine, one at a time, and sees which test notices.

  scripts/find-faults mutants                           300 mutants, drawn at random from all places; goes on where it was stopped
  scripts/find-faults mutants --resume --stages own,rooms,proof,slow    asks those that are still alive by the other tests, too
  scripts/find-faults mutants --only core/session --count 40       of a file or a folder
  scripts/find-faults mutants --list --count 0          the places, without a run
  scripts/find-faults mutants --record                  writes results/trust/DATE-mutants.json from the file of results
  scripts/find-faults mutants --from results/trust/2026-12-01-mutants.json --stages room,own,rooms
                                           asks the survivors of a record without a reason once more, after tests were written for
                                           them; with --record, writes DATE-mutants-asked-again.json

A mutant flips a comparison, drops an error term or its factor, shifts an index, exchanges an operator or removes a statement
in core/ or in scenes/import, the readers of models (scripts/lib/mutations.py). It is built and tested in a copy of the working
tree below build-mutate, so no file of the working tree ever holds a mutant. The tests come in stages, and the first
test that fails ends the mutant:

  room    the tests of the mutant's room that take no longer than a second
  fuzz    the fuzz targets that use the room, on random input made from a fixed seed; of a header as part of `rooms`
  own     the tests of the mutant's room that take longer
  rooms   tests that are as quick, of the rooms of core and library above it
  proof   tests of bench/harness that hold the rules of core/soundness.md and plant errors, and `cscd verify`
  slow    the tests of the rooms above that take longer

Each result goes at once into build-mutate/mutants.jsonl, one JSON object a line. A mutant that is in the file is not tried again,
but a survivor without a reason is asked by stages that it has not seen. Results:

  killed        a test failed, crashed, or took too much memory; `by` names it
  timed out     a test did not end
  not compiled  the compiler refuses the mutant
  same code     the compiler makes the same code of the mutant, byte by byte, and so proves that nothing changed
  survived      all tests of `stages` passed

A mutant that --from kills by a stage that it had survived is marked `mended`: a test was written because of it. Reasons why a
survivor gives the same answers stand in scripts/lib/mutants.json.

Exit status: 0 the run is complete, 1 it was interrupted, 2 it could not run.
"""
import collections
import concurrent.futures
import json
import pathlib
import queue
import random
import re
import signal

from mutant_runner import RESULTS, Copy, Runner, stopping
from mutations import chosen, defined_macros, mutations_of
from records import read_json
from rooms import HELPER
from script import ROOT, parser_of, refuse
from tracked import tracked_files
from trust import reason_for, reasons_of, write_record

FOLDERS = ("core", "scenes/import")
STAGES = ("room", "fuzz", "own", "rooms", "proof", "slow")
SURVIVORS = ["file", "line", "becomes", "passed"]
EQUAL_LINE = re.compile(r" \(equal line (\d+) of the file\)$")


def read_results():
    """The newest result of each mutant, by its key."""
    results = {}
    if RESULTS.exists():
        for line in RESULTS.read_text().splitlines():
            entry = json.loads(line)
            results[entry["file"], entry["line"], entry["becomes"], entry["copy"]] = entry
    return results


def survivors_of(record):
    """The survivors of a record that have no reason, as results by key."""
    if record["kind"] != "mutants":
        refuse(f"--from needs a record of mutants, and this one is of {record['kind']}")
    results, reasons = {}, reasons_of("scripts/lib/mutants.json")
    for table in record["tables"]:
        if table["head"] != SURVIVORS:
            continue
        for row in table["rows"]:
            if reason_for(row, reasons):
                continue
            file, line, becomes, stages = row
            equal = EQUAL_LINE.search(line)
            copy = int(equal[1]) - 1 if equal else 0
            line = EQUAL_LINE.sub("", line)
            results[file, line, becomes, copy] = {"file": file, "line": line, "becomes": becomes, "copy": copy,
                                                  "result": "survived", "by": [], "stages": stages.split(", ")}
    return results


def all_places(only):
    macros = defined_macros(["g++", "-march=native"])
    for folder in FOLDERS:
        for path in tracked_files(folder):
            name = path.relative_to(ROOT).as_posix()
            is_asked = not only or any(path.is_relative_to(ROOT / one) for one in only)
            if is_asked and path.suffix in {".h", ".cpp"} and not HELPER.search(path.name):
                yield from mutations_of(name, path.read_text(), macros)


def named(line, copy):
    return line + (f" (equal line {copy + 1} of the file)" if copy else "")


def write(results, places, origin, only):
    """The record of all results whose places are still there; `origin` is the record whose survivors they are, and `only` the files and
    folders that were asked, or None."""
    known = {place.key: place for place in places}
    entries = [results[key] for key in results if key in known]
    tried = len(entries)
    count = collections.Counter("mended" if entry.get("mended") else entry["result"] for entry in entries)
    killed = count["killed"] + count["timed out"] + count["mended"]
    translated = tried - count["not compiled"] - count["same code"]

    def row(name, of):
        names = collections.Counter("mended" if entry.get("mended") else entry["result"] for entry in of)
        return [name, *(str(number) for number in (len(of), names["killed"], names["timed out"], names["mended"],
                                                  names["survived"], names["same code"], names["not compiled"]))]

    head = ["mutants", "killed", "timed out", "killed by a test that was written for it", "survived", "same code", "not compiled"]
    by_room, by_kind, by_test = (collections.defaultdict(list) for _ in range(3))
    for entry in entries:
        by_room[entry["file"].rpartition("/")[0]].append(entry)
        by_kind[entry["kind"]].append(entry)
        for name in entry["by"][:1]:
            by_test[name].append(entry)
    reasons = reasons_of("scripts/lib/mutants.json")
    survivors = sorted((e["file"], named(e["line"], e["copy"]), e["becomes"], ", ".join(e["stages"]))
                       for e in entries if e["result"] == "survived")
    explained = [list(row) for row in survivors if reason_for(row, reasons)]
    unexplained = [list(row) for row in survivors if not reason_for(row, reasons)]
    mended = sorted((e["file"], named(e["line"], e["copy"]), e["becomes"], e["by"][0]) for e in entries if e.get("mended"))
    write_record({
        "kind": "mutants" + ("-asked-again" if origin else ""),
        "title": "Mutants" + (" that were asked again" if origin else ""),
        "command": "scripts/find-faults mutants" + "".join(f" --only {name}" for name in only or [])
                   + (f" --from results/trust/{origin.name}" if origin else ""),
        "says": f"The mutants of `{origin.name}` that had survived without a reason, after tests were written for them." if origin
                else f"Small mistakes in {' and '.join(f'`{name}`' for name in only or FOLDERS)}, made one at a time at places that "
                     "were drawn at random, and the tests that notice them.",
        "headline": f"{killed} of {translated} mutants that change the program are found",
        "figures": [["places", len(places)], ["mutants tried", tried],
                    *([["not asked, because their code is gone", len(results) - tried]] if origin else []),
                    ["killed by a test", count["killed"]],
                    ["timed out in a test", count["timed out"]],
                    ["survived at first, killed by a test that was written for it", count["mended"]],
                    ["survived, with a reason", len(explained)],
                    ["survived the tests that were asked, without a reason yet", len(unexplained)],
                    ["the compiler makes the same code", count["same code"]],
                    ["not compiled", count["not compiled"]]],
        "tables": [
            {"title": "By room", "head": ["room", *head], "text_columns": 1,
             "rows": [row(room, by_room[room]) for room in sorted(by_room)]},
            {"title": "By kind of mistake", "head": ["kind", *head], "text_columns": 1,
             "rows": [row(kind, by_kind[kind]) for kind in sorted(by_kind)]},
            {"title": "Tests that were written for survivors", "head": ["file", "line", "becomes", "killed by"],
             "text_columns": 4, "rows": [list(entry) for entry in mended]},
            {"title": "Survivors", "head": SURVIVORS, "text_columns": 4,
             "rows": explained, "reasons": "scripts/lib/mutants.json"},
            {"title": "Survivors without a reason yet, by the stages of tests that they passed",
             "head": SURVIVORS, "text_columns": 4, "rows": unexplained},
            {"title": "Tests that noticed most", "head": ["test", "mutants"], "text_columns": 1,
             "rows": [[name, str(len(of))] for name, of in sorted(by_test.items(), key=lambda pair: (-len(pair[1]), pair[0]))[:20]]},
        ]})


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--list", action="store_true", help="print the chosen mutants; with --count 0, how many places there are")
    parser.add_argument("--only", action="append", help="a file or a folder; can be given several times")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=2014)
    parser.add_argument("--stages", default="room,fuzz", help="which of room,fuzz,own,rooms,proof,slow; default room,fuzz")
    parser.add_argument("--resume", action="store_true", help="try no new mutant: only survivors in the file, by further stages")
    parser.add_argument("--from", dest="origin", type=pathlib.Path, help="ask the survivors of this record that have no reason")
    parser.add_argument("--record", action="store_true", help="write the record of the file's results")
    parser.add_argument("--workers", type=int, default=2, help="copies of the working tree, one mutant each at a time")
    options = parser.parse_args()
    options.stages = options.stages.split(",")
    if unknown := set(options.stages) - set(STAGES):
        refuse(f"--stages does not know {', '.join(sorted(unknown))}; choose from {', '.join(STAGES)}")
    if missing := [name for name in options.only or [] if not (ROOT / name).exists()]:
        refuse(f"--only {missing[0]} is no file and no folder of the repository")
    places = list(all_places(options.only))
    wanted = chosen(places, options.count, random.Random(options.seed))
    if options.list:
        for mutation in wanted:
            print(f"{mutation.file}:{mutation.number}: {mutation.kind}\n  {mutation.line}\n  {mutation.becomes}")
        print(f"{len(wanted)} mutants of {len(places)} in {len({place.file for place in places})} files")
        return 0
    results = read_results()
    if options.origin:
        before = survivors_of(read_json(options.origin))
        results = {key: results.get(key, before[key]) for key in before}
    if options.record:
        write(results, places, options.origin, options.only)
        return 0
    if options.resume or options.origin:
        wanted = [place for place in places if place.key in results]
    todo, reasons = [], reasons_of("scripts/lib/mutants.json")
    for mutation in wanted:
        if mutation.key in results and reason_for([mutation.file, named(mutation.line, mutation.copy), mutation.becomes], reasons):
            continue
        old = results.get(mutation.key)
        survived = old is not None and old["result"] == "survived"
        if old is None or (survived and (options.origin or not set(options.stages) <= set(old["stages"]))):
            todo.append((mutation, old or {}))
    todo.sort(key=lambda task: task[0].file.endswith(".h"))  # a header takes longer, because more is compiled anew
    print(f"{len(wanted)} mutants, {len(todo)} of them to try", flush=True)
    signal.signal(signal.SIGINT, lambda *_: stopping.set())
    signal.signal(signal.SIGTERM, lambda *_: stopping.set())
    runner = Runner(options)
    runner.folder.mkdir(exist_ok=True)
    copies = queue.Queue()
    for i in range(options.workers):
        copies.put(Copy(runner.folder / str(i + 1)))
    with concurrent.futures.ThreadPoolExecutor(options.workers) as pool:
        for done in [pool.submit(runner.one, copies, *task) for task in todo]:
            done.result()
    return 1 if stopping.is_set() else 0
