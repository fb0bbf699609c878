"""Programs of commits: what scripts that compare commits (compare-commits, record latency, record samples) build and run."""
import difflib
import fcntl
import os
import pathlib
import re
import shutil
import subprocess

from layouts import link_layout
from records import read_json
from script import ROOT, git, refuse

CACHE = ROOT / ".cache" / "commits"
# Valgrind knows no AVX-512, and counters are the same with AVX2 and FMA (bench/METHODOLOGY.md).
COUNTED_FLAGS = "-march=x86-64-v3"


# The run that stands for one process: eight intervals from the middle of a scene, where most happens, four of them timed. Most of a
# process goes into preparing, so repetitions are cheap. About half of what processes differ by on a machine with other work comes
# from too few of them.
FRAMES = (116, 124)
FRAME_RANGE = "%d:%d" % FRAMES
OPTIONS = ["--frames", FRAME_RANGE, "--time-every", "2", "--time-contacts", "0", "--verify-every", "4", "--repetitions", "31"]


SOURCES = ("CMakeLists.txt", "core", "baselines", "scenes", "bench", "page", "library", "scripts/cmake")  # what a build reads


def require_tracked():
    """Refuses a working tree in which git does not track some of the sources: a comparison would leave them out without a word."""
    files = git("ls-files", "--others", "--exclude-standard", "--", *SOURCES).splitlines()
    if files:
        refuse(f"the working tree holds {len(files)} sources that git does not track, such as {files[0]}, and they would be left out; "
               "git add them, or move them away")


def commit_named(name):
    """The hash of a commit, or of the working tree's tracked files where none is named."""
    if name is None:
        require_tracked()
        # With the dates of HEAD the same changes give the same commit, so that an interrupted call finds its measurements.
        date = git("show", "-s", "--format=%cI", "HEAD")
        dated = {**os.environ, "GIT_AUTHOR_DATE": date, "GIT_COMMITTER_DATE": date}
        return git("stash", "create", env=dated) or git("rev-parse", "HEAD")
    done = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--verify", "--quiet", "--end-of-options", f"{name}^{{commit}}"],
                          capture_output=True, text=True)
    if done.returncode:
        refuse(f"commit {name}: this repository has no commit of that name; `git log --oneline` lists them")
    return done.stdout.strip()


def names_of(names):
    """The names between commas; refuses an empty one."""
    split = names.split(",")
    if not all(split):
        refuse(f"{names!r}: holds an empty name; write names with single commas between them")
    return split


def require_names(commit, what, names, known):
    """Refuses names that a commit does not know, with the closest of those that it does."""
    for name in names:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            refuse(f"{what} {name}: {commit[:10]} has none of that name" + (f"; did you mean {near[0]}?" if near else "")
                   + f"; it has {', '.join(sorted(known))}")


def scenes_of(commit):
    """The names of the scenes that a commit holds."""
    return {pathlib.PurePath(path).stem for path in git("ls-tree", "--name-only", commit, "scenes/").splitlines()
            if path.endswith(".json")}


def strategies_of(commit):
    """The names and groups in a commit's catalogue of strategies, and the rows that the engine itself defines."""
    paths = git("ls-tree", "-r", "--name-only", commit, "bench/", "core/fast/").splitlines()
    catalogue = [path for path in paths if path.startswith("bench/") and path.endswith("/catalogue.cpp")]
    if not catalogue:
        refuse(f"commit {commit[:10]}: has no catalogue of strategies, so it cannot be measured")
    rows = re.split(r"playing\(|refuse_unknown\(", git("show", f"{commit}:{catalogue[0]}"))[0]  # behind them are look-ups
    engine = git("show", f"{commit}:core/fast/drvbc_fast.h") if "core/fast/drvbc_fast.h" in paths else ""
    return {*re.findall(r'"(\w+)"', rows), *re.findall(r'\.name = "(\w+)"', engine)}


class Build:
    """The programs of a commit, one a layout, and its scenes. All commits are built in one worktree, one after the other, so
    that a commit beside another takes as long as what differs."""

    def __init__(self, commit, lane, seeds):
        self.commit = commit
        self.folder = CACHE / f"{commit[:10]}-{lane}"
        self.tree = CACHE / "tree"
        self.build = self.tree / ("build-counters" if lane == "counters" else "build-release")
        missing = [seed for seed in seeds if not self.program(seed).exists()]
        if missing:
            print(f"building {commit[:10]}", flush=True)
            self.compile("-DCSCD_NATIVE=OFF -DCMAKE_CXX_FLAGS=" + COUNTED_FLAGS if lane == "counters" else "-DCSCD_NATIVE=ON")
            for seed in missing:
                self.program(seed).parent.mkdir(parents=True, exist_ok=True)
                linked = self.build / "cscd" if seed == 0 else link_layout(self.build, seed)
                shutil.copy2(linked, self.program(seed))
            shutil.copytree(self.tree / "scenes", self.folder / "scenes", dirs_exist_ok=True,
                            ignore=lambda folder, names: [n for n in names if not n.endswith(".json")])

    def compile(self, flags):
        git("worktree", "prune")
        if not self.tree.exists():
            git("worktree", "add", "--detach", str(self.tree), self.commit)
        git("-C", str(self.tree), "checkout", "--quiet", "--detach", "--force", self.commit)
        log = CACHE / f"{self.commit[:10]}.log"
        configure = f"cmake -S {self.tree} -B {self.build} -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF {flags}"
        script = f"{{ [ -e {self.build}/build.ninja ] || {configure}; }} >{log} 2>&1 && ninja -C {self.build} cscd >>{log} 2>&1"
        if subprocess.run(["bash", "-c", script]).returncode:
            refuse(f"{self.commit[:10]}: does not build; see {log}")

    def program(self, seed):
        """The program in the layout of that seed; 0 is the order of the build."""
        return self.folder / f"layout-{seed}" / "cscd"

    def run(self, words, before=()):
        environment = {**os.environ, "CSCD_CACHE": str(ROOT / ".cache"), "CSCD_SCENES": str(self.folder / "scenes")}
        return subprocess.run([*before, *map(str, words)], env=environment, capture_output=True, text=True)

    def record(self, seed, command, scene, words, part):
        """Has the program write a record of a scene to the file `part`; returns the record and the exit status."""
        part.unlink(missing_ok=True)
        done = self.run([self.program(seed), command, "--scene", scene, *words, "--json", part])
        if not part.exists():
            refuse(f"{self.commit[:10]} on {scene}: {(done.stderr.strip().splitlines() or ['failed'])[-1]}")
        return read_json(part), done.returncode


def held_lock():
    """Keeps others that build commits out of this checkout for as long as the caller keeps what is returned."""
    CACHE.mkdir(parents=True, exist_ok=True)
    lock = open(CACHE / "lock", "w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        refuse("another script builds commits in this checkout; wait for it, or clone the repository once more")
    return lock
