"""Compares two commits in preparation, all contacts, contacts, long steps and threads.

  scripts/record latency BASE          BASE and the last commit, in turns
  scripts/record latency BASE HEAD --blocks 2

Both commits are built below .cache/commits. `cscd scale` of either measures one scene after the other, in blocks A B B A, and
verifies every answer before it times it. The page holds medians over the blocks, and ratios of neighbouring measurements with
the smallest and the largest; it is written to a new folder results/DATE-MACHINE-COMMIT-latency. On 2 cores it takes about twenty
minutes a block beside ten to build each commit.

Exit status: 0 the page is written, 1 an answer was wrong, 2 it could not run.
"""
import datetime
import json
import statistics
import sys

from commits import CACHE, Build, commit_named, held_lock
from markdown import built, number, table
from script import ROOT, SCENES, new_results, parser_of, refuse

FIRST, ALL, KNOWN, EARLIEST = "drvbc_fast", "drvbc_fast_complete", "drvbc_fast_all", "drvbc_fast --first"
LONG = 16  # frame steps
SMALL, LARGE = 48000, 194000
THREAD_SCENES = json.loads((ROOT / "bench" / "measure" / "studies" / "scale_plan.json").read_text())["full"]["thread_scenes"]


def commands(scene, smoke, has_known):
    """The calls of `cscd scale` for one scene. Old programs have no row for all contacts of starts that are known."""
    sizes = [12000, 24000] if smoke else [SMALL, LARGE]
    few = ["--intervals", "1", "--repetitions", "1"] if smoke else []
    rows = ",".join([FIRST, ALL, EARLIEST, *([KNOWN] if has_known else [])])
    yield ["--study", "size", "--sizes", ",".join(map(str, sizes)), "--strategy", f"{FIRST},{ALL}", *few]
    yield ["--study", "size", "--sizes", ",".join(map(str, sizes)), "--strategy", FIRST, "--threads", "2", "--intervals", "1",
           "--repetitions", "1"]
    # One after the other: covers that have followed a long step are others than those of a clip.
    yield ["--study", "step,contacts", "--steps", "1", "--strategy", rows, *few]
    yield ["--study", "step", "--steps", str(LONG), "--strategy", FIRST, *few]
    if scene in THREAD_SCENES:
        yield ["--study", "threads", "--strategy", f"{FIRST},{ALL}", *few]


def milliseconds(step, strategy, key="total"):
    row = next((s for s in step["strategies"] if s["name"] == strategy), None)
    return row["ms"].get(key) if row and "ms" in row else None


def figures(records):
    """What one side took for one scene, by name. Names that end in "over ..." are ratios, the others milliseconds."""
    out = {}
    for record in records:
        sizes = sorted({s["triangles"] for s in record["subjects"] if s["study"] == "size"})
        one = {s["threads"]: s for s in record["subjects"] if s["study"] == "threads"}
        for subject in record["subjects"]:
            steps, study = subject["steps"], subject["study"]
            made = {s["name"]: s["make_ms"] for s in subject["strategies"]}
            if study == "size":
                name = "small" if subject["triangles"] == sizes[0] else "large"
                threads = subject["threads"]
                out[f"preparation, {name}, threads {threads}"] = made[FIRST]
                if threads == 1:
                    out[f"all over first, {name}"] = ratio(milliseconds(steps[0], ALL), milliseconds(steps[0], FIRST))
            elif study == "step":
                by_length = {s["step"]: s for s in steps}
                if 1 in by_length:
                    out["query"] = milliseconds(by_length[1], FIRST)
                    out["all over first, own"] = ratio(milliseconds(by_length[1], ALL), milliseconds(by_length[1], FIRST))
                    out["known over first, own"] = ratio(milliseconds(by_length[1], KNOWN), milliseconds(by_length[1], FIRST))
                if LONG in by_length:
                    out["long step"] = milliseconds(by_length[LONG], FIRST)
            elif study == "contacts":
                plain, touching = steps
                for row in (FIRST, EARLIEST):
                    out[f"contacts over none, {row}"] = ratio(milliseconds(touching, row), milliseconds(plain, row))
            elif study == "threads" and subject["threads"] == 2:
                for row in (FIRST, ALL):
                    out[f"one thread over two, {row}"] = ratio(milliseconds(one[1]["steps"][0], row), milliseconds(steps[0], row))
    return {name: value for name, value in out.items() if value is not None}


def ratio(a, b):
    return a / b if a is not None and b else None


