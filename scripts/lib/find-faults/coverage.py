"""Lists the lines of core/ that no test runs.

  scripts/find-faults coverage            builds, runs the tests of core and library, and writes the record
  scripts/find-faults coverage --count    only counts what the last run left, and prints it

Builds with gcc --coverage below build-coverage. gcov says for every translation unit which lines can run and which did; a
line of a header counts as run if it ran in any of them. Tests and their helpers are not counted, and neither are branches
for instruction sets that this machine lacks, because the compiler never sees them. A program that fails ends the script.
--without names tests that are left out, as GoogleTest's filter does; the record says how many.

The record is results/trust/DATE-coverage.json. Reasons for lines that no test runs stand in scripts/lib/uncovered.json.
"""
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import sys

from rooms import HELPER, read_rooms, test_programs
from script import ROOT, output_of, parser_of, refuse
from trust import write_record

BUILD = ROOT / "build-coverage"
FLAGS = ["-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_COMPILER=g++", "-DCMAKE_C_COMPILER=gcc", "-DCSCD_NATIVE=ON",
         "-DCSCD_VIEWER=OFF", "-DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST",
         "-DCMAKE_CXX_FLAGS=--coverage -w", "-DCMAKE_CXX_FLAGS_DEBUG=-Og -DNDEBUG"]


def lines_that_ran():
    """File to line to whether it ran, of all sources of core."""
    ran = collections.defaultdict(dict)
    notes = [path for path in sorted(BUILD.rglob("*.gcno")) if re.search(r"/(core|library)_?", path.relative_to(BUILD).as_posix())
             or path.relative_to(BUILD).as_posix().startswith("CMakeFiles/core")]

    def read(note):
        # Without data of a run gcov says that no line ran, which is true.
        return output_of("gcov", "--json-format", "--stdout", note, cwd=BUILD)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for text in pool.map(read, notes):
            for line_of_text in text.splitlines():
                for file in json.loads(line_of_text)["files"]:
                    path = pathlib.Path(os.path.normpath(BUILD / file["file"]))
                    if path.is_relative_to(ROOT / "core") and not HELPER.search(path.name):
                        lines = ran[path.relative_to(ROOT).as_posix()]
                        for line in file["lines"]:
                            number = line["line_number"]
                            lines[number] = lines.get(number, False) or line["count"] > 0
    return ran


def missed_ranges(ran):
    """[file, first line's text, "first-last"] of neighbouring lines that did not run."""
    for name in sorted(ran):
        text = (ROOT / name).read_text().splitlines()
        numbers, known = [n for n in sorted(ran[name]) if not ran[name][n]], set(ran[name])
        while numbers:
            first = last = numbers.pop(0)
            # Lines between that hold no code, such as comments, do not part a range.
            while numbers and not any(n in known and ran[name][n] for n in range(last + 1, numbers[0])):
                last = numbers.pop(0)
            yield [name, text[first - 1].strip(), str(first) if first == last else f"{first}–{last}"]


def record(ran, left_out):
    rooms = collections.defaultdict(lambda: [0, 0])
    for name, lines in ran.items():
        rooms[name.rpartition("/")[0]][0] += sum(lines.values())
        rooms[name.rpartition("/")[0]][1] += len(lines)
    run_lines, all_lines = (sum(room[i] for room in rooms.values()) for i in (0, 1))
    order = [room for room in read_rooms(ROOT / "CMakeLists.txt") if room in rooms]

    def share(part, whole):
        return f"{100 * part / whole:.1f} %"

    return {
        "kind": "coverage", "title": "Lines that tests run", "command": " ".join(["scripts/find-faults coverage", *sys.argv[1:]]),
        "says": "Lines of `core` that run in tests of `core` and `library`, as gcov counts them. Branches for other instruction "
                "sets than this machine's are not compiled and not counted.",
        "headline": f"{share(run_lines, all_lines)} of {all_lines} lines of core",
        "figures": [["lines that can run", all_lines], ["lines that ran", run_lines], ["share", share(run_lines, all_lines)],
                    ["tests that were left out because they take long", left_out]],
        "tables": [
            {"title": "By room", "head": ["room", "lines", "ran", "share"], "text_columns": 1,
             "rows": [[room, str(rooms[room][1]), str(rooms[room][0]), share(*rooms[room])] for room in order]},
            {"title": "Lines that no test runs", "head": ["file", "the first line", "lines"], "text_columns": 3,
             "rows": list(missed_ranges(ran)), "reasons": "scripts/lib/uncovered.json"},
        ]}


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--count", action="store_true")
    parser.add_argument("--without", default="", help="names of tests with colons between")
    options = parser.parse_args()
    if not options.count:
        output_of("cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", *FLAGS)
        programs = test_programs(read_rooms(ROOT / "CMakeLists.txt"))
        output_of("ninja", "-C", BUILD, *programs)
        for path in BUILD.rglob("*.gcda"):  # counts of programs that were built before
            path.unlink()
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            def run(name):
                return output_of(BUILD / name, f"--gtest_filter=-{options.without}", cwd=ROOT)
            for program, _ in zip(programs, pool.map(run, programs)):
                print(f"{program} passes", flush=True)
    ran = lines_that_ran()
    if not ran:
        refuse(f"{BUILD}: holds no tests that ran; call without --count")
    counted = record(ran, len([name for name in options.without.split(":") if name]))
    for room, lines, _, share in counted["tables"][0]["rows"]:
        print(f"{room}: {share} of {lines}")
    for file, text, lines in counted["tables"][1]["rows"]:
        print(f"{file}:{lines}: {text}")
    print(counted["headline"])
    if not options.count:
        write_record(counted)
