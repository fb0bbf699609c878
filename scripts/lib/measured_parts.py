"""Measured figures between the markers of pages.

A page has lines `<!-- results: NAME -->` ... `<!-- end of results -->`; NAME is a part below (PARTS), or `query`, what the program
prints. A part comes from the full record that the README links to, or from the newest record of its own kind that git tracks (OWN_KIND).
"""
import functools
import re

from markdown import built, number, short, table, with_interval
from records import MARK_NOTE, mark_of, read_json
from results_index import environment_of, first_record
from script import ROOT, answer_of, output_of, refuse
from study_parts import STUDIES, words
from tracked import tracked_files

MARKED = re.compile(r"(<!-- results: ([a-z]+) -->\n).*?(<!-- end of results -->)", re.S)
COMPLETE_BASELINES = ("base", "aabb", "mcd", "selfccd", "embree", "cgal_boxes")


def is_published(part):
    """Whether a cell or a record is of the pipeline `published`; older ones do not say and are of `today`."""
    return part.get("pipeline") == "published"


class Results:
    """A results folder, its tables, and where a page finds it. Refuses a folder that holds no tables or is not of this repository."""

    def __init__(self, folder, page):
        if not folder.is_relative_to(ROOT) or not any(folder.glob("tables.json*")):
            refuse(f"{folder}: is no results folder of this repository; name one, or write it with scripts/reproduce")
        self.folder = folder
        self.page = page
        self.link = "../" * page.count("/") + folder.relative_to(ROOT).as_posix()
        packed = folder / "tables.json.gz"
        self.tables = read_json(packed if packed.exists() else folder / "tables.json")
        # What was measured in the pipeline `published` has rows of its own on the page of the paper's figures alone.
        self.cells = {table["id"]: {row["scene"]: {cell["key"]: cell for cell in row["cells"] if not is_published(cell)}
                                    for row in table["rows"]} for table in self.tables["tables"]}
        self.records = [record for record in self.tables["records"] if not is_published(record)]

    def cell(self, table_id, scene, key):
        cell = self.cells.get(table_id, {}).get(scene, {}).get(key)
        if cell and (cell["unit"] == "ms" or "over_" in key and table_id == "engine") and self.is_marked(scene, key):
            cell["marked"] = True
        return cell

    def is_marked(self, scene, key):
        """Whether a time has a footnote, by the record: older tables do not say. `key` begins with the strategy."""
        name = key.partition(".")[0]
        return mark_of(self.record(scene), {"fast": "drvbc_fast", "complete": "drvbc_fast_complete"}.get(name, name))

    @functools.cache
    def record(self, scene):
        return read_json(self.folder / f"{scene}.json.gz")

    def scenes(self, with_contacts):
        return [r["scene"] for r in self.records if r["scene"].endswith("_contact") == with_contacts]


def mark(cell):
    """What a time that has a footnote ends in."""
    return "\\*" if cell.get("marked") else ""


def shown(cell, published=False, text=number):
    if cell is None:
        return "not run"
    if cell["measured"] is None:
        return cell["reason"]
    return with_interval(cell["measured"], cell.get("interval"), text) + mark(cell) + (
        f" ({number(cell['published'])})" if published and cell["published"] is not None else "")


def picture(results):
    return f"![a hand at rest, the interval in which its fingers first touch, and where they do]({results.link}/contact.png)\n"


def best(cells, with_bounds=True):
    """The least measured figure of some baselines' cells, by name, and whose it is."""
    measured = [(cell["measured"], name, cell) for name, cell in cells.items() if cell and cell["measured"] is not None]
    if not measured:
        return "not run"
    value, name, cell = min(measured)
    return f"{with_interval(value, cell.get('interval') if with_bounds else None, short)}{mark(cell)}, `{name}`"


def best_baseline(results, scene, over, with_bounds=True):
    """How many times faster a row is than the fastest complete baseline, and which that is. `over` begins the key of the ratio."""
    return best({name: results.cell("engine", scene, f"{over}_{name}") for name in COMPLETE_BASELINES}, with_bounds)


def times_faster(results, scene, fast, slow):
    """How many times faster the median query of one row is than that of another; None where either was not measured. Both must be asked the same."""
    cells = [results.cell("beside", scene, f"{name}.with_refit_median") for name in (slow, fast)]
    if any(cell is None or cell["measured"] is None for cell in cells):
        return None
    return {"measured": cells[0]["measured"] / cells[1]["measured"], "marked": any(cell.get("marked") for cell in cells)}


