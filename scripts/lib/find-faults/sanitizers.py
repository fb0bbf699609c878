"""Runs the whole suite under sanitizers, and what works on threads under ThreadSanitizer.

  scripts/find-faults sanitizers                 runs scripts/test --sanitize and scripts/check threads, and shows what they print
  scripts/find-faults sanitizers --from RECORD   asks those tests again that failed in a record, and runs scripts/check threads
  scripts/find-faults sanitizers --rooms core,scenes/import    asks only tests of these folders, and runs scripts/check threads

The record is results/trust/DATE-sanitizers.json. From nothing it takes about two hours on 2 idle cores. Exit status: 0 if nothing was found, 1 otherwise, 2 if it could not run.
"""
import pathlib
import re
import shlex
import subprocess

from records import read_json
from script import ROOT, parser_of, refuse
from tracked import tracked_files
from trust import write_record

FAILED = "Tests that fail under address and undefined"


def run(command):
    """Shows what a command of bash prints as it comes; its exit status, and its lines."""
    lines = []
    with subprocess.Popen(["bash", "-c", command], cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace") as process:
        for line in process.stdout:
            print(line, end="", flush=True)
            lines.append(line.rstrip("\n"))
    return process.returncode, lines


def build_and_ask(rooms, which):
    """Builds all tests, or those of some folders, and runs those that ctest selects by `which`. Tests of folders have a build folder
    of their own, because ctest runs all that is built in one."""
    folder, targets = ("build-sanitize-rooms", targets_of(rooms)) if rooms else ("build-test-gcc-sanitize", [])
    return run(f'source scripts/lib/setup.sh; root=$PWD; build {folder} sanitize gcc {" ".join(targets)} && '
               f'ctest --test-dir {folder} --output-on-failure -j "$(nproc)" {which}')[1]


def targets_of(folders):
    """The test programs of these folders and of those below them."""
    rooms = {path.relative_to(ROOT).parent.as_posix() for path in tracked_files() if path.name.endswith("_test.cpp")}
    for folder in folders:
        if not any(f"{room}/".startswith(f"{folder}/") for room in rooms):
            refuse(f"--rooms {folder}: no test lies in a folder of that name; name folders as in core/session,scenes")
    return sorted(room.replace("/", "_") + "_test" for room in rooms if any(f"{room}/".startswith(f"{folder}/") for folder in folders))


def rooms_of(words):
    return words.rstrip("/").split(",")


def again(record, names):
    """Runs these tests alone, in the build of the folders that the record names."""
    rooms = re.search(r"--rooms (\S+)", record["command"])
    pattern = shlex.quote("^(" + "|".join(name.replace(".", "[.]") for name in names) + ")( |$)")
    return build_and_ask(rooms_of(rooms[1]) if rooms else [], f"-R {pattern}")


def number(pattern, lines):
    found = [match[1] for line in lines if (match := re.search(pattern, line))]
    if not found:
        refuse(f"the suite did not get as far as {pattern!r}; its last line: {lines[-1] if lines else 'none'}")
    return int(found[-1])


def failures(lines):
    """The names of tests that failed, crashed, or took too long, from the lines of ctest as they come."""
    found = (re.search(r"Test +#\d+: (\S+) .*(\*\*\*Failed|\*\*\*Timeout|\*\*\*Exception|\*\*\*Not Run|Subprocess)", line)
             for line in lines)
    return sorted({match[1] for match in found if match})


def suite(options):
    """What the record says of the tests: what was asked, figures, names of those that failed, and the headline."""
    if options.origin:
        origin = read_json(options.origin)
        names = [row[0] for table in origin["tables"] if table["title"] == FAILED for row in table["rows"]]
        if not names:
            refuse(f"{options.origin}: no test failed there")
        lines = again(origin, names)
        says = f"The tests that had failed in `{options.origin.name}`, after something was mended."
    elif options.rooms:
        lines = build_and_ask(options.rooms, "-R '[.]' -E _NOT_BUILT")  # of tests, only those of programs have names with a point
        says = (f"The tests of {', '.join(options.rooms)} alone under AddressSanitizer, UndefinedBehaviorSanitizer and the assertions of "
                "libstdc++, any finding fatal.")
    else:
        lines = run("scripts/test --sanitize")[1]
        says = "The whole suite under AddressSanitizer, UndefinedBehaviorSanitizer and the assertions of libstdc++, any finding fatal."
    of, failed = number(r"tests failed out of (\d+)", lines), failures(lines)
    if options.origin and of != len(names):
        refuse(f"{of} of the {len(names)} tests of {options.origin.name} were found; the others have other names now")
    if len(failed) != number(r"(\d+) tests? failed out of", lines):
        refuse("the suite says another number of failures than it shows")
    figures = [["tests under address and undefined", of], ["of them failed", len(failed)],
               ["of them skipped: too long under sanitizers, or another program is not there",
                sum("***Skipped" in line for line in lines)]]
    asked = " that had failed" if options.origin else f" of {', '.join(options.rooms)}" if options.rooms else ""
    return says, figures, failed, (f"{len(failed)} of {of} tests{asked} fail under address and undefined"
                                   f"{' still' if options.origin else ''}")


def add_threads(record):
    """Runs scripts/check threads, adds to the record what it prints, and returns its exit status."""
    status, watched = run("scripts/check threads")
    if "== a planted race" not in watched:
        refuse("scripts/check threads could not be built")
    shown = watched[watched.index("== a planted race"):]
    record["says"] += (" Then all code that shares work among threads under ThreadSanitizer, its answers compared with those of one "
                       "thread. ThreadSanitizer watches plain threads, because it cannot see into oneTBB's library "
                       "(`core/base/thread_pool.cpp`), and has to report a planted race first.")
    record["headline"] += ", a race or another answer on threads" if status else ", no race on threads"
    record["figures"] += [["findings of ThreadSanitizer", int(status != 0)]]
    record["tables"] += [{"title": "What ThreadSanitizer watched", "head": ["lines of `scripts/check threads`"], "text_columns": 1,
                          "rows": [[line.strip()] for line in shown
                                   if line.strip() and not line.startswith("==") and not re.search(r": \d+ of \d+", line)]}]
    return status


def main():
    parser = parser_of(__doc__)
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--from", dest="origin", type=pathlib.Path, metavar="RECORD")
    which.add_argument("--rooms", type=rooms_of, default=[], metavar="FOLDERS")
    options = parser.parse_args()
    says, figures, failed, headline = suite(options)
    record = {"kind": "sanitizers", "title": "Sanitizers", "says": says, "headline": headline, "figures": figures,
              "command": "scripts/find-faults sanitizers" + (f" --from {options.origin.name}" if options.origin else "")
                         + (f" --rooms {','.join(options.rooms)}" if options.rooms else ""),
              "tables": [{"title": FAILED, "head": ["test"], "text_columns": 1, "rows": [[name] for name in failed]}]}
    status = add_threads(record)
    write_record(record)
    return int(bool(failed) or status != 0)
