"""Measures what a thickness costs: on the scenes, on cloth, and on steps of real simulations.

  scripts/record thickness
  scripts/record thickness --real ../shared/real     and on every point cache (.h5) of that folder

`base`, whose boxes grow by the thickness, `drvbc_fast` and `drvbc_fast_complete` answer the same intervals at thicknesses from 0 to 1 mean
edge. Every answer is held against `base` with the exact test before it is timed (`cscd scale --study thickness`). Writes the record, and
its page, to a new folder results/DATE-MACHINE-COMMIT-thickness. Takes a quarter of an hour on 2 idle cores when everything is built, most of it `base`.
"""
import json
import pathlib

from script import ROOT, call, existing_folder, measured_program, new_results, parser_of, refuse


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--smoke", action="store_true", help="less than a minute: shows that everything works; times mean nothing")
    parser.add_argument("--scene", metavar="NAMES", help="scenes and point caches with commas; default the six, and cloth")
    parser.add_argument("--real", metavar="FOLDER", type=pathlib.Path, help="a folder of point caches")
    options = parser.parse_args()
    caches = sorted(existing_folder(options.real).glob("*.h5")) if options.real else []
    if options.real and not caches:
        refuse(f"--real {options.real}: holds no point cache (.h5)")
    cscd = measured_program("a minute" if options.smoke else "a quarter of an hour")
    plan = json.loads((ROOT / "bench" / "measure" / "studies" / "scale_plan.json").read_text())["smoke" if options.smoke else "full"]
    scenes = [*(options.scene.split(",") if options.scene else plan["thickness_scenes"]), *map(str, caches)]
    with new_results("thickness" + "-smoke" * options.smoke) as folder:
        call(cscd, "scale", "--study", "thickness", *(["--smoke"] if options.smoke else []), "--scene", ",".join(scenes), "--json",
             folder / "scale.json.gz")
        call(ROOT / "scripts" / "figures", "scale", folder / "scale.json.gz", "--program", cscd, "--out", folder)
