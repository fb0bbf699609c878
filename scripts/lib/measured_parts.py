"""Measured figures between the markers of pages.

A page has lines `<!-- results: NAME -->` ... `<!-- end of results -->`; NAME is a part below (PARTS), or `query`, what the program
prints. A part comes from the newest record of its kind that git tracks. Its tables are those of the document of figures
(bench/tables/table_definitions.json); what stands here are the sentences around them.
"""
import re

from markdown import number, table
from records import document_of, read_json
from results_index import environment_of, first_record
from scale_page import small_step_text
from scale_record import Record
from script import ROOT, answer_of, output_of, refuse
from study_parts import STUDIES, words
from tracked import tracked_files

MARKED = re.compile(r"(<!-- results: ([a-z]+) -->\n).*?(<!-- end of results -->)", re.S)


class Results:
    """The newest records of a kind, the document of their figures, and where a page finds them."""

    def __init__(self, kind, page, program):
        self.folder, self.program = newest(kind), program
        self.link = "../" * page.count("/") + self.folder.relative_to(ROOT).as_posix()
        report = document_of(program, *records_in(self.folder))
        self.stages = {record["scene"]: {row["name"]: row["stages"] for row in record["strategies"]} for record in report["records"]
                       if record["pipeline"] != "published"}
        document = report["tables"]
        self.shaped = {shaped["id"]: shaped for shaped in document["shaped"]}
        # What was measured in the pipeline `published` has rows of its own on the page of the paper's figures alone.
        self.cells = {table["id"]: {row["scene"]: {cell["key"]: cell for cell in row["cells"] if cell["pipeline"] != "published"}
                                    for row in table["rows"]} for table in document["tables"]}
        self.records = [record for record in document["records"] if record["pipeline"] != "published"]
        self.measured = f"Measured on {self.records[0]['measured']}"
        self.threads = self.records[0]["threads"]
        self.published, self.note = document["published"], document["mark_note"]

    def list_of(self, name):
        """A list of the document in Markdown, of plain scenes and of those with contacts, as far as there are any."""
        return "\n".join(self.shaped[found]["markdown"] for found in (name, f"{name}_contacts") if found in self.shaped)


def records_in(folder):
    return [path for path in tracked_files(folder) if path.name.endswith((".json", ".json.gz")) and not path.name.startswith("tables.json")]


def picture(full):
    return f"![a hand at rest, an interval in which a finger touches itself, and where]({full.link}/contact.png)\n"


def small_steps(program):
    """What small steps take, as a line; none where there is no record of them."""
    folder = newest("solver", False)
    small = small_step_text(Record(folder / "scale.json.gz", program)) if folder else ""
    return [f"A small step, as a solver asks for by the hundred, costs little where little moves: one {small} ([small steps]({folder.relative_to(ROOT)}/scale.md))."] \
        if small else []


def door(starts, full):
    """What a visitor wants to know first, in a few rows."""
    return starts.list_of("door") + "\n" + "\n".join([
        "*One query* is what `cscd query` runs without options, the method `drvbc_fast_all`: all contacts, refit included, the median "
        "interval. In a clip with contacts some intervals touch, and those take longer. A start that is not known to be free of crossings is answered by "
        "`drvbc_fast_complete`. *Times faster* compares medians of methods that are asked the same: `drvbc_fast_all` and the others for all "
        "contacts, `drvbc_fast` and DRVBC for the first one. `cscd list mcd` explains any of these names.",
        *small_steps(starts.program),
        f"{starts.measured}; {starts.threads}; [medians]({starts.link}/tables.md), "
        "[the third row](bench/paper.md#the-price-of-a-start).",
        f"[The paper's tables, measured and published]({full.link}/tables.md); [its claims]({full.link}/claims.md)."]) + "\n"