def row(title, scenes, text):
    """A row of a table that has a column a scene."""
    return [title, *(text(scene) for scene in scenes)]


def door(results):
    """What a visitor wants to know first, in a few rows: the newest record of what a query runs without options."""
    measured = Results(newest("starts"), results.page)
    scenes = measured.scenes(False)

    def plain(table_id, key, variant=""):
        def text(scene):
            cell = measured.cell(table_id, scene + variant, key)
            return "–" if cell is None or cell["measured"] is None else short(cell["measured"]) + mark(cell)
        return text

    lines = table([""] + scenes, [
        row("**one query, ms**", scenes, plain("beside", "drvbc_fast_all.with_refit_median")),
        row("in a clip with contacts, the mean, ms", scenes, plain("beside", "drvbc_fast_all.with_refit", "_contact")),
        row("from a start that may cross itself, ms", scenes, plain("beside", SEEING_START)),
        row("all contacts: times faster than the best package or baseline", scenes, lambda scene: best(
            {name: times_faster(measured, scene, "drvbc_fast_all", name) for name in COMPLETE_BASELINES}, with_bounds=False)),
        row("first contact: times faster than DRVBC, the paper's method", scenes, lambda scene: best(
            {"drvbc": times_faster(measured, scene, "drvbc_fast", "drvbc")}, with_bounds=False).partition(",")[0]),
    ])
    return "\n".join(lines + [
        "", "*One query* is what `cscd query` runs without options, the method `drvbc_fast_all`: all contacts, refit included, the median "
        "interval. In a clip with contacts some intervals touch, and those take longer. A start that may cross itself is answered by "
        "`drvbc_fast_complete`. *Times faster* compares medians of methods that are asked the same: `drvbc_fast_all` and the others for all "
        "contacts, `drvbc_fast` and DRVBC for the first one. `cscd list mcd` explains any of these names.",
        f"Measured on {built(measured.records[0]['environment'])}; {measured.records[0].get('threads', 'one thread')}; "
        f"[all rows]({measured.link}/tables.md).",
        f"[The paper's tables, measured and published]({results.link}/tables.md); [its claims]({results.link}/claims.md)."]) + "\n"


def rows_of(results, scenes, also_published):
    """The rows in plain words, one scene a column."""
    def cell(table_id, key, published=False):
        return lambda scene: shown(results.cell(table_id, scene, key), published, short)

    rows = [
        row("**one query of `drvbc_fast`, ms**: the median interval", scenes, cell("beside", "drvbc_fast.with_refit_median")),
        *([] if also_published else [row("the mean of all timed intervals, ms", scenes, cell("beside", "drvbc_fast.with_refit"))]),
        row("times faster than the best complete baseline, which finds all contacts", scenes,
            lambda scene: best_baseline(results, scene, "fast.over")),
        row("times faster than `drvbc`, the paper's method, which finds the first contact too", scenes, cell("engine", "fast.over_drvbc")),
    ]
    if also_published:
        rows.append(row("`drvbc`: times faster than `base`, a plain hierarchy, both without refit (published)", scenes,
                        lambda scene: cell("table2", "speedup_base", True)(scene)
                        if results.cell("table2", scene, "speedup_base") else "not published"))
    return rows


def headline(results):
    scenes, contacts = results.scenes(False), results.scenes(True)
    lines = table(["figure [95 % interval]"] + scenes, rows_of(results, scenes, True))
    if contacts:
        lines += ["", "With contacts, on intervals of which some touch:", ""]
        lines += table(["figure [95 % interval]"] + contacts, rows_of(results, contacts, False)[:3])
    records = results.records
    timed = sum(r["timed_intervals"] for r in records)
    lines += ["", "The start of each interval is known to be embedded: the surface does not cross itself there. `drvbc_fast` is asked for the first contact.",
              "Ratios divide mean times over all timed intervals. Where fewer than half of the intervals touch, the median interval is one without contact."]
    if all("--elementary newton" in " ".join(r["command"]) for r in records):
        lines += ["All strategies have the paper's elementary test, `newton`; the page of tables says how often it missed a contact."]
    lines += ["", f"Measured on {built(records[0]['environment'])}; {records[0].get('threads', 'one thread')}."]
    checked = f"{timed} intervals were timed"
    if all("timed_verified_intervals" in r for r in records):
        verified = sum(r["timed_verified_intervals"] for r in records)
        checked += (f", {'all' if verified == timed else verified} of them verified and "
                    f"{sum(r['timed_colliding_intervals'] for r in records)} with contacts")
    lines += [f"{checked}; {sum(r['verified_intervals'] for r in records)} intervals were verified in all, "
              f"{sum(r['colliding_intervals'] for r in records)} of them with contacts.",
              f"[Tables]({results.link}/tables.md). The paper's claims, one by one: [claims]({results.link}/claims.md)."]
    return "\n".join(lines) + "\n"


