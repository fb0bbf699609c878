"""Draws charts and writes the page of how cost grows, from a record of `cscd scale`.

  scripts/figures scale RECORD.json.gz --out FOLDER

scale.md       a page: how cost grows, and where it grows badly
scale-size     time against triangles, scene by scene, with fitted exponents
scale-stages   each stage of the first strategy against triangles
scale-pairs    overlap tests and triangle pairs against triangles
scale-memory   bytes a triangle against triangles
scale-step     time against the length of the step
scale-bones    time against bones (where the record has them)
scale-threads  how many times as fast on more threads (where the record has them)
scale-small    time against how far small steps move (where the record has them)
scale-contacts time of the variants with contacts over that of the scenes (where the record has them)
A chart shows at most eight rows, unless --all asks for all of them. The figures are PNG files; the same record gives the same
bytes.
"""
import pathlib

import scale_charts
from scale_page import CONTACTS, page
from scale_record import Record
from script import made_folder, parser_of, program_option


def main():
    parser = parser_of(__doc__)
    parser.add_argument("record", type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path, help="the folder, which is made where it is missing")
    program_option(parser)
    parser.add_argument("--all", action="store_true", help="all rows in every chart")
    arguments = parser.parse_args()
    made_folder(arguments.out)
    record = Record(arguments.record, arguments.program)
    drawn = scale_charts.draw_all(record, arguments.out, arguments.all, CONTACTS)
    (arguments.out / "scale.md").write_text(page(record, drawn))
