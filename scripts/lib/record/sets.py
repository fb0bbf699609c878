"""Measures the engine on every instruction set, and in Node, side by side.

  scripts/record sets
  scripts/record sets --scene rope,fold    of these scenes alone
  scripts/record sets --paper              and what the paper's method takes on plain x86-64 and on AVX2

The library for AVX-512, AVX2 and plain x86-64 and its package for WebAssembly answer the same steps of the six scenes and of four
cloths, in turns; answers that differ in a bit end the script with status 1. With --paper, `cscd run` holds `drvbc_fast` against the
paper's method on the six scenes. Writes the record, and its page, to a new folder results/DATE-MACHINE-COMMIT-sets. Takes a quarter of
an hour on 2 idle cores when everything is built, and ten minutes to build; --paper doubles both.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile

from looks import LOOKS
from markdown import built, number, table
from script import ROOT, SCENES, call, install, measured_program, new_results, output_of, parser_of, with_setup

CLOTHS = ("sheet", "fold", "skirt", "bag")
SETS = ("avx512", "avx2", "baseline")
NODE = "node"
TITLES = {"avx512": "AVX-512", "avx2": "AVX2", "baseline": "SSE2", NODE: "Node"}
COLUMNS = (("avx512", "avx2"), ("baseline", "avx2"), (NODE, "baseline"))
PAPER, FAST = "drvbc", "drvbc_fast"
TESTS = ROOT / "library" / "js" / "test"
LIBRARY, PROGRAM = ROOT / "build-isas", ROOT / "build-sets"


def environment_of(name):
    """The environment in which the Python module and the program take a set."""
    return os.environ | {"PYTHONPATH": str(LIBRARY / "python"), "CSCD_ISA": name}


def has(name):
    """Whether this machine and this build have a set. The library refuses others when it is first used."""
    done = output_of("/usr/bin/python3", "-c", "import sys\ntry:\n import cscd; cscd.SelfCollision([[0, 1, 2]], [[0, 0, 0], [1, 0, 0], [0, 1, 0]])\n"
                     "except Exception as error:\n print(error)", env=environment_of(name))
    return not done


def answer(name, clip, passes):
    if name == NODE:
        return json.loads(output_of("node", ROOT / "build-wasm" / "js" / "test" / "digest.mjs", clip, passes))
    return json.loads(output_of("/usr/bin/python3", TESTS / "digest.py", clip, passes, env=environment_of(name)))


def measured(cscd, scene, sets, steps, rounds, folder):
    """Milliseconds by question and set: medians over rounds. All sets have to give the same answers."""
    clip, rows, digests = folder / f"{scene}.bin", {}, {}
    output_of("/usr/bin/python3", TESTS / "digest.py", clip, 0, cscd, scene, 0, steps, env=environment_of(sets[0]))
    for turn in range(rounds):
        for name in sets if turn % 2 == 0 else sets[::-1]:
            said = answer(name, clip, 3)
            digests[name] = said["digest"]
            for question, ms in said["ms"].items():
                rows.setdefault(question, {}).setdefault(name, []).append(ms)
    clip.unlink()
    if len(set(digests.values())) > 1:
        print(f"{scene}: other answers on other sets: {digests}", file=sys.stderr)
        sys.exit(1)
    print(f"{scene}: the same answers on {', '.join(sets)}", flush=True)
    return {question: {name: statistics.median(values) for name, values in by.items()} for question, by in rows.items()}


def against_paper(scene, name, folder, smoke):
    """A record of `cscd run` on one set."""
    path = folder / "run.part.json"
    call(PROGRAM / "cscd", "run", "--scene", scene, "--strategy", f"{PAPER},{FAST}", "--json", path, "--force",
         *(["--smoke"] if smoke else []), env=environment_of(name), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    record = json.loads(path.read_text())
    path.unlink()
    return record


def query_ms(row):
    """The median interval of a strategy's row in a record: what its stages take together, in the median repetition."""
    stages = [row["ms"][stage] for stage, *_ in LOOKS["stages"]]  # each [repetitions][intervals]
    passes = [[sum(parts) for parts in zip(*(stage[r] for stage in stages))] for r in range(len(stages[0]))]
    return statistics.median(statistics.median(interval) for interval in zip(*passes))


def ratio(by, over, under):
    return by[over] / by[under] if over in by and under in by else None


def spread(values):
    """The median over scenes and the largest, or a dash."""
    found = [value for value in values if value is not None]
    return f"{statistics.median(found):.2f} ({max(found):.2f})" if found else "–"