SEEING_START = "drvbc_fast_complete.seeing_start_median"


def starts(results):
    """What a query takes where its start is known to be embedded, where it is not, and where that does not matter."""
    def measured(key):
        return lambda scene: shown(results.cell("beside", scene, key), text=short)

    lines = []
    for scenes in filter(None, (results.scenes(False), results.scenes(True))):
        lines += ([""] if lines else []) + table(["figure [95 % interval]"] + scenes, [
            row("`drvbc_fast`, the start is known, ms", scenes, measured("drvbc_fast.with_refit_median")),
            row("`drvbc_fast`, the start is not known, ms", scenes, measured("drvbc_fast.with_start_median")),
            row("`drvbc_fast_all`, all contacts, the start is known, ms", scenes, measured("drvbc_fast_all.with_refit_median")),
            row("`drvbc_fast_complete`, which takes any start, ms", scenes, measured("drvbc_fast_complete.with_refit_median")),
            row("`drvbc_fast_complete`, which sees what crosses at the start, ms", scenes, measured(SEEING_START)),
            row("`drvbc_fast`, first contact: times faster than the best complete baseline, which finds all; the start is known", scenes,
                lambda scene: best_baseline(results, scene, "fast.over")),
            row("`drvbc_fast_complete`, all contacts: times faster than the best complete baseline, the start is not known", scenes,
                lambda scene: best_baseline(results, scene, "complete.seeing_start_over")),
        ])
    return "\n".join(lines + ["", f"Measured on {built(results.records[0]['environment'])}. [Tables]({results.link}/tables.md)."]) + "\n"


def paper(results):
    """The paper's tables, measured and published, as the record's page has them."""
    tables = re.findall(r"^## Table .*?(?=^## |\Z)", (results.folder / "tables.md").read_text(), re.M | re.S)
    if not tables:
        refuse(f"{results.folder}/tables.md: has no tables of the paper; write it with cscd tables {results.folder} "
               f"--out {results.folder} --force")
    return "".join("#" + text for text in tables) + (
        f"Measured on {built(results.records[0]['environment'])}.\nPublished: {results.tables['published']['machine']}.\n"
        f"[The same with the times of every strategy]({results.link}/tables.md), [claims]({results.link}/claims.md).\n")


def ideas(results):
    """What drvbc_fast does with and without each of its ideas."""
    rows = ("base", "drvbc", "drvbc_fast", "drvbc_fast_one_cover", "drvbc_fast_two_covers", "drvbc_fast_swept_bounds",
            "drvbc_fast_no_stars", "drvbc_fast_no_planes", "drvbc_fast_bones", "drvbc_fast_no_bones", "drvbc_fast_complete")
    quantities = (("bvot", "BVOT (thousands)"), ("pctp", "PCTP (thousands)"), ("with_refit_median", "total with refit (ms)"))
    scenes = results.scenes(False)

    def plain_value(scene, key):
        cell = results.cell("beside", scene, key)
        return "not run" if cell is None else cell["reason"] if cell["measured"] is None else number(cell["measured"])

    lines = [[f"{strategy}: {title}"] + [plain_value(scene, f"{strategy}.{quantity}") for scene in scenes]
             for strategy in rows for quantity, title in quantities]
    lines.append(["drvbc_fast: total with refit, in times of streaming all positions"]
                 + [plain_value(scene, "drvbc_fast.streamings") for scene in scenes])
    return "\n".join(table([""] + scenes, lines) + ["", f"From [this record]({results.link}/tables.md)."]) + "\n"


SWEEP = ("base", "aabb", "mcd", "selfccd", "embree", "cgal_boxes", "fcl", "rvbc", "drvbc_unmerged", "drvbc", "drvbc_fast",
         "drvbc_fast_complete")