def headline(full):
    records = full.records

    def total(key):
        return sum(record[key] for record in records)

    text = full.shaped["headline"]["markdown"]
    if "headline_contacts" in full.shaped:
        text += "\nWith contacts, on intervals of which some touch:\n\n" + full.shaped["headline_contacts"]["markdown"]
    lines = ["The start of each interval is known to be embedded: the surface does not cross itself there. `drvbc_fast` is asked for the first contact.",
             "Ratios divide mean times over all timed intervals. Where fewer than half of the intervals touch, the median interval is one without contact."]
    if all("--elementary newton" in " ".join(record["command"]) for record in records):
        lines += ["All strategies have the paper's elementary test, `newton`; the page of tables says how often it missed a contact."]
    timed, verified = total("timed_intervals"), total("timed_verified_intervals")
    lines += ["", f"{full.measured}; {full.threads}.",
              f"{timed} intervals were timed, {'all' if verified == timed else verified} of them verified and "
              f"{total('timed_colliding_intervals')} with contacts; {total('verified_intervals')} intervals were verified in all, "
              f"{total('colliding_intervals')} of them with contacts.",
              f"[Tables]({full.link}/tables.md). The paper's claims, one by one: [claims]({full.link}/claims.md)."]
    return text + "\n" + "\n".join(lines) + "\n"


def starts(results):
    """What a query takes where its start is known to be embedded, where it is not, and where that does not matter."""
    return results.list_of("starts") + f"\n{results.measured}. [Tables]({results.link}/tables.md).\n"


def paper(full):
    """The paper's tables, measured and published."""
    tables = [shaped for shaped in full.shaped.values() if shaped["title"].startswith("Table ")]
    text = "".join(f"### {shaped['title']}\n\n{shaped['legend']}\n\n{shaped['markdown']}"
                   + (f"\n\\{shaped['note']}\n" if shaped["note"] else "") + "\n" for shaped in tables)
    return text + (f"{full.measured}.\nPublished: {full.published['machine']}.\n"
                   f"[The same with the times of every strategy]({full.link}/tables.md), [claims]({full.link}/claims.md).\n")


def ideas(full):
    """What drvbc_fast does with and without each of its ideas."""
    return full.list_of("ideas") + f"\nFrom [this record]({full.link}/tables.md).\n"


def cloth(results):
    """What sheets, a bag and a skirt take, with covers that follow and with covers that do not."""
    return results.list_of("cloth") + f"\nFrom [this record]({results.link}/tables.md), measured on {results.records[0]['measured']}.\n"


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
                  [[name, *(cells[key]["text"].replace("*", "\\*") for key in keys)] for name, cells in steps.items()])
    crossing = [r["scene"] for r in results.records if r["unembedded_intervals"]]
    lines += ["", f"One query with refit, median [95 % interval]. The surface crosses itself at the start of {', '.join(crossing) or 'no step'}.",
              f"{results.measured}; [all rows]({results.link}/tables.md)."]
    peers = read_json(ROOT / "scripts" / "lib" / "peers.json")
    asked = {name: peers["steps"][plain_step(name)] for name in steps if plain_step(name) in peers["steps"]}
    if asked:
        lines += ["", f"The same steps with [{peers['program']}]({peers['url']}), which most simulators link ({peers['how']}):", ""]
        lines += table(["step", "its candidates", "its earliest contact, ms", "at t, it says", "at t, exactly", "ours, ms", "its all contacts, ms",
                        "ours, ms"],
                       [[name, number(peer["candidates"]), number(peer["earliest_ms"]), number(peer["earliest"]),
                         number(exact_earliest(results, name)), number(steps[name]["first.median"]["measured"]), number(1000 * peer["all_s"]),
                         number(steps[name]["complete.median"]["measured"])] for name, peer in asked.items()])
    return "\n".join(lines) + "\n"


def exact_earliest(results, scene):
    record = read_json(results.folder / f"{scene}.json.gz")
    return next(s["first_times"][0] for s in record["strategies"] if s["name"] == EARLIEST)


