"""Measures steps of real simulations whose contacts somebody else has computed, and holds every contact against that truth.

  scripts/record real DIR              all steps in DIR
  scripts/record real DIR --steps 3    of each scene, three that stand evenly

DIR is one of two things. A folder of point caches (NAME.h5, two frames each) with tables of truth beside them (NAME.truth.csv.gz,
bench/README.md) is measured as it is. So is the public ground truth of Scalable CCD, which its user has downloaded and unpacked: the
sample (github.com/Continuous-Collision-Detection/Sample-Scalable-CCD-Data) or the whole (archive.nyu.edu/handle/2451/74508). There
DIR holds a folder a scene, with frames (frames/*N.ply or .obj), pairs of boxes (boxes/Nee.json, Nvf.json) and the verdict about each
pair (mma_bool/Nee_mma_bool.json, Nvf_mma_bool.json) of the step from frame N to N + 1. Each step then becomes a cache and a table in
.cache/real. Steps of which a file is missing are named and left out.

`cscd run` verifies and times base, selfccd, drvbc_fast_complete and its --first on each step, and `cscd tables` makes the table, in a new
folder results/DATE-MACHINE-COMMIT-real. The five steps of the sample take a quarter of an hour on 2 idle cores, most of it exact
verification. One missed or invented contact ends the script with status 1.
"""
import collections
import gzip
import json
import pathlib
import re
import tempfile

from script import ROOT, call, existing_folder, install, measured_program, new_results, output_of, parser_of, refuse

STRATEGIES = "base,selfccd,drvbc_fast_complete,drvbc_fast_complete --first"
Step = collections.namedtuple("Step", "name frames judged")  # judged: kind to its boxes and their verdicts


def numbered(folder):
    """The mesh files of a folder by the number that their names end in."""
    return {int(found[1]): path for path in sorted(folder.iterdir())
            if path.suffix in (".ply", ".obj") and (found := re.search(r"(\d+)$", path.stem))}


def steps_of(scene):
    """The steps of one scene of the public set, and the names of those of which a file is missing."""
    whole, partial = [], []
    frames = numbered(scene / "frames") if (scene / "frames").is_dir() else {}
    numbers = {int(found[1]) for path in (scene / "boxes").glob("*.json") if (found := re.fullmatch(r"(\d+)(ee|vf)\.json", path.name))}
    for number in sorted(numbers):
        judged = {kind: (scene / "boxes" / f"{number}{kind}.json", scene / "mma_bool" / f"{number}{kind}_mma_bool.json")
                  for kind in ("vf", "ee")}
        there = number in frames and number + 1 in frames and all(path.exists() for pair in judged.values() for path in pair)
        name = f"{scene.name}-{number}"
        whole += [Step(name, (frames[number], frames[number + 1]), judged)] if there else []
        partial += [] if there else [name]
    return whole, partial


def judged_pairs(boxes, verdicts):
    """Pairs of boxes with their verdicts."""
    try:
        pairs, truths = json.loads(boxes.read_text()), json.loads(verdicts.read_text())
        if len(pairs) != len(truths) or any(truth not in (True, False) for truth in truths):
            raise ValueError(f"{len(pairs)} pairs, and {len(truths)} verdicts in {verdicts.name}")
        return [(int(one), int(other), int(truth)) for (one, other), truth in zip(pairs, truths)]
    except (TypeError, ValueError) as error:
        refuse(f"{boxes}: is no list of pairs of boxes with a verdict each ({error}); download it again")