SWEEP_CHARACTERS, SWEEP_FRAMES, SWEEP_VERIFY_EVERY, SWEEP_TIME_EVERY, SWEEP_REPETITIONS = 1000, 10000, 9, 21, 5
STAGES = ("refit", "rv_update", "traversal", "elementary")


def cloth(results):
    """What sheets, a bag and a skirt take, with covers that follow and with covers that do not."""
    def measured(strategy, quantity="with_refit_median", text=short):
        return lambda scene: shown(results.cell("beside", scene, f"{strategy}.{quantity}"), text=text)

    def of_closed(strategy):
        def text(scene):
            cell = results.cell("beside", scene, f"{strategy}.with_refit_median")
            return "open" if cell is None or cell["measured"] is None else shown(cell, text=short)
        return text

    lines = []
    for scenes in filter(None, (results.scenes(False), results.scenes(True))):
        lines += ([""] if lines else []) + table(["one query, ms, median interval [95 % interval]"] + scenes, [
            row("`drvbc_fast_complete`", scenes, measured("drvbc_fast_complete")),
            row("the same with covers that stay as they were cut", scenes, measured("drvbc_fast_fixed_covers_complete")),
            row("`drvbc_fast`, a closed surface and a start known to be embedded", scenes, of_closed("drvbc_fast")),
            row("the same with covers that stay as they were cut", scenes,
                of_closed("drvbc_fast_fixed_covers")),
            row("the best complete baseline", scenes, lambda scene: best(
                {name: results.cell("beside", scene, f"{name}.with_refit_median") for name in COMPLETE_BASELINES})),
            row("overlap tests of `drvbc_fast_complete`, thousands", scenes, measured("drvbc_fast_complete", "bvot", number)),
            row("overlap tests of `base`, thousands", scenes, measured("base", "bvot", number)),
        ])
    return "\n".join(lines + ["", f"From [this record]({results.link}/tables.md), measured on "
                              f"{built(results.records[0]['environment'])}."]) + "\n"


COMPLETE, EARLIEST = "drvbc_fast_complete", "drvbc_fast_complete --first"


def steps_of(results):
    """The cells of each step of a real simulation by their keys, the smallest surface first."""
    rows = results.cells["real"]
    return dict(sorted(rows.items(), key=lambda row: row[1]["triangles"]["measured"]))


def plain_step(name):
    """The name of a step without the number of its frame, as in `cloth-ball-92`."""
    return re.sub(r"-\d+$", "", name)


def real(results):
    """What steps of real simulations take, held against truth from outside, and what another program took."""
    steps = steps_of(results)
    keys = ("triangles", "contacts", "base.median", "selfccd.median", "complete.median", "first.median", "complete.over_base",
            "complete.over_selfccd", "missed", "invented")
    lines = table(["step", "triangles", "contacts", "`base`, ms", "`selfccd`, ms", f"`{COMPLETE}`, ms", "its `--first`, ms",
                   "times faster than `base`", "than `selfccd`", "missed", "invented"],
                  [[name, *(f"{cells[key]['measured']:,.0f}" if key in ("triangles", "contacts") else shown(cells[key], text=short)
                            for key in keys)] for name, cells in steps.items()])
    crossing = [r["scene"] for r in results.records if r["unembedded_intervals"]]
    lines += ["", f"One query with refit, median [95 % interval]. The surface crosses itself at the start of {', '.join(crossing) or 'no step'}.",
              f"Measured on {built(results.records[0]['environment'])}; [all rows]({results.link}/tables.md)."]
    peers = read_json(ROOT / "scripts" / "lib" / "peers.json")
    asked = {name: peers["steps"][plain_step(name)] for name in steps if plain_step(name) in peers["steps"]}
    if asked:
        lines += ["", f"The same steps with [{peers['program']}]({peers['url']}), which most simulators link ({peers['how']}):", ""]
        lines += table(["step", "its candidates", "its earliest contact, ms", "at t, it says", "at t, exactly", "ours, ms", "its all contacts, ms",
                        "ours, ms"],
                       [[name, f"{peer['candidates']:,.0f}", short(peer["earliest_ms"]), short(peer["earliest"]),
                         short(exact_earliest(results, name)), short(steps[name]["first.median"]["measured"]), short(1000 * peer["all_s"]),
                         short(steps[name]["complete.median"]["measured"])] for name, peer in asked.items()])
    return "\n".join(lines) + "\n"


