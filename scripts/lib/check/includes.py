"""Checks that includes point down only, and that every room can be read at a sitting.

  scripts/check includes              the repository
  scripts/check includes --self-test  planted violations must be caught

A room is a folder that CMakeLists.txt names with cscd_room(). A file may include headers of its own room and of the
rooms that its room uses, directly or through others. A room may use only rooms that CMakeLists.txt names before it, so
rooms form no circle. The folders that hold rooms (bench/harness, with all rooms in it) form no circle either, nor do
units (x.h and x.cpp) within a room. An outside library is seen by its own rooms alone (OUTSIDE). No folder holds more than MOST_FILES sources beside its tests. Exit status: 0 clean, 1 violations,
one a line. Files that git does not track are passed over.
"""
import pathlib
import re
import tempfile

from rooms import closure, read_rooms
from script import ROOT, parser_of
from tracked import tracked_files

MOST_FILES = 30
# What the order of rooms alone would allow: scenes replay and animate, they judge nothing.
NEVER = [(r"scenes/.*", "baselines"), (r"scenes/(?!effects$).*", "core/drvbc"), (r"scenes/.*", "core/fast")]
# Outside libraries by how their headers begin, and the rooms that see them; a name that ends in / means all rooms below, and `tests`
# the tests of all rooms.
OUTSIDE = {
    "hdf5": ["scenes/clip"], "H5": ["scenes/clip"], "assimp/": ["scenes/import"], "pugixml": ["scenes/import/collada"],
    "zlib": ["scenes/import/fbx", "bench/output"], "fcl/": ["baselines/fcl"], "embree3/": ["baselines/embree"],
    "embree4/": ["baselines/embree"],
    "CGAL/": ["baselines/cgal_boxes", "scenes/polygon"],
    "nlohmann/": ["bench/", "scenes/catalog", "scenes/export", "scenes/import/gltf"],
    "CLI/": ["bench", "bench/"], "valijson/": ["bench/output"],
    "benchmark/": ["bench/measure/kernels"], "openssl/": ["bench/output"],
    "tbb/": ["core/base"], "oneapi/": ["core/base"],
    "tiny_gltf": ["scenes/import/gltf"], "meshoptimizer": ["scenes/import/gltf"], "draco/": ["scenes/import/gltf"],
    "gtest/": ["tests"],
    "gmp": ["tests", "scenes/queries", "bench/records"],  # the library alone takes none
    "boost/multiprecision": ["core/elementary/exact"],
}
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)', re.M)


def room_of(path, rooms):
    """The room whose folder holds a file, or None."""
    folder = path.rpartition("/")[0]
    return folder if folder in rooms else None


def room_violations(rooms):
    named = set()
    for room, (uses, _) in rooms.items():
        for used in uses:
            if used not in named:
                yield f"CMakeLists.txt: {room} uses {used}, which is not named before it"
            if any(re.fullmatch(pattern, room) and (used + "/").startswith(hidden + "/") for pattern, hidden in NEVER):
                yield f"CMakeLists.txt: {room} uses {used}, which it must not see"
        named.add(room)


def unit_circle(units):
    """A list of units each of which includes the next, the last the first; empty where there is none."""
    finished, path = set(), []

    def visit(unit):
        if unit in path:
            return path[path.index(unit):]
        if unit in finished:
            return []
        path.append(unit)
        for below in sorted(units.get(unit, ())):
            if circle := visit(below):
                return circle
        path.pop()
        finished.add(unit)
        return []

    return next(filter(None, map(visit, sorted(units))), [])


def folders_of(units):
    """The folders with rooms, core/fast or bench/harness, and those that each includes from. What lies in bench/ itself
    joins the rooms into one program and belongs to none of them."""
    folders = {}
    for unit, below in units.items():
        own = unit.split("/")[:2]
        others = {"/".join(used.split("/")[:2]) for used in below if used.count("/") > 1}
        if unit.count("/") > 1:
            folders.setdefault("/".join(own), set()).update(others - {"/".join(own)})
    return folders


def violations(root):
    rooms = read_rooms(root / "CMakeLists.txt")
    yield from room_violations(rooms)
    units, files = {}, {}
    for path in tracked_files(root=root):
        name = path.relative_to(root).as_posix()
        if path.suffix not in {".h", ".cpp"} or name.split("/")[0] not in {"core", "baselines", "scenes", "bench"}:
            continue
        room = room_of(name, rooms)
        if room is None:
            yield f"{name}: lies in no room of CMakeLists.txt"
            continue
        is_test = bool(re.search(r"_test\.cpp$|test_[a-z_]+\.h$", name))
        if not is_test:
            files[room] = files.get(room, 0) + 1
        uses, test_uses = rooms[room]
        seen = closure(rooms, uses + (test_uses if is_test else [])) | {room}
        for quoted, angled in INCLUDE.findall(path.read_text(errors="replace")):
            if "/" in quoted and room_of(quoted, rooms) not in seen:
                yield f"{name}: includes {quoted}, which {room} must not see"
            unit, below = name.rpartition(".")[0], quoted.rpartition(".")[0]
            if "/" in quoted and not is_test and unit != below:
                units.setdefault(unit, set()).add(below)
            for prefix, allowed in OUTSIDE.items():
                if not (angled or quoted).startswith(prefix):
                    continue
                if not (is_test and "tests" in allowed) and not any(
                        room == a or a.endswith("/") and (room + "/").startswith(a) for a in allowed):
                    yield f"{name}: includes {angled or quoted}, kept to {', '.join(allowed)}"
    if circle := unit_circle(units):
        yield "a circle of includes: " + " -> ".join(circle + circle[:1])
    if circle := unit_circle(folders_of(units)):
        yield "a circle of folders: " + " -> ".join(circle + circle[:1])
    for room, count in files.items():
        if count > MOST_FILES:
            yield f"{room}: holds {count} sources beside its tests, more than {MOST_FILES}; split it"


