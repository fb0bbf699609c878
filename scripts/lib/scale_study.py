"""Studies of `cscd scale` that take point caches beside scenes: scripts/record thickness and solver."""
import json
import pathlib

from script import ROOT, call, existing_folder, measured_program, new_results, parser_of, refuse


def measure_study(description, study, kind, duration):
    """Measures a study on its planned scenes, or those that are named, and writes record and page to a new folder of results."""
    parser = parser_of(description)
    parser.add_argument("--smoke", action="store_true", help="less than a minute: shows that everything works; times mean nothing")
    parser.add_argument("--scene", metavar="NAMES", help="scenes and point caches with commas; default those of the plan")
    parser.add_argument("--real", metavar="FOLDER", type=pathlib.Path, help="a folder of point caches")
    options = parser.parse_args()
    caches = sorted(existing_folder(options.real).glob("*.h5")) if options.real else []
    if options.real and not caches:
        refuse(f"--real {options.real}: holds no point cache (.h5)")
    cscd = measured_program("a minute" if options.smoke else duration)
    plan = json.loads((ROOT / "bench" / "measure" / "studies" / "scale_plan.json").read_text())["smoke" if options.smoke else "full"]
    scenes = [*(options.scene.split(",") if options.scene else plan[f"{study}_scenes"]), *map(str, caches)]
    with new_results(kind + "-smoke" * options.smoke) as folder:
        call(cscd, "scale", "--study", study, *(["--smoke"] if options.smoke else []), "--scene", ",".join(scenes), "--json",
             folder / "scale.json.gz")
        call(ROOT / "scripts" / "figures", "scale", folder / "scale.json.gz", "--program", cscd, "--out", folder)