def truth_table(step, triangles, vertices):
    """The table of truth of one step. Boxes are numbered through vertices, edges and triangles; edges ascend by their larger end, then by
    their smaller one."""
    sides = {(max(a, b), min(a, b)) for t in triangles for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
    edges = [(smaller, larger) for larger, smaller in sorted(sides)]

    def corners(box):
        if 0 <= box < vertices:
            return (box,)
        if vertices <= box < vertices + len(edges):
            return edges[box - vertices]
        if vertices + len(edges) <= box < vertices + len(edges) + len(triangles):
            return tuple(triangles[box - vertices - len(edges)])
        return ()

    lines = ["kind,v0,v1,v2,v3,truth,shares_vertex"]
    for kind, sizes in (("vf", (1, 3)), ("ee", (2, 2))):
        boxes, verdicts = step.judged[kind]
        for one, other, truth in judged_pairs(boxes, verdicts):
            first, second = sorted((corners(one), corners(other)), key=len)
            if (len(first), len(second)) != sizes:
                refuse(f"{boxes}: the boxes {one} and {other} are no {kind} pair of {step.frames[0]}; download both again")
            shares = int(bool(set(first) & set(second)))
            lines.append(",".join(map(str, (kind, *first, *second, truth, shares))))
    return "\n".join(lines) + "\n"


def converted(step, cscd, folder):
    """The point cache of a step, with its table of truth beside it."""
    import h5py  # installed by main()
    cache = folder / f"{step.name}.h5"
    with tempfile.TemporaryDirectory() as part:
        for place, frame in enumerate(step.frames):  # a sequence of two frames
            (pathlib.Path(part) / f"step.{place:04}{frame.suffix}").symlink_to(frame.resolve())
        output_of(cscd, "export", pathlib.Path(part) / f"step.0000{step.frames[0].suffix}", cache, "--force")
    with h5py.File(cache) as made:
        triangles, vertices = made["triangles"][:].tolist(), made["positions"].shape[1]
    cache.with_suffix(".truth.csv.gz").write_bytes(gzip.compress(truth_table(step, triangles, vertices).encode(), mtime=0))
    return cache


def evenly(items, most):
    """At most so many of a list, the first among them, evenly apart."""
    return items if not most or len(items) <= most else [items[i * len(items) // most] for i in range(most)]


def main():
    parser = parser_of(__doc__)
    parser.add_argument("folder", metavar="DIR", type=pathlib.Path)
    parser.add_argument("--steps", type=int, metavar="N", help="at most N steps of each scene; default all")
    parser.add_argument("--repetitions", type=int, default=5, help="of each query; default 5")
    options = parser.parse_args()
    if options.steps is not None and options.steps < 1:
        refuse("--steps: at least 1")
    caches = sorted(existing_folder(options.folder).glob("*.h5"))
    missing = [cache.name for cache in caches if not cache.with_suffix(".truth.csv.gz").exists()]
    if missing:
        refuse(f"{options.folder}: no NAME.truth.csv.gz lies beside {', '.join(missing)}; put it there, or move the cache away")
    steps = []
    if not caches:
        for scene in sorted(path.parent for path in options.folder.glob("*/boxes")):
            whole, partial = steps_of(scene)
            steps += evenly(whole, options.steps)
            if partial:
                print(f"left out, because a file is missing: {', '.join(partial)}", flush=True)
        if not steps:
            refuse(f"{options.folder}: holds neither point caches (.h5) nor a whole step of a scene (frames, boxes, mma_bool); name the "
                   "folder that holds the scenes")
    cscd = measured_program(f"some {3 * (len(caches) or len(steps))} minutes")
    if steps:
        install("real")
        made = ROOT / ".cache" / "real"
        made.mkdir(parents=True, exist_ok=True)
        caches = [converted(step, cscd, made) for step in steps]
    with new_results("real") as folder:
        for cache in caches:
            call(cscd, "run", "--input", cache, "--strategy", STRATEGIES, "--elementary", "filtered_exact", "--repetitions",
                 options.repetitions, "--json", folder / f"{cache.stem}.json.gz")
        call(cscd, "tables", folder, "--no-claims", "--out", folder)  # no claim of the paper is about these steps
        (folder / "tables.json.gz").write_bytes(gzip.compress((folder / "tables.json").read_bytes(), mtime=0))
        (folder / "tables.json").unlink()
