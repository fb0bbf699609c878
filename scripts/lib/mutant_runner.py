"""Builds mutants in copies of the working tree and asks tests about them; for scripts/find-faults mutants."""
import hashlib
import json
import os
import re
import resource
import selectors
import signal
import subprocess
import threading
import time

from mutations import mutated
from rooms import above, closure, read_rooms, test_programs
from script import ROOT, refuse

FUZZ = {"fuzz_engine_replay": 150, "fuzz_elementary_replay": 1000, "fuzz_queries_replay": 1000, "fuzz_gltf_replay": 1000,
        "fuzz_fbx_replay": 1000}  # inputs of each
FLAGS = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_COMPILER=g++", "-DCMAKE_C_COMPILER=gcc", "-DCSCD_NATIVE=ON",
         "-DCSCD_VIEWER=OFF", "-DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST",
         # A mutant may leave a variable unused, and an index outside of its array has to show.
         "-DCMAKE_CXX_FLAGS=-w -D_GLIBCXX_ASSERTIONS", "-DCMAKE_CXX_FLAGS_RELEASE=-O1"]
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
        """Test programs for a file: of its room first, then of rooms above it, bottom-up. A reader's tests are in the room above."""
        own = file.rpartition("/")[0]
        higher = above(self.rooms, own)
        return test_programs([own], "") + (test_programs(higher, "scenes/") if own.startswith("scenes/") else test_programs(higher))

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
                ("proof", ["bench_harness_test", "cscd"]), ("slow", self.targets(file)[1:])]

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
            self.measure_all(copy, [name for name in programs if name.endswith("_test") and name != "bench_harness_test"])
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
