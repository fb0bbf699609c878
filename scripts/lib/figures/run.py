"""Draws the paper's Figures 11 and 12 and the times of stages, from records of `cscd run`.

  scripts/figures results/FOLDER --out FOLDER
  scripts/figures rope.json.gz --strategy base,aabb,drvbc_fast --out FOLDER

For every scene: SCENE-bvot (the paper's Figure 11), SCENE-pctp (Figure 12), SCENE-nonpositive (triangles that are not
positive towards their observer, before and after merging where the record has both) and SCENE-stages, which shows both
pipelines where both records are given. From several scenes also stages: the time of every strategy on every scene.

RECORDS are files, or folders, in which only records of a run are read. Figures 11 and 12 have the paper's four curves (Base,
MCD, RVBC, DRVBC) or those that --strategy names, and beside them the paper's means. Times are shown of at most eight rows, unless --all asks for all. Every figure is a PNG and a PDF file
whose text is text; the same records give the same bytes.
"""
import math
import pathlib
import statistics

from charts import (START_TEST, STAGES, label_ends, left_out, line_style, matplotlib, plt, save, shown,
                    spans_decades)
from published import PAPER, over
from records import MARK_NOTE, mark_of, plain, read_records
from script import made_folder, parser_of, refuse

SCHEMA = "cscd.run/2"
TITLES = {START_TEST: "test of the start,\noutside the query", "total": "total\nwithout refit"}
SHORTEST = 0.01  # milliseconds: where the axis of times begins at the latest; shorter bars are numbers alone
PAPERS = ("base", "mcd", "rvbc", "drvbc")  # the curves of the paper's Figures 11 and 12
# The rows whose signs of triangles differ: before merging and after it, and past the paper.
SEEN_FROM_INSIDE = ("rvbc", "drvbc", "drvbc_unmerged", "drvbc_fast", "drvbc_fast_complete")

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


def draw_counter(record, counters, label, name, folder, strategies):
    """One curve a strategy over the intervals, of the sum of the counters; a strategy that lacks a counter has none. Beside the
    curves, the mean that the paper gives."""
    rows = {s["name"]: [sum(values) for values in zip(*(s["counts"][counter] for counter in counters))]
            for s in record["strategies"] if all(counter in s["counts"] for counter in counters)}
    names = [strategy for strategy in strategies if strategy in rows]
    if not names:
        return
    scene = plain(record["scene"]["name"])
    means = {strategy: mean for strategy in names if not record["scene"].get("path")
             and (mean := paper_mean(scene, counters[0], strategy)) is not None}
    figure, axes = plt.subplots(figsize=(7, 3.4))
    intervals = record["counted_intervals"]
    for touching in record["verification"]["colliding"]:
        axes.axvspan(touching - 0.5, touching + 0.5, color="#D55E00", alpha=0.12, lw=0, zorder=0)
    for strategy in names:
        axes.plot(intervals, rows[strategy], lw=1.3, **line_style(strategy))
    values = [value for strategy in names for value in rows[strategy]] + [end for mean in means.values() for end in mean]
    if spans_decades(values):
        axes.set_yscale("symlog" if min(values) == 0 else "log")
    if min(values) == 0:
        axes.set_ylim(bottom=0)
    axes.set_xlabel("interval" + ("; shaded: verified intervals with contacts" if record["verification"]["colliding"] else ""))
    axes.set_ylabel(label)
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
    save(figure, folder, f"{scene}-{name}", pdf=True)


def mean_stage(strategy, stage):
    """Mean over intervals, median over repetitions, as in the tables; None for a stage that the strategy does not have."""
    if stage not in strategy["ms"]:
        return None
    return statistics.median(statistics.fmean(repetition) for repetition in strategy["ms"][stage])


def total_of(strategy):
    return sum(mean_stage(strategy, stage) or 0 for stage in STAGES)


def paper_stage(scene, strategy, stage):
    """What the paper gives for a stage, in milliseconds, or None. A total may be a speedup times the total of its method."""
    table2 = PAPER["table2"].get(scene, {})
    if stage == "total" and f"speedup_{strategy}" in table2:
        return table2[f"speedup_{strategy}"] * table2["query_ms"]
    if stage == "refit":
        return PAPER["text"]["refit_ms"].get(scene) if strategy in PAPERS else None
    return PAPER["table3"].get(scene, {}).get(strategy, {}).get("bvh_traversal" if stage == "traversal" else stage)