ROWS = [  # title, name
    ("preparation on one thread, about 48 thousand triangles, ms", "preparation, small, threads 1"),
    ("preparation on two threads, about 48 thousand triangles, ms", "preparation, small, threads 2"),
    ("preparation on one thread, about 194 thousand triangles, ms", "preparation, large, threads 1"),
    ("preparation on two threads, about 194 thousand triangles, ms", "preparation, large, threads 2"),
    (f"all contacts from any start (`{ALL}`) over the first contact (`{FIRST}`)", "all over first, own"),
    (f"all contacts from starts known to be embedded (`{KNOWN}`) over the first contact", "known over first, own"),
    ("all contacts from any start over the first contact, about 194 thousand triangles", "all over first, large"),
    (f"a query of `{FIRST}`, ms", "query"),
    (f"a query of `{FIRST}` with contacts over one without, all intervals", f"contacts over none, {FIRST}"),
    (f"a query of `{EARLIEST}` with contacts over one without, all intervals", f"contacts over none, {EARLIEST}"),
    (f"a step of {LONG} frames with `{FIRST}`, ms", "long step"),
    (f"time on one thread over time on two (more is better), `{FIRST}`, about 194 thousand triangles", f"one thread over two, {FIRST}"),
    (f"time on one thread over time on two (more is better), `{ALL}`, about 194 thousand triangles", f"one thread over two, {ALL}"),
]


def page(data):
    sides = data["sides"]
    lines = ["# Latency, before and after", "",
             f"`scripts/record latency {data['base'][:10]} {data['head'][:10]}`. Before: {sides['A']}.", "", f"After: {sides['B']}.", "",
             f"The two programs were measured in turns, {data['blocks']} times in the order before, after, after, before. Figures are medians. "
             "The last column divides each measurement of the older program by its neighbour of the newer one, and shows the median "
             "[smallest, largest]. Preparation finds clusters with bones. Where no number of triangles is named, it is the scene's own. "
             "Every answer was verified before it was timed. – means not measured: the older program has no such row, or the study of "
             f"threads, which is of {', '.join(THREAD_SCENES)} alone, leaves the scene out."
             + (" A smoke run: times mean nothing." if data["smoke"] else ""), "",
             "Queries take less time here than in records of kind *full* and *scale*, probably because slower rows are measured in between "
             "there, which drive the engine's data out of the caches. Compare before with after, and not this page with another.", ""]
    for title, name in ROWS:
        rows = []
        for scene in data["scenes"]:
            before, after = (data["samples"][scene][side] for side in "AB")
            medians = [statistics.median(values) if values else None
                       for values in ([one[name] for one in side if name in one] for side in (before, after))]
            quotients = [a[name] / b[name] for a, b in zip(before, after) if name in a and name in b]
            rows.append([scene, *map(number, medians),
                         f"{statistics.median(quotients):.2f} [{min(quotients):.2f}, {max(quotients):.2f}]" if quotients else "–"])
        lines += [f"## {title[0].upper()}{title[1:]}", "", *table(["scene", "before", "after", "before over after"], rows), ""]
    return "\n".join(lines)


def measured(build, scene, smoke, part):
    """The records of one side for one scene."""
    records = []
    has_known = KNOWN in build.run([build.program(0), "list", "strategies"]).stdout
    for words in commands(scene, smoke, has_known):
        record, status = build.record(0, "scale", scene, words, part)
        records.append(record)
        if status == 1 or not record["ok"]:
            print(f"{build.commit[:10]} on {scene}: an answer is wrong", file=sys.stderr)
            sys.exit(1)
    return records


def main():
    parser = parser_of(__doc__)
    parser.add_argument("base", metavar="BASE", help="the old commit")
    parser.add_argument("head", metavar="HEAD", nargs="?", default="HEAD", help="the new commit; default: the last one")
    parser.add_argument("--blocks", type=int, default=1, help="how many blocks A B B A; default 1")
    parser.add_argument("--scenes", default=",".join(SCENES), help="default the six")
    parser.add_argument("--smoke", action="store_true", help="small surfaces, in minutes; times mean nothing")
    options = parser.parse_args()
    if options.blocks < 1:
        refuse("--blocks: at least 1")
    scenes = options.scenes.split(",")
    base, head = commit_named(options.base), commit_named(options.head)
    lock = held_lock()  # noqa: F841  (held until the script ends)
    sides = {"A": Build(base, "times", [0]), "B": Build(head, "times", [0])}
    part = CACHE / "latency.part.json"
    data = {"schema": "cscd.latency/1", "date": datetime.date.today().isoformat(), "base": base, "head": head, "smoke": options.smoke,
            "blocks": options.blocks, "scenes": scenes, "sides": {},
            "samples": {scene: {"A": [], "B": []} for scene in scenes}}
    with new_results("latency-smoke" if options.smoke else "latency") as folder:
        for block in range(options.blocks):
            for scene in scenes:
                for side in "ABBA":
                    records = measured(sides[side], scene, options.smoke, part)
                    data["sides"][side] = built(records[0]["environment"])
                    if side == "B":
                        data["environment"] = records[0]["environment"]
                    data["samples"][scene][side].append(figures(records))
                print(f"block {block + 1}: {scene}", flush=True)
        part.unlink(missing_ok=True)
        (folder / "latency.json").write_text(json.dumps(data, indent=1) + "\n")
        (folder / "latency.md").write_text(page(data))