def page(data):
    sets, scenes = data["sets"], data["scenes"]
    questions = list(dict.fromkeys(question for by in scenes.values() for question in by))
    columns = [pair for pair in COLUMNS if set(pair) <= set(sets)]
    heads = [f"{TITLES[over]} over {TITLES[under]}" for over, under in columns]
    lines = ["# What the instruction set costs", "",
             f"`scripts/record sets`: {built(data['environment'])}."
             + (" A smoke run: times mean nothing." if data["smoke"] else ""), "",
             f"{', '.join(TITLES[name] for name in sets)} answered the same steps in turns, {data['rounds']} times, with the same answers to the "
             "last bit. A time is the median over steps of the least processor time of a step, and then over turns. With a thickness: a tenth of "
             "the mean edge.", "", "## Ratios of times, the median over scenes (the largest)", "",
             *table(["question", *heads], [[question, *(spread(ratio(by[question], *pair) for by in scenes.values()) for pair in columns)]
                                           for question in questions]), ""]
    for question in questions:
        rows = [[scene, number(by[question].get("avx2")), *(number(ratio(by[question], *pair)) for pair in columns)]
                for scene, by in scenes.items()]
        lines += [f"## {question[0].upper()}{question[1:]}", "", *table(["scene", "AVX2, ms", *heads], rows), ""]
    if data["paper"]:
        names = list(next(iter(data["paper"].values())))
        lines += ["## The paper's method over the fast engine", "", f"`{PAPER}` over `{FAST}`, milliseconds a query and their ratio, as `cscd run` "
                  "takes and verifies them.", "",
                  *table(["scene", *(f"{TITLES[name]}: {what}" for name in names for what in (f"`{PAPER}`", f"`{FAST}`", "ratio"))],
                         [[scene, *(number(value) for name in names for value in (*by[name], by[name][0] / by[name][1]))]
                          for scene, by in data["paper"].items()]), ""]
    return "\n".join(lines)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--scene", metavar="NAMES", help="scenes with commas; default the six and four cloths")
    parser.add_argument("--paper", action="store_true", help="the paper's method, too")
    parser.add_argument("--smoke", action="store_true", help="a few steps: shows that everything works; times mean nothing")
    options = parser.parse_args()
    chosen = options.scene.split(",") if options.scene else [*SCENES, *CLOTHS]
    install("tests")
    cscd = measured_program("a quarter of an hour")
    for folder, settings, target in ((LIBRARY, "-DCSCD_LIBRARY_ONLY=ON", "cscd_python"), (PROGRAM, "-DCSCD_ALL_ISAS=ON", "cscd")):
        if folder == LIBRARY or options.paper:
            with_setup(f"cmake -S . -B {folder.name} -G Ninja -DCMAKE_BUILD_TYPE=Release {settings} >/dev/null; ninja -C {folder.name} {target}",
                       stdout=sys.stderr)
    call(ROOT / "scripts" / "check", "wasm")
    sets = [name for name in SETS if has(name)] + [NODE]
    data = {"schema": "cscd.sets/1", "smoke": options.smoke, "rounds": 1 if options.smoke else 3, "sets": sets, "scenes": {}, "paper": {}}
    with new_results("sets" + "-smoke" * options.smoke) as folder, tempfile.TemporaryDirectory() as part:
        for scene in chosen:
            data["scenes"][scene] = measured(cscd, scene, sets, 4 if options.smoke else 40, data["rounds"], type(folder)(part))
        for scene in (name for name in chosen if options.paper and name in SCENES):
            by = data["paper"].setdefault(scene, {})
            for name in [name for name in sets if name in ("avx2", "baseline")]:
                record = against_paper(scene, name, folder, options.smoke)
                times = {row["name"]: row for row in record["strategies"]}
                by[name] = [query_ms(times[row]) for row in (PAPER, FAST)]
            print(f"{scene}: against the paper's method", flush=True)
        probe = folder / "probe.part.json"  # says where this is measured
        call(cscd, "run", "--scene", "urchin", "--smoke", "--strategy", FAST, "--json", probe, stdout=subprocess.DEVNULL,
             stderr=subprocess.DEVNULL)
        data["environment"] = json.loads(probe.read_text())["environment"]
        probe.unlink()
        (folder / "sets.json").write_text(json.dumps(data, indent=1) + "\n")
        (folder / "sets.md").write_text(page(data))