def chosen_strategies(record, everything):
    names, missing = shown([s["name"] for s in record["strategies"] if s.get("ms")], everything)
    return [s for s in record["strategies"] if s["name"] in names], missing


def milliseconds_axis(axes, values):
    """A logarithmic axis on which half a millisecond and seventy both show."""
    axes.set_xscale("log")
    low, high = max(min(values), SHORTEST), max(values)
    axes.set_xlim(10 ** math.floor(math.log10(low)), high * 14)  # room for the number behind the longest bar
    axes.xaxis.set_major_locator(matplotlib.ticker.LogLocator(numticks=6))
    axes.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    axes.grid(axis="y", visible=False)
    axes.tick_params(labelsize=7.5)


def draw_stages(of_pipeline, folder, everything):
    """A panel a stage, a bar a strategy, and two of them where there are records of both pipelines. All panels have one
    logarithmic axis. A mark is what the paper gives for the stage."""
    record = of_pipeline.get("today") or of_pipeline["published"]
    scene = plain(record["scene"]["name"])
    strategies, missing = chosen_strategies(record, everything)
    if not strategies:
        return
    names = [s["name"] for s in strategies]
    papers = scene if not record["scene"].get("path") else ""
    figures = {}  # milliseconds by pipeline, strategy and stage
    for pipeline, one in of_pipeline.items():
        for s in one["strategies"]:
            if s["name"] in names and s.get("ms"):
                stages = {stage: mean_stage(s, stage) for stage in (*STAGES, START_TEST)}
                stages["total"] = total_of(s) - (stages["refit"] or 0)  # as the paper has it
                figures[pipeline, s["name"]] = {stage: ms for stage, ms in stages.items() if ms}
    columns = [stage for stage in (*STAGES, "total", START_TEST) if any(stage in row for row in figures.values())]
    values = [ms for row in figures.values() for ms in row.values()]
    figure, cells = plt.subplots(1, len(columns), figsize=(1.1 + 1.45 * len(columns), 1.1 + 0.34 * len(names)), sharey=True,
                                 squeeze=False)
    pipelines = [pipeline for pipeline in ("published", "today") if pipeline in of_pipeline]
    height = 0.76 / len(pipelines)
    for axes, stage in zip(cells[0], columns):
        colour = STAGES.get(stage, "#444444" if stage == "total" else "#BBBBBB")
        milliseconds_axis(axes, values)
        for row, name in enumerate(names):
            for n, pipeline in enumerate(pipelines):
                ms = figures.get((pipeline, name), {}).get(stage)
                if ms is None:
                    continue
                y = row + (n - (len(pipelines) - 1) / 2) * height
                both = len(pipelines) == 2
                axes.barh(y, ms, height * 0.92, color=colour if n == 0 or not both else "white", edgecolor=colour, lw=0.8)
                axes.text(max(ms, axes.get_xlim()[0]) * 1.2, y, f"{ms:.3g}{mark_of(of_pipeline[pipeline], name)}", va="center",
                          fontsize=6.5 if both else 7.5, zorder=5,
                          bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.4})
            mark = paper_stage(papers, name, stage)
            if mark:
                axes.plot([mark, mark], [row - 0.45, row + 0.45], color="#D55E00", lw=1.6)
        axes.set_title(TITLES.get(stage, stage.replace("_", " ")), fontsize=8)
        axes.set_yticks(range(len(names)), names)
    cells[0][0].set_ylim(len(names) - 0.5, -0.5)
    notes = ["milliseconds an interval"]
    if len(pipelines) == 2:
        notes.append("full bars: pipeline published; empty bars: today")
    if any(paper_stage(papers, name, stage) for name in names for stage in columns):
        notes.append("red marks: the paper's machine")
    marked = any(mark_of(one, name) for one in of_pipeline.values() for name in names)
    figure.suptitle(scene + left_out(missing), fontsize=9)
    figure.supxlabel("; ".join(notes) + (f"\n{MARK_NOTE}" if marked else ""), fontsize=8)
    save(figure, folder, f"{scene}-stages", pdf=True)


