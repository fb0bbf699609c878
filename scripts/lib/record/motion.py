"""Measures what the true motion of characters costs, and where straight lines between frames answer differently.

  scripts/record motion                       the scenes that a model file can hold
  scripts/record motion ../shared/models      and every character below that folder

The six scenes are exported as model files; those that no skin of a model file describes are left out by name. At 12, 24, 30 and 60
frames a second `cscd query --true-motion` asks each interval about straight lines and then about the true motion, in one process, so
that the ratio of both times holds also where the machine has other work. Writes the record and its page to a new folder
results/DATE-MACHINE-COMMIT-motion. With the characters of this project it takes some 20 minutes on 2 idle cores.
"""
import gzip
import json
import pathlib
import subprocess
import tempfile

from markdown import built, number, table
from motion_table import rate_table, ratio
from script import SCENES, answer_of, existing_folder, measured_program, new_results, parser_of, refuse

SCHEMA = "cscd.motion/1"
RATES = (12, 24, 30, 60)  # frames a second
MODELS = (".glb", ".gltf", ".fbx", ".dae", ".x")
STRAIGHT = ("clear", "touches", "intersects_at_start", "undecided")
TRUE = ("clear", "touches", "close", "undecided", "intersects_at_start")


def counted(verdicts, kinds):
    return {kind: verdicts.count(kind) for kind in kinds}


def row_of(answer, fps):
    """What one answer comes to. Of intervals that start crossed the true motion is not asked, and their times count in `whole` alone: what
    all is about straight lines, from the preparation of the surface to the depth of what crosses."""
    intervals = [(clip, interval) for clip in answer.get("clips", [answer]) for interval in clip["intervals"]]
    asked = [interval for _, interval in intervals if interval["true_motion"]["parts"] > 0]
    summaries = [clip["summary"]["ms"] for clip in answer.get("clips", [answer])]
    return {
        "fps": fps, "intervals": len(intervals), "asked": len(asked),
        "straight": counted([i["verdict"] for _, i in intervals], STRAIGHT),
        "true": counted([i["true_motion"]["verdict"] for _, i in intervals], TRUE),
        "differ": [{"clip": clip_name(clip), "frame": interval["frame"], "from": interval["true_motion"]["from"],
                    "straight": interval["verdict"], "true": interval["true_motion"]["verdict"]}
                   for clip, interval in intervals if interval["true_motion"]["differs"]],
        "ms": {"straight": sum(i["ms"]["wall"] for i in asked), "true": sum(i["true_motion"]["ms"] for i in asked),
               "whole": sum(ms[part] for ms in summaries for part in ("preparation", "load", "wall", "overlap"))}}


def clip_name(clip):
    about = clip["import"]
    return about["clips"][about["clip"]]["name"]


def subject_of(cscd, model, name, is_scene, rates):
    """A model at all rates, or why it is left out."""
    rows = []
    for fps in rates:
        words = [str(cscd), "query", str(model), "--clip", "all", "--true-motion", "--fps", str(fps), "--json", "-"]
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode != 0:
            return None, {"model": name, "why": said(done, model)}
        answer = json.loads(done.stdout)
        rows.append(row_of(answer, fps))
        print(f"{name}, {fps} frames a second: {rows[-1]['asked']} of {rows[-1]['intervals']} intervals asked, "
              f"{len(rows[-1]['differ'])} differ", flush=True)
    return {"model": name, "scene": is_scene, "triangles": answer["import"]["chosen_triangles"], "rates": rows}, None


def said(done, model):
    """What a command refuses, without the name of a folder."""
    lines = [line.removeprefix("cscd: ") for line in done.stderr.splitlines() if line.startswith("cscd: ")]
    return (lines or [f"exit status {done.returncode}"])[0].replace(str(model), pathlib.PurePath(model).name)


def differing(record):
    return [f"{s['model']}, clip {d['clip']}, {row['fps']} frames a second, frame {number(d['frame'])}: straight lines say `{d['straight']}`, "
            f"the true motion says `{d['true']}`" for s in record["subjects"] for row in s["rates"] for d in row["differ"]]