def steps(results):
    """The same in a sentence."""
    rows = steps_of(results).values()

    def span(key):
        values = sorted(row[key]["measured"] for row in rows)
        return f"{number(values[0])} to {number(values[-1])}"

    wrong = sum(row[key]["measured"] for row in rows for key in ("missed", "invented"))
    return (f"- On {len(rows)} steps of real simulations with {span('contacts')} contacts, all contacts take {span('complete.median')} ms, "
            f"{span('complete.over_base')} times\n  faster than `base`, and the earliest one takes {span('first.median')} ms; "
            f"{wrong or 'none'} is missed or invented ([step by step](bench/paper.md#steps-of-real-simulations)).\n")


SWEEP = ("base", "aabb", "mcd", "selfccd", "embree", "cgal_boxes", "fcl", "rvbc", "drvbc_unmerged", "drvbc", "drvbc_fast",
         "drvbc_fast_complete")
SWEEP_CHARACTERS, SWEEP_FRAMES, SWEEP_VERIFY_EVERY, SWEEP_TIME_EVERY, SWEEP_REPETITIONS = 1000, 10000, 9, 21, 5


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def preparation_ms(strategy):
    """What a process spends on preparing a strategy, which it does twice: to judge it and to time it."""
    return sum(sum(strategy["preparation"].get(key, [])) for key in ("distance_and_heat_ms", "decomposition_ms"))


