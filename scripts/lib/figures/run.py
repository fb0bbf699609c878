"""Draws the paper's Figures 11 and 12 from records of `cscd run`.

  scripts/figures results/FOLDER --out FOLDER
  scripts/figures rope.json.gz --strategy base,aabb,drvbc_fast --out FOLDER

For every scene: SCENE-bvot (the paper's Figure 11) and SCENE-pctp (Figure 12), with the paper's four curves (Base, MCD, RVBC, DRVBC) or
those that --strategy names, and beside them the paper's means. Counters are the same in both pipelines.

RECORDS are files, or folders, in which records of other kinds are passed over. Every figure is a PNG and a PDF file whose text is text; the same
records give the same bytes. Times of stages are on the page that `cscd report` writes.
"""
import pathlib
import re

from charts import RED, label_ends, line_style, plt, save, spans_decades
from looks import LOOKS
from published import PAPER, over
from records import document_of
from script import made_folder, parser_of, program_option, refuse

PAPERS = ("base", "mcd", "rvbc", "drvbc")  # the curves of the paper's Figures 11 and 12
DISPLAYED = {"base": "Base", "mcd": "MCD", "rvbc": "RVBC", "drvbc": "DRVBC"}  # as the paper calls them


def paper_mean(scene, counter, strategy):
    """The paper's mean number an interval, as a range: its tables give this method's and RVBC's in thousands, and ratios with
    two decimals to the others. None where it gives none."""
    row = PAPER["table3"].get(scene)
    key = {"bvot": "bv", "pctp": "pctp"}.get(counter)
    if row is None or key is None:
        return None
    if strategy in row:
        return (1000 * (row[strategy][key] - 0.05), 1000 * (row[strategy][key] + 0.05))
    ratio = PAPER["table2"][scene].get(f"{counter}_over_{strategy}")
    drvbc = 1000 * row["drvbc"][key]
    return None if ratio is None else over(drvbc, ratio, 2)


def draw_counter(record, counter, folder, strategies):
    """One curve a strategy over the intervals. Beside the curves, the mean that the paper gives."""
    rows = {s["name"]: s["counts"][counter] for s in record["strategies"] if counter in s["counts"]}
    names = [strategy for strategy in strategies if strategy in rows]
    if not names:
        return
    scene = plain(record["scene"])
    means = {strategy: mean for strategy in names if not record["own"]
             and (mean := paper_mean(scene, counter, strategy)) is not None}
    figure, axes = plt.subplots(figsize=(7, 3.4))
    intervals = record["counted_intervals"]
    for touching in record["colliding"]:
        axes.axvspan(touching - 0.5, touching + 0.5, color=RED, alpha=0.12, lw=0, zorder=0)
    for strategy in names:
        axes.plot(intervals, rows[strategy], lw=1.3, **line_style(strategy))
    values = [value for strategy in names for value in rows[strategy]] + [end for mean in means.values() for end in mean]
    if spans_decades(values):
        axes.set_yscale("symlog" if min(values) == 0 else "log")
    if min(values) == 0:
        axes.set_ylim(bottom=0)
    axes.set_xlabel("interval" + ("; shaded: verified intervals with contacts" if record["colliding"] else ""))
    axes.set_ylabel(dict(LOOKS["counters"])[counter])
    axes.set_title(scene, fontsize=9)
    first, last = intervals[0], max(intervals[-1], intervals[0] + 1)
    axes.set_xlim(first, last)
    figure.get_layout_engine().set(rect=(0, 0, 0.82, 1))  # room for the names
    if means:
        beside = axes.get_yaxis_transform()  # across: shares of the axes' width; up: data
        for strategy, (low, high) in means.items():
            middle = (low * high) ** 0.5
            axes.plot([1.025, 1.025], [min(low, middle * 0.97), max(high, middle * 1.03)], transform=beside, lw=5,
                      color=line_style(strategy)["color"], solid_capstyle="butt", clip_on=False)
        axes.text(1.025, -0.02, "paper's\nmean", transform=axes.transAxes, fontsize=7, ha="center", va="top")
    ends = [(intervals[-1], rows[s][-1], DISPLAYED.get(s, s), line_style(s)["color"]) for s in names]
    label_ends(axes, ends, room=30 if means else 0)
    save(figure, folder, f"{scene}-{counter}", pdf=True)


def plain(name):
    """A scene's name as part of a file's name. A record may call its scene anything, even by a path."""
    stem = name.rsplit("/", 1)[-1]
    return re.sub(r"[^\w.-]|^[.-]", "_", stem)[:64] or "unnamed"


def main():
    parser = parser_of(__doc__)
    parser.add_argument("records", nargs="+", type=pathlib.Path, metavar="RECORDS")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="the folder, which is made where it is missing")
    program_option(parser)
    parser.add_argument("--strategy", help="the curves, with commas between; default " + ",".join(PAPERS))
    arguments = parser.parse_args()
    folder = made_folder(arguments.out)
    records = document_of(arguments.program, *arguments.records)["records"]
    scenes = {record["scene"]: record for record in sorted(records, key=lambda record: record["pipeline"] == "today")}  # has more rows
    chosen = arguments.strategy.split(",") if arguments.strategy else PAPERS
    for name in chosen if arguments.strategy else ():
        if not any(s["name"] == name for record in scenes.values() for s in record["strategies"]):
            refuse(f"--strategy {name}: in no record that was given; choose another")
    for record in scenes.values():
        for counter in ("bvot", "pctp"):
            draw_counter(record, counter, folder, chosen)