def page(record):
    environment = record["environment"]
    lines = ["# The true motion of characters", "",
             "Made by `scripts/record motion` from the record beside it. Each interval is asked about straight lines and then about the true "
             "motion, in one process, by `cscd query --true-motion`. An interval that starts crossed is not asked about the true motion.",
             "", f"Measured on {built(environment)}; the load of the machine was {environment['load_average'][0]:.1f} at the start. "
             "Where that is above 1, other work shared the machine: compare ratios, whose two sides were asked in turns, and not times."
             + (" A smoke run: times mean nothing." if record["smoke"] else ""), "", *rate_table(record), "", "## Answers that differ", ""]
    lines += [f"- {line}" for line in differing(record)] or ["None."]
    lines += ["", "## Model by model", ""]
    lines += table(["model", "triangles", "frames a second", "asked", "straight: touch", "true: touch", "close", "undecided", "differ",
                    "straight, ms", "true, ms", "ratio"],
                   [[s["model"], str(s["triangles"]), str(row["fps"]), f"{row['asked']} of {row['intervals']}",
                     *(str(n) for n in (row["straight"]["touches"], row["true"]["touches"], row["true"]["close"], row["true"]["undecided"],
                                        len(row["differ"]))),
                     number(row["ms"]["straight"]), number(row["ms"]["true"]), number(ratio([row]))]
                    for s in record["subjects"] for row in s["rates"]])
    if record["left_out"]:
        lines += ["", "## Left out", "", *(f"- {one['model']}: {one['why']}" for one in record["left_out"])]
    return "\n".join(lines) + "\n"


def measured(cscd, models, scenes, rates, smoke):
    run = answer_of(cscd, "run", "--scene", "urchin", "--strategy", "base", "--frames", "0:1", "--repetitions", "1")
    record = {"schema": SCHEMA, "environment": run["environment"], "smoke": smoke, "rates": list(rates), "subjects": [], "left_out": []}

    def add(model, name, is_scene):
        subject, left_out = subject_of(cscd, model, name, is_scene, rates)
        record["subjects"] += [subject] if subject else []
        record["left_out"] += [left_out] if left_out else []

    for model in models:
        add(model, model.name, False)
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            model = pathlib.Path(folder) / f"{scene}.glb"
            done = subprocess.run([str(cscd), "export", scene, str(model)], capture_output=True, text=True)
            if done.returncode != 0:
                record["left_out"].append({"model": scene, "why": said(done, scene)})
            else:
                add(model, scene, True)
    if not any(row["asked"] for subject in record["subjects"] for row in subject["rates"]):
        refuse("no interval of any model was asked; name a folder of models that move and do not cross all the time")
    return record


def main():
    parser = parser_of(__doc__)
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path, nargs="?", help="characters, in it and in folders below it")
    parser.add_argument("--rates", default=",".join(map(str, RATES)), help="frames a second, with commas; default %(default)s")
    parser.add_argument("--smoke", action="store_true", help="seconds: two scenes; times mean nothing")
    parser.add_argument("--program", metavar="FILE", type=pathlib.Path, help="a cscd that is built; default is to build it")
    parser.add_argument("--out", metavar="FOLDER", type=pathlib.Path, help="where the record goes; default a new folder below results")
    options = parser.parse_args()
    models = sorted(path for path in existing_folder(options.folder).rglob("*") if path.suffix.lower() in MODELS) if options.folder else []
    if options.folder and not models:
        refuse(f"{options.folder}: holds no model ({', '.join(MODELS)})")
    try:
        rates = [int(rate) for rate in options.rates.split(",")]
    except ValueError:
        refuse(f"--rates {options.rates}: is no list of whole numbers with commas, such as 12,24")
    cscd = (options.program or measured_program("seconds" if options.smoke else "20 minutes")).resolve()

    def write(folder):
        record = measured(cscd, models, ["urchin", "hand"] if options.smoke else SCENES, rates, options.smoke)
        (folder / "motion.json.gz").write_bytes(gzip.compress(json.dumps(record).encode(), mtime=0))
        (folder / "motion.md").write_text(page(record))

    if options.out:
        write(existing_folder(options.out))
    else:
        with new_results("motion" + "-smoke" * options.smoke) as folder:
            write(folder)