def sweep(results):
    """What a sweep of many characters costs, from the records of the six scenes."""
    names = [record["scene"] for record in results.records if not record["scene"].endswith("_contact")]
    records = [read_json(results.folder / f"{name}.json.gz") for name in names]
    rows = [{s["name"]: s for s in record["strategies"]} for record in records]
    query = {name: mean(sum(results.stages[scene][name].values()) for scene in names) for name in SWEEP}
    prepare = {name: mean(preparation_ms(row[name]) for row in rows) for name in SWEEP}
    verify_ms = mean(1000 * r["verification"]["seconds"] / len(r["verification"]["intervals"]) for r in records)
    packed = mean((results.folder / f"{name}.json.gz").stat().st_size / len(r["counted_intervals"]) / len(r["strategies"])
                  for name, r in zip(names, records))
    intervals = SWEEP_CHARACTERS * SWEEP_FRAMES
    ms_per_day = 24 * 3600 * 1000

    def days(ms):
        return number(ms / ms_per_day)

    count_ms, prepare_ms = sum(query.values()), sum(prepare.values())
    interval_ms = count_ms + verify_ms / SWEEP_VERIFY_EVERY
    shard = -(-9 * prepare_ms // interval_ms)  # preparing is a tenth of a shard
    counts = intervals * interval_ms + intervals / shard * prepare_ms
    timed = intervals / SWEEP_TIME_EVERY
    # What is timed is verified and counted first.
    timings = timed * (SWEEP_REPETITIONS * count_ms + count_ms + verify_ms) + SWEEP_CHARACTERS * prepare_ms
    lines = table(["strategy", "one query, ms", "preparing, ms a process", "core-days of queries"],
                  [[f"`{name}`", number(query[name]), number(prepare[name]), days(intervals * query[name])] for name in SWEEP]
                  + [["all", number(count_ms), number(prepare_ms), days(intervals * count_ms)]])
    lines += ["", *table(["sweep", "core-days", "days on 100 cores"], [
        [f"counts of every interval, each {SWEEP_VERIFY_EVERY}th verified, shards of {shard:.0f} intervals", days(counts),
         days(counts / 100)],
        ["of that: queries / verification / preparing", f"{days(intervals * count_ms)} / "
         f"{days(intervals / SWEEP_VERIFY_EVERY * verify_ms)} / {days(intervals / shard * prepare_ms)}", ""],
        [f"times of each {SWEEP_TIME_EVERY}st interval, {SWEEP_REPETITIONS} repetitions, verified, a shard a character",
         days(timings), days(timings / 100)]])]
    return "\n".join(lines + [
        "", f"Verifying an interval takes {number(verify_ms)} ms; that is with all "
        f"{' or '.join(str(n) for n in sorted({len(r['strategies']) for r in records}))} rows of the record, and so more than these "
        f"{len(SWEEP)} take. Results take {number(packed)} bytes an interval and strategy, "
        f"{packed * intervals * len(SWEEP) / 1e9:,.1f} GB in all.",
        f"Computed from {', '.join(f'`{name}.json.gz`' for name in names)} of [this record]({results.link}/tables.md), measured on "
        f"{results.records[0]['measured']}."]) + "\n"


PAGES = ("README.md", "bench/paper.md", "bench/METHODOLOGY.md", "bench/README.md", "core/fast/README.md", "scenes/import/README.md")
# By the name of a part: the kinds of records that it is made of, and the function that makes it.
PARTS = {"picture": (("full",), picture), "door": (("starts", "full"), door), "headline": (("full",), headline), "starts": (("starts",), starts),
         "paper": (("full",), paper), "ideas": (("full",), ideas), "cloth": (("cloth",), cloth), "real": (("real",), real),
         "steps": (("real",), steps), "sweep": (("full",), sweep)}


def query(program):
    """What the program prints where README asks it first, without the line of times."""
    words = ["query", "hand_contact"]
    lines = [line for line in output_of(program, *words).splitlines() if not line.startswith("  took ")]
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


def faults_of_numbers(program):
    """Whether pages that scripts format have numbers as `cscd` formats them, which is held against every figure of the newest records."""
    cells = [cell for table in Results("full", "", program).cells.values() for row in table.values() for cell in row.values()]
    wrong = next((cell for cell in cells if cell["text"].partition(" ")[0].rstrip("*") != number(cell["measured"]).replace("–", "")), None)
    return [f"scripts/lib/markdown.py: number() makes {number(wrong['measured'])} of {wrong['measured']}, and cscd {wrong['text']}"] if wrong else []


def newest(kind, is_required=True):
    """The newest results folder of a kind that is a study of its own. None of `real`, whose data not everybody has, and of studies that no page
    requires."""
    folders = {path.parent for path in tracked_files("results") if path.parent.name.endswith(f"-{kind}")}
    if not folders and (kind == "real" or not is_required):
        return None
    if not folders:
        command = f"--{kind}" + " --scene all" * (kind != "cloth")
        refuse(f"results: holds no record of kind {kind}; run scripts/reproduce {command}")
    return max(folders, key=lambda folder: environment_of(first_record(folder, sorted(path.name for path in folder.iterdir())))["date"])


def study(name, page, program):
    """A part that is made of the newest records of some kinds, as far as git tracks any."""
    kinds, make = STUDIES[name]
    folders = {kind: found for kind in kinds if (found := newest(kind, False))}
    return make(folders, "../" * page.count("/"), program) if folders else ""


def measured(name, page, program):
    """A part that is made of runs. Not everybody has those of real simulations."""
    kinds, make = PARTS[name]
    if not all(newest(kind) for kind in kinds):
        return ""
    return make(*(Results(kind, page, program) for kind in kinds))


def with_note(text, program):
    """A part with the footnote of its marks."""
    note = Results("full", "", program).note
    return text + f"\n\\{note}\n" if "\\*" in text and note not in text else text


def page_of(page, program):
    """The text of a page with its parts made of the newest records."""
    def part(match):
        name = match[2]
        if name in ("query", "words"):
            text = query(program) if name == "query" else words()
        elif name in STUDIES or name in PARTS:
            text = with_note((study if name in STUDIES else measured)(name, page, program), program)
        else:
            refuse(f"{page}: knows no part {name}; choose one of {', '.join([*PARTS, *STUDIES])}")
        return match[1] + text + match[3]

    text, count = MARKED.subn(part, (ROOT / page).read_text())
    if count == 0:
        refuse(f"{page}: has no markers; see scripts/lib/measured_parts.py")
    return text
