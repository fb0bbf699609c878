"""Makes small mistakes in the engine, one at a time, and sees which test notices.

  scripts/find-faults mutants                           300 mutants, drawn at random from all places; goes on where it was stopped
  scripts/find-faults mutants --resume --stages own,rooms,proof,slow    asks those that are still alive by the other tests, too
  scripts/find-faults mutants --only core/fast/certify/stars.cpp --count 40
  scripts/find-faults mutants --list --count 0          the places, without a run
  scripts/find-faults mutants --record                  writes results/trust/DATE-mutants.json from the file of results
  scripts/find-faults mutants --from results/trust/2026-11-26-mutants-2.json --stages room,own,rooms
                                           asks the survivors of a record without a reason once more, after tests were written for
                                           them; with --record, writes DATE-mutants-asked-again.json

A mutant flips a comparison, drops an error term or its factor, shifts an index, exchanges an operator or removes a statement
in core/geometry, core/elementary or core/fast (scripts/lib/mutations.py). It is built and tested in a copy of the working
tree below build-mutate, so no file of the working tree ever holds a mutant. The tests come in stages, and the first
test that fails ends the mutant:

  room    the tests of the mutant's room that take no longer than a second
  fuzz    the fuzz targets that use the room, on random input made from a fixed seed; of a header as part of `rooms`
  own     the tests of the mutant's room that take longer
  rooms   tests that are as quick, of the rooms of core and library above it
  proof   tests of bench/measure/replay that hold the rules of core/soundness.md and plant errors, and `cscd verify`
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
import hashlib
import json
import os
import pathlib
import queue
import random
import re
import resource
import selectors
import signal
import subprocess
import threading
import time

from mutations import chosen, defined_macros, mutated, mutations_of
from records import read_json
from rooms import HELPER, above, closure, read_rooms, test_programs
from script import ROOT, parser_of, refuse
from tracked import tracked_files
from trust import moved, reason_for, reasons_of, write_record

FOLDERS = ("core/geometry", "core/elementary", "core/fast")
STAGES = ("room", "fuzz", "own", "rooms", "proof", "slow")
FUZZ = {"fuzz_engine_replay": 150, "fuzz_elementary_replay": 1000, "fuzz_queries_replay": 1000}  # inputs of each
FLAGS = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_COMPILER=g++", "-DCMAKE_C_COMPILER=gcc", "-DCSCD_NATIVE=ON",
         "-DCSCD_VIEWER=OFF", "-DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST",
         # A mutant may leave a variable unused, and an index outside of its array has to show.
         "-DCMAKE_CXX_FLAGS=-w -D_GLIBCXX_ASSERTIONS", "-DCMAKE_CXX_FLAGS_RELEASE=-O1"]
SURVIVORS = ["file", "line", "becomes", "passed"]
EQUAL_LINE = re.compile(r" \(equal line (\d+) of the file\)$")
FUZZ_TARGET = re.compile(r"^cscd_fuzz_target\((\w+) \d+ ([\w/ ]+)\)", re.M)
PROOFS = "Rules.*:Saboteurs.*:HardMeshes.*:PlantedTruth.*:RandomVerification.EveryStrategy*"
VERIFY = ["verify", "--intervals", "400"]
MEMORY = 6 << 30
RESULTS = ROOT / "build-mutate" / "mutants.jsonl"
QUICK = 1  # seconds that a quick test takes at most
QUICK_LIMIT, SLOW_LIMIT = 120, 900  # seconds for the quick tests of one program, and for the slow ones

stopping = threading.Event()


class Interrupted(Exception):
    pass


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def call(words, folder, seconds, on_line=lambda line: None, limited=True):
    """(exit status, lines); the exit status is None where the time was over. `on_line` may return True to end the program."""
    process = subprocess.Popen([str(word) for word in words], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, start_new_session=True, preexec_fn=limit_memory if limited else None)
    lines, rest, end, ended_here = [], b"", time.monotonic() + seconds, False
    with selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)
        open_pipe = True
        while open_pipe and not ended_here:
            if stopping.is_set() or time.monotonic() > end:
                ended_here = True
            elif selector.select(0.2):
                data = os.read(process.stdout.fileno(), 1 << 16)
                open_pipe = bool(data)
                *whole, rest = (rest + data).split(b"\n")
                for line in whole:
                    lines.append(line.decode(errors="replace"))
                    ended_here = bool(on_line(lines[-1])) or ended_here
            else:
                ended_here = bool(on_line(None))
    if ended_here:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
    process.stdout.close()
    status = process.wait()
    if stopping.is_set():
        raise Interrupted
    return (None if ended_here else status), lines


class Copy:
    """A copy of the working tree with a build of its own."""

    def __init__(self, folder):
        self.source, self.binaries = folder / "source", folder / "build"
        self.whole = {}  # hash of each program without a mutation
        self.refresh()
        if not (self.binaries / "build.ninja").exists():
            status, lines = call(["cmake", "-S", self.source, "-B", self.binaries, "-G", "Ninja", *FLAGS], ROOT, 600, limited=False)
            if status != 0:
                refuse("cmake fails:\n" + "\n".join(lines[-20:]))

    def refresh(self):
        """Copies what differs, so that only that is compiled anew."""
        names = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "-co", "--exclude-standard", "CMakeLists.txt", "LICENSE",
                                "README.md", "core", "library", "baselines", "bench", "scenes", "scripts", "fuzz", "page"],
                               capture_output=True, check=True).stdout.decode().split("\0")
        wanted = {name for name in names if name and (ROOT / name).is_file()}
        for name in wanted:
            to, content = self.source / name, (ROOT / name).read_bytes()
            if not to.exists() or to.read_bytes() != content:
                to.parent.mkdir(parents=True, exist_ok=True)
                to.write_bytes(content)
                to.chmod((ROOT / name).stat().st_mode)
        for path in [path for path in self.source.rglob("*") if path.is_file()]:
            if path.relative_to(self.source).as_posix() not in wanted and "__pycache__" not in path.parts:
                path.unlink()

    def make(self, targets):
        """None, or what the compiler says."""
        if not targets:  # ninja would make everything
            return None
        status, lines = call(["ninja", "-C", self.binaries, "-j", 1, *targets], ROOT, 3600, limited=False)
        return None if status == 0 else lines

    def hash(self, target):
        return hashlib.sha256((self.binaries / target).read_bytes()).hexdigest()

    def changed(self, target):
        return self.hash(target) != self.whole[target]

    def prepare(self, targets):
        missing = [target for target in targets if target not in self.whole]
        if missing:
            errors = self.make(missing)
            if errors:
                refuse("the copy without a mutation does not build:\n" + "\n".join(errors[-20:]))
            self.whole.update({target: self.hash(target) for target in missing})


def run_gtest(copy, target, chosen_tests, seconds):
    """Runs tests of a program: (None, []) where they pass, or ("killed" or "timed out", names)."""
    failed, running = [], []

    def watch(line):
        found = re.match(r"\[ +(RUN|OK|FAILED|SKIPPED) +\] (\S+?)(?:,.*| \(.*)?$", line or "")
        if found:
            word, name = found.groups()
            running[:] = [name] if word == "RUN" else []
            if word == "FAILED" and "." in name and name not in failed:
                failed.append(name)
        return bool(failed)  # one is enough
    status, _ = call([copy.binaries / target, f"--gtest_filter={chosen_tests}"], ROOT, seconds, watch)
    if failed:
        return "killed", failed
    if status is None:
        return "timed out", running or [target]
    return (None, []) if status == 0 else ("killed", [f"{name} (crashed)" for name in running] or [target])


def measure(copy, target, times):
    """Adds to `times` the seconds of each test that it lacks; None where a test takes much longer than a quick one."""
    status, lines = call([copy.binaries / target, "--gtest_list_tests"], ROOT, 60)
    if status != 0:
        refuse(f"{target} does not list its tests")
    suite, names = "", []
    for line in lines:
        if line.startswith("  "):
            names.append(suite + line.split("#")[0].strip())
        elif line and not line.startswith("Running"):
            suite = line.split("#")[0].strip()
    for gone in times.keys() - set(names):
        del times[gone]
    while rest := [name for name in names if name not in times]:
        running = []

        def watch(line):
            found = re.match(r"\[ +(RUN|OK|FAILED|SKIPPED) +\] (\S+?)(?:,.*| \((\d+) ms\))?$", line or "")
            if found and found[1] == "RUN":
                running[:] = [found[2], time.monotonic()]
            elif found:
                if found[1] == "FAILED":
                    refuse(f"{target}: {found[2]} fails without a mutation")
                times[found[2]] = int(found[3] or 0) / 1000
                running.clear()
            if running and time.monotonic() - running[1] > 3 * QUICK:
                times[running[0]] = None
                return True
            return False
        known = len(times)
        call([copy.binaries / target, "--gtest_filter=" + ":".join(rest)], ROOT, 3600, watch)
        if len(times) == known:
            refuse(f"{target} ends before its tests do")


class Runner:
    def __init__(self, options):
        self.options = options
        self.rooms = read_rooms(ROOT / "CMakeLists.txt")
        self.folder = ROOT / "build-mutate"
        self.measured = set()  # programs whose tests all have times
        self.lock, self.measuring = threading.Lock(), threading.Lock()
        self.times_file = self.folder / "times.json"
        self.times = json.loads(self.times_file.read_text()) if self.times_file.exists() else {}

    def targets(self, file):
        """Test programs for a file: of its room first, then of rooms above it, bottom-up."""
        own = file.rpartition("/")[0]
        return test_programs([own, *above(self.rooms, own)])

    def filters(self, target):
        quick = [name for name, seconds in self.times[target].items()
                 if seconds is not None and seconds <= QUICK]
        slow = [name for name in self.times[target] if name not in quick]
        return {"quick": ":".join(quick), "slow": ":".join(slow)}

    def measure_all(self, copy, targets):
        for target in targets:
            with self.measuring:
                if target not in self.measured:
                    measure(copy, target, self.times.setdefault(target, {}))
                    self.measured.add(target)
                    self.times_file.write_text(json.dumps(self.times, indent=1) + "\n")

    def fuzz_programs(self, file):
        """Fuzz targets that use a file's room, as CMakeLists.txt says."""
        room = file.rpartition("/")[0]
        for name, rooms in FUZZ_TARGET.findall((ROOT / "CMakeLists.txt").read_text()):
            if f"fuzz_{name}_replay" in FUZZ and room in closure(self.rooms, rooms.split()):
                yield f"fuzz_{name}_replay"

    def steps(self, file):
        """(stage, programs) in the order in which they are asked."""
        own, *others = self.targets(file)
        fuzz = list(self.fuzz_programs(file))
        if file.endswith(".h"):  # most files above it are compiled anew for both
            others, fuzz = [*fuzz, *others], []
        return [("room", [own]), ("fuzz", fuzz), ("own", [own]), ("rooms", others),
                ("proof", ["bench_measure_replay_test", "cscd"]), ("slow", self.targets(file)[1:])]

    def ask(self, copy, stage, program):
        """What run_gtest() returns, of a program that a mutation changed."""
        if program in FUZZ:
            stored = ROOT / "fuzz" / "corpus" / program.removeprefix("fuzz_").removesuffix("_replay")
            status, _ = call([copy.binaries / program, "--random", FUZZ[program], *([stored] if stored.is_dir() else [])], ROOT,
                             QUICK_LIMIT)
        elif program == "cscd":
            status, _ = call([copy.binaries / program, *VERIFY, "--failures", copy.binaries], ROOT, SLOW_LIMIT)
        else:
            wanted = PROOFS if stage == "proof" else self.filters(program)["slow" if stage in ("own", "slow") else "quick"]
            seconds = QUICK_LIMIT if stage in ("room", "rooms") else SLOW_LIMIT
            return run_gtest(copy, program, wanted, seconds) if wanted else (None, [])
        if status == 0:
            return None, []
        return ("timed out" if status is None else "killed"), ["cscd verify" if program == "cscd" else program]

    def attempt(self, copy, mutation, old, mutate):
        """(result, names, seen stages). `mutate` makes the mutation, once everything is built without it."""
        seen = [] if self.options.origin else list(old.get("stages", []))
        wanted = [(stage, programs) for stage, programs in self.steps(mutation.file)
                  if programs and stage in self.options.stages and stage not in seen]
        for stage, programs in wanted:
            copy.prepare(programs)
            self.measure_all(copy, [name for name in programs if name.startswith(("core_", "library_"))])
        library = "lib" + mutation.file.rpartition("/")[0].replace("/", "_") + ".a"
        copy.prepare([library] if mutation.file.endswith(".cpp") else self.targets(mutation.file)[:1])
        mutate()
        for stage, programs in wanted:
            targets = programs + ([library] if mutation.file.endswith(".cpp") else [])
            if errors := copy.make(targets):
                if any("error:" in line for line in errors):
                    return "not compiled", [], seen
                refuse("ninja fails without an error of the compiler:\n" + "\n".join(errors[-20:]))
            changed = [program for program in programs if copy.changed(program)]
            # A header shows what it became only in the programs of its room and of all rooms above it.
            if not changed and (not copy.changed(library) if mutation.file.endswith(".cpp") else
                                stage == "rooms" and not copy.changed(self.targets(mutation.file)[0])):
                return "same code", [], seen
            for program in changed:
                result, names = self.ask(copy, stage, program)
                if result:
                    return result, names, seen
            seen.append(stage)
        return "survived", [], seen

    def mended(self, file, old, result, seen):
        """Whether a stage that the mutant had survived notices it."""
        asked = [stage for stage, programs in self.steps(file) if programs and stage in self.options.stages and stage not in seen]
        return result in ("killed", "timed out") and bool(asked) and asked[0] in old.get("stages", [])

    def one(self, copies, mutation, old):
        if stopping.is_set():
            return
        copy = copies.get()
        began = time.monotonic()
        path = copy.source / mutation.file
        text = (ROOT / mutation.file).read_text()
        try:
            try:
                result, names, seen = self.attempt(copy, mutation, old, lambda: path.write_text(mutated(text, mutation)))
            finally:
                path.write_text(text)
            entry = {"file": mutation.file, "line": mutation.line, "becomes": mutation.becomes, "copy": mutation.copy,
                     "kind": mutation.kind, "result": result, "by": names, "stages": seen,
                     "mended": self.mended(mutation.file, old, result, seen),
                     "seconds": round(time.monotonic() - began, 1)}
            with self.lock:
                with open(RESULTS, "a") as out:
                    out.write(json.dumps(entry) + "\n")
                print(f"{result}: {mutation.file}:{mutation.number}: {mutation.line}  ->  {mutation.becomes}"
                      + (f"  ({names[0]})" if names else ""), flush=True)
        except Interrupted:
            pass
        except BaseException:
            stopping.set()
            raise
        finally:
            copies.put(copy)


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
            file, line, becomes, stages = moved(row)
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
            if path.suffix in {".h", ".cpp"} and not HELPER.search(path.name) and (not only or name in only):
                yield from mutations_of(name, path.read_text(), macros)


def named(line, copy):
    return line + (f" (equal line {copy + 1} of the file)" if copy else "")


def write(results, places, origin):
    """The record of all results whose places are still there; `origin` is the record whose survivors they are, or None."""
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
        "command": "scripts/find-faults mutants" + (f" --from results/trust/{origin.name}" if origin else ""),
        "says": f"The mutants of `{origin.name}` that had survived without a reason, after tests were written for them." if origin
                else "Small mistakes in `core/geometry`, `core/elementary` and `core/fast`, made one at a time at places that "
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
    parser.add_argument("--only", action="append", help="a file; can be given several times")
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
    if missing := [name for name in options.only or [] if not (ROOT / name).is_file()]:
        refuse(f"--only {missing[0]} is no file of the repository")
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
        write(results, places, options.origin)
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