def exact_earliest(results, scene):
    return next(s["first_times"][0] for s in results.record(scene)["strategies"] if s["name"] == EARLIEST)


def steps(results):
    """The same in a sentence."""
    rows = steps_of(results).values()

    def span(key):
        values = sorted(row[key]["measured"] for row in rows)
        return f"{short(values[0])} to {short(values[-1])}"

    wrong = sum(row[key]["measured"] for row in rows for key in ("missed", "invented"))
    return (f"- On {len(rows)} steps of real simulations with {span('contacts')} contacts, all contacts take {span('complete.median')} ms, "
            f"{span('complete.over_base')} times\n  faster than `base`, and the earliest one takes {span('first.median')} ms; "
            f"{wrong or 'none'} is missed or invented ([step by step](bench/paper.md#steps-of-real-simulations)).\n")


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def query_ms(strategy):
    """The mean over all samples of what a query takes, with refit."""
    stages = [strategy["ms"][stage] for stage in STAGES if stage in strategy["ms"]]
    return sum(mean(ms for repetition in stage for ms in repetition) for stage in stages)


def preparation_ms(strategy):
    """What a process spends on preparing a strategy, which it does twice: to judge it and to time it."""
    return sum(sum(strategy["preparation"].get(key, [])) for key in ("distance_and_heat_ms", "decomposition_ms"))


