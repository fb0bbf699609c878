"""Measures what every elementary test gets wrong and what accuracy costs.

  scripts/record accuracy

Asks every elementary test the same queries: of scenes, of the open query set, of hard families (`cscd accuracy`). Writes the record,
and the tables, charts and page of `scripts/figures accuracy`, to a new folder results/DATE-MACHINE-COMMIT-accuracy. Installs what is
missing from Debian's packages, and takes some ten minutes on 2 idle cores when everything is built.
"""
import os
import pathlib

from script import ROOT, SCENES, call, measured_program, new_results, parser_of, refuse

CONTACTS = [f"{scene}_contact" for scene in SCENES]
SWEEP = [*(f"cubic@{tolerance}" for tolerance in ("0", "1e-12", "1e-10", "1e-8", "1e-6", "1e-5", "1e-4", "1e-3")),
         *(f"inclusion@{tolerance}" for tolerance in ("1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-8", "1e-6:200000")),
         *(f"additive@{gap}" for gap in ("0.5", "0.2", "0.1", "0.05", "0.01", "0.001"))]
FULL = ["--scene", ",".join([*SCENES, *CONTACTS]), "--every", "16", "--scene-queries", "2000000", "--hard-queries", "2000",
        "--random-queries", "100", "--sweep-queries", "200", "--passes", "1", "--sweep", ",".join(SWEEP)]
SMOKE = ["--smoke", "--scene", "hand_contact", "--every", "60", "--sweep", "cubic@1e-9,cubic@1e-3,inclusion@1e-3,inclusion@1e-5"]


def query_set(named):
    """The folder of the open query set, or None where there is none."""
    folders = [pathlib.Path(named)] if named else [above / "shared" / "queries" for above in ROOT.parents]
    found = next((folder for folder in folders if (folder / "index.csv").exists()), None)
    if named and not found:
        refuse(f"{named}: holds no index.csv, so it is no open query set")
    return found


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--smoke", action="store_true", help="a few minutes: shows that everything works; times mean nothing")
    parser.add_argument("--set", default=os.environ.get("CSCD_QUERIES"), metavar="FOLDER",
                        help="the open query set, with its index.csv; default $CSCD_QUERIES, or shared/queries in a folder above")
    options = parser.parse_args()
    queries = query_set(options.set)
    cscd = measured_program("a few minutes" if options.smoke else "some ten minutes")
    with new_results("accuracy-smoke" if options.smoke else "accuracy") as folder:
        words = [*(SMOKE if options.smoke else FULL), *(["--set", queries] if queries else [])]
        call(cscd, "accuracy", *words, "--json", folder / "accuracy.json.gz")
        call(ROOT / "scripts" / "figures", "accuracy", folder / "accuracy.json.gz", "--program", cscd, "--out", folder)