def draw_all_stages(records, folder, everything):
    """Every strategy on every scene: a point a stage and a mark for the whole query, on one logarithmic axis for all scenes."""
    records = [record for record in records if chosen_strategies(record, everything)[0]]
    if not records:
        return
    columns = min(3, len(records))
    lines = -(-len(records) // columns)
    most = max(len(chosen_strategies(record, everything)[0]) for record in records)
    figure, cells = plt.subplots(lines, columns, figsize=(3.2 * columns + 0.6, (0.26 * most + 0.8) * lines + 0.5), squeeze=False,
                                 sharex=True)
    for axes in cells.flat:
        axes.set_visible(False)
    values = []
    for axes, record in zip(cells.flat, records):
        axes.set_visible(True)
        strategies, missing = chosen_strategies(record, everything)
        for row, s in enumerate(strategies):
            total = total_of(s)
            for stage, colour in STAGES.items():
                if (ms := mean_stage(s, stage)) and ms >= SHORTEST:
                    axes.plot(ms, row, "o", ms=5, color=colour, mec="white", mew=0.4, zorder=3)
                    values.append(ms)
            axes.plot(total, row, "|", ms=11, mew=1.8, color="black")
            axes.annotate(f"{total:.3g}{mark_of(record, s['name'])}", (total, row), (5, 0), textcoords="offset points",
                          va="center", fontsize=7)
            values.append(total)
        axes.set_yticks(range(len(strategies)), [s["name"] for s in strategies])
        axes.set_ylim(len(strategies) - 0.5, -0.5)
        axes.set_title(plain(record["scene"]["name"]) + left_out(missing), fontsize=9)
    for axes in cells.flat[:len(records)]:
        milliseconds_axis(axes, values)
        axes.grid(axis="y", visible=True)
        axes.tick_params(labelbottom=True)
    handles = [matplotlib.lines.Line2D([], [], marker="o", ls="", color=colour, label=stage.replace("_", " "))
               for stage, colour in STAGES.items()]
    handles.append(matplotlib.lines.Line2D([], [], marker="|", ms=11, mew=1.8, ls="", color="black", label="whole query"))
    figure.legend(handles=handles, ncol=len(handles), loc="upper center", fontsize=8)
    height = figure.get_size_inches()[1]
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 0.3 / height))
    marked = any(mark_of(record, s["name"]) for record in records for s in chosen_strategies(record, everything)[0])
    figure.supxlabel("milliseconds an interval" + (f"\n{MARK_NOTE}" if marked else ""), fontsize=8)
    save(figure, folder, "stages", pdf=True)


def read(paths):
    records = read_records(paths, SCHEMA, "cscd run")
    for record in records:
        if not record["verification"]["ok"]:
            refuse(f"a record of {plain(record['scene']['name'])}: its verification failed, so it holds no times; mend the strategy "
                   "and run again")
    return records


def main():
    parser = parser_of(__doc__)
    parser.add_argument("records", nargs="+", type=pathlib.Path, metavar="RECORDS")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="the folder, which is made where it is missing")
    parser.add_argument("--strategy", help="the curves of Figures 11 and 12, with commas between; default " + ",".join(PAPERS))
    parser.add_argument("--all", action="store_true", help="all rows in the charts of times")
    arguments = parser.parse_args()
    folder = made_folder(arguments.out)
    scenes = {}  # by name, then by pipeline
    for record in read(arguments.records):
        of_pipeline = scenes.setdefault(plain(record["scene"]["name"]), {})
        pipeline = record.get("pipeline", "today")
        if pipeline in of_pipeline:
            refuse(f"two records are both of a scene {plain(record['scene']['name'])} in the pipeline {pipeline}, and their figures "
                   "would be one; draw one of them at a time")
        of_pipeline[pipeline] = record
    chosen = arguments.strategy.split(",") if arguments.strategy else None
    for name in chosen or []:
        if not any(s["name"] == name for pipelines in scenes.values() for r in pipelines.values() for s in r["strategies"]):
            refuse(f"--strategy {name}: in no record that was given; choose another")
    shown_records = [of_pipeline.get("today") or of_pipeline["published"] for of_pipeline in scenes.values()]
    for record in shown_records:  # counters are the same in both pipelines
        draw_counter(record, ["bvot"], "bounding volume overlap tests", "bvot", folder, chosen or PAPERS)
        draw_counter(record, ["pctp"], "potentially colliding triangle pairs", "pctp", folder, chosen or PAPERS)
        draw_counter(record, ["negative", "uncertain"], "triangles that are not positive", "nonpositive", folder,
                     chosen or SEEN_FROM_INSIDE)
    for of_pipeline in scenes.values():
        draw_stages(of_pipeline, folder, arguments.all)
    if len(shown_records) > 1:
        draw_all_stages(shown_records, folder, arguments.all)
