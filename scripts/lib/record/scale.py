"""Measures how time and memory grow with triangles, length of the step, bones, threads and contacts.

  scripts/record scale
  scripts/record scale --largest     triangles alone, but up to 3.1 million, in an hour and a half: nearly all of it is preparation
                                     and the complete reference; it needs 5 GB of memory

Verifies every answer before it is timed (`cscd scale`). Writes the record, and the charts and page of `scripts/figures scale`, to a
new folder results/DATE-MACHINE-COMMIT-scale. Installs what is missing from Debian's packages, and takes up to an hour on 2 idle cores
when everything is built.
"""

from script import ROOT, call, measured_program, new_results, parser_of


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--smoke", action="store_true", help="less than a minute: shows that everything works; times mean nothing")
    parser.add_argument("--largest", action="store_true", help="large surfaces alone")
    parser.add_argument("--scene", metavar="NAMES", help="scenes with commas; default the six, and cloth for contacts")
    options = parser.parse_args()
    words = [*(["--smoke"] if options.smoke else []), *(["--largest", "--study", "size"] if options.largest else []),
             *(["--scene", options.scene] if options.scene else [])]
    cscd = measured_program(
        "a minute" if options.smoke else "an hour and a half, with 5 GB of memory," if options.largest else "an hour")
    with new_results("scale" + "-smoke" * options.smoke + "-largest" * options.largest) as folder:
        call(cscd, "scale", *words, "--json", folder / "scale.json.gz")
        call(ROOT / "scripts" / "figures", "scale", folder / "scale.json.gz", "--program", cscd, "--out", folder)