CLEAN_CMAKE = """
cscd_room(core/base LINK Eigen3::Eigen)
cscd_room(core/mesh USES core/base)
cscd_room(core/fast USES core/mesh)
cscd_room(scenes/clip USES core/mesh)
cscd_room(baselines USES core/mesh TEST_USES scenes/clip)
cscd_room(bench USES core/fast baselines scenes/clip)
"""
CLEAN = {
    "CMakeLists.txt": CLEAN_CMAKE,
    "core/base/a.h": "#include <vector>\n",
    "core/mesh/b.h": '#include "core/base/a.h"\n#include "core/mesh/a.h"\n',
    "core/mesh/a.h": "#include <vector>\n",
    "baselines/c_test.cpp": '#include <gtest/gtest.h>\n#include "scenes/clip/d.h"\n',
    "scenes/clip/d.h": '#include <hdf5.h>\n#include "core/base/a.h"\n',
    "bench/e.cpp": '#include <nlohmann/json.hpp>\n#include "core/mesh/b.h"\n#include "commit.h"\n',
}
PLANTED = [
    ("core/base/a.h", '#include "core/mesh/b.h"'),       # upwards
    ("core/fast/f.cpp", '#include "scenes/clip/d.h"'),    # the core sees scenes
    ("core/fast/f.cpp", '#include "baselines/g.h"'),      # a room that it does not use
    ("core/fast/below/f.cpp", "#include <vector>"),       # a folder inside a room is no part of it
    ("core/mesh/a.h", '#include "core/mesh/b.h"'),        # a circle within a room: below, b.h includes a.h
    ("baselines/g.cpp", '#include "scenes/clip/d.h"'),    # what tests alone may
    ("baselines/g.cpp", "  #  include <hdf5.h>"),
    ("bench/e.cpp", "#include <hdf5.h>"),
    ("bench/e.cpp", "#include <benchmark/benchmark.h>"),
    ("bench/e.cpp", "#include <gtest/gtest.h>"),
    ("core/fast/f.cpp", "#include <gmpxx.h>"),
    ("scenes/clip/d.cpp", "#include <nlohmann/json.hpp>"),
    ("scenes/clip/d.cpp", "#include <assimp/scene.h>"),
    ("baselines/g.cpp", "#include <embree3/rtcore.h>"),
    ("scenes/clip/d.cpp", "#include <tiny_gltf.h>"),
    ("baselines/g.cpp", "#include <CGAL/box_intersection_d.h>"),
    ("scenes/lost.cpp", "#include <vector>"),             # in no room
    ("CMakeLists.txt", CLEAN_CMAKE + "cscd_room(attic USES cellar)"),
    ("CMakeLists.txt", CLEAN_CMAKE.replace("core/base LINK", "core/base USES core/mesh LINK")),
    ("CMakeLists.txt", CLEAN_CMAKE.replace("clip USES core/mesh", "clip USES core/mesh baselines")),
]


def found_in(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return list(violations(pathlib.Path(folder)))


def self_test():
    failures = [f"clean tree refused: {v}" for v in found_in(CLEAN)]
    many = {f"core/base/x{i}.h": "#include <vector>\n" for i in range(MOST_FILES)}
    if not found_in({**CLEAN, **many}):
        failures.append("not caught: a room of too many files")
    if found_in({**CLEAN, **{name.replace(".h", "_test.cpp"): text for name, text in many.items()}}):
        failures.append("tests are counted among a room's files")
    below = {"CMakeLists.txt": CLEAN_CMAKE + "cscd_room(core/base/low USES core/mesh)\n",
             "core/base/low/h.h": '#include "core/mesh/a.h"\n'}
    if not found_in({**CLEAN, **below}):
        failures.append("not caught: core/base and core/mesh include from each other, by way of core/base/low")
    for name, line in PLANTED:
        if not found_in({**CLEAN, name: line}):
            failures.append(f"not caught: {line} in {name}")
    return failures


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--self-test", action="store_true")
    found = self_test() if parser.parse_args().self_test else list(violations(ROOT))
    print("\n".join(found) if found else "clean")
    return 1 if found else 0