def sweep(results):
    """What a sweep of many characters costs, from the records of the six scenes."""
    names = results.scenes(False)
    records = [read_json(results.folder / f"{name}.json.gz") for name in names]
    rows = [{s["name"]: s for s in record["strategies"]} for record in records]
    query = {name: mean(query_ms(row[name]) for row in rows) for name in SWEEP}
    prepare = {name: mean(preparation_ms(row[name]) for row in rows) for name in SWEEP}
    verify_ms = mean(1000 * r["verification"]["seconds"] / len(r["verification"]["intervals"]) for r in records)
    packed = mean((results.folder / f"{name}.json.gz").stat().st_size / len(r["counted_intervals"]) / len(r["strategies"])
                  for name, r in zip(names, records))
    intervals = SWEEP_CHARACTERS * SWEEP_FRAMES
    ms_per_day = 24 * 3600 * 1000

    def days(ms):
        return short(ms / ms_per_day)

    count_ms, prepare_ms = sum(query.values()), sum(prepare.values())
    interval_ms = count_ms + verify_ms / SWEEP_VERIFY_EVERY
    cell = -(-9 * prepare_ms // interval_ms)  # preparing is a tenth of a cell
    counts = intervals * interval_ms + intervals / cell * prepare_ms
    timed = intervals / SWEEP_TIME_EVERY
    # What is timed is verified and counted first.
    timings = timed * (SWEEP_REPETITIONS * count_ms + count_ms + verify_ms) + SWEEP_CHARACTERS * prepare_ms
    lines = table(["strategy", "one query, ms", "preparing, ms a process", "core-days of queries"],
                  [[f"`{name}`", number(query[name]), number(prepare[name]), days(intervals * query[name])] for name in SWEEP]
                  + [["all", number(count_ms), number(prepare_ms), days(intervals * count_ms)]])
    lines += ["", *table(["sweep", "core-days", "days on 100 cores"], [
        [f"counts of every interval, each {SWEEP_VERIFY_EVERY}th verified, cells of {cell:.0f} intervals", days(counts),
         days(counts / 100)],
        ["of that: queries / verification / preparing", f"{days(intervals * count_ms)} / "
         f"{days(intervals / SWEEP_VERIFY_EVERY * verify_ms)} / {days(intervals / cell * prepare_ms)}", ""],
        [f"times of each {SWEEP_TIME_EVERY}st interval, {SWEEP_REPETITIONS} repetitions, verified, a cell a character",
         days(timings), days(timings / 100)]])]
    return "\n".join(lines + [
        "", f"Verifying an interval takes {number(verify_ms)} ms; that is with all "
        f"{' or '.join(str(n) for n in sorted({len(r['strategies']) for r in records}))} rows of the record, and so more than these "
        f"{len(SWEEP)} take. Results take {number(packed)} bytes an interval and strategy, "
        f"{packed * intervals * len(SWEEP) / 1e9:,.1f} GB in all.",
        f"Computed from {', '.join(f'`{name}.json.gz`' for name in names)} of [this record]({results.link}/tables.md), measured on "
        f"{built(results.records[0]['environment'])}."]) + "\n"


PAGES = ("README.md", "bench/paper.md", "bench/METHODOLOGY.md", "bench/README.md", "core/fast/README.md", "scenes/import/README.md")
OWN_KIND = {"starts": "starts", "cloth": "cloth", "real": "real", "steps": "real"}
PARTS = {"picture": picture, "door": door, "headline": headline, "starts": starts, "paper": paper, "ideas": ideas, "cloth": cloth,
         "real": real, "steps": steps,
         "sweep": sweep}


def query(program):
    """What the program prints where README asks it first, without the line of times."""
    words = ["query", "hand_contact"]
    lines = [line for line in output_of(program.resolve(), *words).splitlines() if not line.startswith("  took ")]
    return "\n".join(["```text", f"$ cscd {' '.join(words)}", *lines, "```"]) + "\n"


def faults_of_default(program):
    """Scenes whose query without options takes other overlap tests than README's record of it. Two digits of a time, which README
    shows, say the same as long as the tests are within a twentieth."""
    faults = []
    folder = newest("starts")
    for path in sorted(folder.glob("*.json.gz")):
        record = read_json(path)
        if path.name.startswith("tables.") or record["scene"]["name"].endswith("_contact"):
            continue
        scene, counted = record["scene"]["name"], record["counted_intervals"]
        answer = answer_of(program, "query", scene)
        measured = next(row for row in record["strategies"] if row["name"] == answer["strategy"])
        then = sum(measured["counts"]["bvot"])
        now = sum(answer["intervals"][i]["counts"]["bvot"] for i in counted)
        if abs(now - then) > then / 20:
            faults.append(f"README.md: a query of {scene} takes {now} overlap tests in {len(counted)} intervals, and {folder.name} says "
                          f"{then}; measure it again with scripts/reproduce --starts --scene all")
    return faults


def newest(kind, is_required=True):
    """The newest results folder of a kind that is a study of its own. None of `real`, whose data not everybody has, and of studies that no page
    requires."""
    folders = {path.parent for path in tracked_files("results") if path.parent.name.endswith(f"-{kind}")}
    if not folders and (kind == "real" or not is_required):
        return None
    if not folders:
        command = {"cloth": "--cloth", "starts": "--starts --scene all"}[kind]
        refuse(f"results: holds no record of kind {kind}; run scripts/reproduce {command}")
    return max(folders, key=lambda folder: environment_of(first_record(folder, sorted(path.name for path in folder.iterdir())))["date"])


def study(name, page):
    """A part that is made of the newest records of some kinds, as far as git tracks any."""
    kinds, make = STUDIES[name]
    folders = {kind: found for kind in kinds if (found := newest(kind, False))}
    return make(folders, "../" * page.count("/")) if folders else ""


def with_note(text):
    """A part with the footnote of its marks."""
    return text + f"\n\\{MARK_NOTE}\n" if "\\*" in text and MARK_NOTE not in text else text


def linked_folder():
    found = re.search(r"\((results/[^/)]+-full)/tables\.md\)", (ROOT / "README.md").read_text())
    if not found:
        refuse("README.md: links to no results folder; name one")
    return ROOT / found[1]


def page_of(page, folder, program):
    """The text of a page with its parts made of a full record. Part `query` stays as it is where there is no program."""
    def part(match):
        if match[2] == "query":
            return match[0] if program is None else match[1] + query(program) + match[3]
        if match[2] == "words":
            return match[1] + words() + match[3]
        if match[2] in STUDIES:
            return match[1] + with_note(study(match[2], page)) + match[3]
        if match[2] not in PARTS:
            refuse(f"{page}: knows no part {match[2]}; choose one of {', '.join([*PARTS, *STUDIES])}")
        of = newest(OWN_KIND[match[2]]) if match[2] in OWN_KIND else folder
        if of is None:
            return match[1] + match[3]
        try:
            text = PARTS[match[2]](Results(of, page))
        except (OSError, ValueError) as error:
            refuse(f"{of}: holds a record that cannot be read ({error}); write it anew with scripts/reproduce")
        return match[1] + with_note(text) + match[3]

    text, count = MARKED.subn(part, (ROOT / page).read_text())
    if count == 0:
        refuse(f"{page}: has no markers; see scripts/lib/measured_parts.py")
    return text
