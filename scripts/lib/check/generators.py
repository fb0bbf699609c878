"""Builds the library and the whole project with each of CMake's generators, with a stand-in for the compiler, from a path with a blank.

  scripts/check generators            Ninja Multi-Config builds the library alone; Makefiles, which cmake takes where none is named, the whole
                                      project without its tests, and one that takes the library by add_subdirectory and by FetchContent
  scripts/check generators --all      each of them builds all of that, but for the whole project by Ninja, which scripts/test uses
  scripts/check generators --real     the library alone by each generator with the compiler itself: a quarter of an hour each on 2 idle cores

Nothing is compiled without --real, so --all takes a minute or two, and the rest half of that. Exit status: 0 all build, 1 something does not.
"""
import os
import pathlib
import re
import subprocess
import tempfile

from script import parser_of
from stand_in import copy_tree, stand_ins, without_git

GENERATORS = ("Unix Makefiles", "Ninja", "Ninja Multi-Config")
LIBRARY = "libcscd.a", "libcscd.so"
OUTER = """cmake_minimum_required(VERSION 3.25)
project(outer LANGUAGES CXX)
{takes}
add_executable(outer cscd/library/examples/first_contact.cpp)
target_link_libraries(outer PRIVATE cscd::cscd)
if(TARGET GTest::gtest OR TARGET cscd OR TARGET scenes_clip)
  message(FATAL_ERROR "more than the library is configured")
endif()
"""
WAYS = {"add_subdirectory": "add_subdirectory(cscd)",
        "FetchContent": 'include(FetchContent)\nFetchContent_Declare(fetched GIT_REPOSITORY "${PROJECT_SOURCE_DIR}/cscd" GIT_TAG main)\n'
                        "FetchContent_MakeAvailable(fetched)"}


def said_by(environment, *words):
    """What a command that fails said last; nothing where it does not fail."""
    done = subprocess.run([str(word) for word in words], env=environment, capture_output=True, text=True)
    return "" if done.returncode == 0 else "\n".join((done.stdout + done.stderr).splitlines()[-25:])


def built(environment, generator, source, options, wanted):
    """Configures and builds a folder. Returns what is wrong."""
    build = source.parent / " ".join([source.name, "by", generator, *options])
    compiled = build / "Release" if "Multi" in generator else build
    wrong = (said_by(environment, "cmake", "-S", source, "-B", build, "-G", generator, *options)
             or said_by(environment, "cmake", "--build", build, "-j", os.cpu_count()))
    missing = [name for name in wanted if not (compiled / name).exists()]
    return wrong or (f"makes no {' and no '.join(missing)}" if missing else waiting_copies(build))


def waiting_copies(build):
    """What the copies of the library for instruction sets wait for before they are compiled. Makefiles alone can say."""
    rules = build / "CMakeFiles/Makefile2"
    if not rules.exists():
        return ""
    waits = re.findall(r"^CMakeFiles/(cscd_library_avx\w+)\.dir/all: CMakeFiles/(\w+)\.dir", rules.read_text(), re.M)
    return "".join(f"{copy} waits for {other}; " for copy, other in waits)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--real", action="store_true", help="compile")
    parser.add_argument("--all", action="store_true", help="everything by each generator")
    options = parser.parse_args()
    real = options.real
    failed = 0
    with tempfile.TemporaryDirectory(prefix="cscd ") as folder:
        work = pathlib.Path(folder)
        tree = work / "outer" / "cscd"
        copy_tree(tree)
        environment = without_git(os.environ) if real else stand_ins(work / "stand-ins")
        for generator in GENERATORS:
            results, is_usual = [], generator == GENERATORS[0]
            if real or options.all or "Multi" in generator:  # scripts/check commands types the others
                results.append(("the library alone", built(environment, generator, tree, ["-DCSCD_LIBRARY_ONLY=ON"], LIBRARY)))
            if not real and (is_usual or options.all and generator != "Ninja"):
                tests = ("library_test",) if options.all else ()
                results.append(("the whole project", built(environment, generator, tree, [] if tests else ["-DBUILD_TESTING=OFF"],
                                                           (*LIBRARY, "cscd", "cscd-avx2", "cscd-import", *tests))))
            release = ["-DCMAKE_DEFAULT_BUILD_TYPE=Release"] if "Multi" in generator else []  # what a project of a user's own builds
            for way, takes in WAYS.items() if not real and (is_usual or options.all) else []:
                (work / "outer" / "CMakeLists.txt").write_text(OUTER.format(takes=takes))
                results.append((way, built(environment, generator, work / "outer", [f"-DWAY={way}", *release], ("outer",))))
            for what, wrong in results:
                failed |= bool(wrong)
                print(f"{generator}, {what}: {wrong or 'builds'}", flush=True)
    return int(failed)
