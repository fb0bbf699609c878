"""Links a program in two orders: its bytes have to differ, and its answers must not.

  scripts/check layouts BUILD     BUILD is a ninja folder in which cscd is built
"""
import pathlib
import shutil

from layouts import link_layout
from script import output_of, parser_of


def main():
    parser = parser_of(__doc__)
    parser.add_argument("build", type=pathlib.Path)
    build = parser.parse_args().build
    programs = [link_layout(build, seed) for seed in (901, 902)]
    same_bytes = programs[0].read_bytes() == programs[1].read_bytes()
    answers = {output_of(program, "verify", "--intervals", 5) for program in programs}
    for program in programs:
        shutil.rmtree(program.parent, ignore_errors=True)
    if same_bytes or len(answers) > 1:
        print("two layouts have the same bytes" if same_bytes else "two layouts answer differently")
        return 1
    print("two layouts differ in their bytes and answer alike")
    return 0
