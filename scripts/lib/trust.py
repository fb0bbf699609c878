"""Records of what was done to find faults, in results/trust, and the page that is made of them.

A record is a JSON file named DATE-KIND.json, or DATE-KIND-2.json where that exists, and holds:

  kind      mutants, coverage, kill-cycles, fuzz, ...: part of the name
  title     heading of its section
  says      what was done, in a paragraph
  date, commit, command
  headline  the result, in half a line
  figures   [[name, number or text], ...]
  tables    [{title, head, rows, text_columns, reasons}, ...]

All but figures and tables are texts, and so are the cells of rows. `reasons` is optional and names a file of scripts/lib
with a list of {"reason": text, "places": [[...], ...]}: a row that begins with the cells of a place gets the reason as its last cell,
and a row without a reason is shown as such.
"""
import datetime
import json
import pathlib
import re

from markdown import table
from records import read_json
from script import ROOT, git, refuse
from tracked import tracked_files

FOLDER = ROOT / "results" / "trust"
LIB = ROOT / "scripts" / "lib"
# What the page adds to every record of a kind.
NOTES = {
    "mutants": "The tests came in stages: `room`, quick tests of the folder; `own`, its slower ones; `rooms`, those of folders that use it. "
               "Survivors that a record lists without a reason can be asked again, after tests were written (`scripts/find-faults mutants "
               "--from`). Reasons stand in `scripts/lib/mutants.json`.",
    "sanitizers": "Without `--rooms` the whole suite is asked. With `--from`, only those tests that had failed in an older record.",
    "hostile": "Models are read by a process of its own. Where that process crashes or meets a limit, the program refuses the file in "
               "one line; such a copy is counted as a lost importer, and is no failure.",
}
WITHOUT = "**no reason given**"


def write_record(record):
    """Adds date and commit, writes the record, and says where it is."""
    commit = git("rev-parse", "HEAD") + (" with changes" if git("status", "--porcelain", "--", "core", "library", "CMakeLists.txt") else "")
    whole = {"kind": record["kind"], "title": record["title"], "date": datetime.datetime.now(datetime.timezone.utc).date().isoformat(),
             "commit": commit, **record}
    FOLDER.mkdir(parents=True, exist_ok=True)
    stem, count = f"{whole['date']}-{whole['kind']}", 1
    while (path := FOLDER / (stem + (f"-{count}" if count > 1 else "") + ".json")).exists():
        count += 1
    path.write_text(json.dumps(whole, indent=1, ensure_ascii=False) + "\n")
    print(f"written to {path.relative_to(ROOT)}; git add the file, then run scripts/pages")


def read_records():
    """(path, record), the oldest first."""
    records = []
    for path in tracked_files("results/trust"):
        if path.suffix != ".json":
            continue
        record = read_json(path)
        missing = {"kind", "title", "says", "date", "commit", "command", "headline", "figures", "tables"} - record.keys()
        if missing:
            refuse(f"{path}: lacks {', '.join(sorted(missing))}; scripts/lib/trust.py says what a record holds")
        records.append((path, record))

    def age(pair):  # the second record of a kind and day ends in -2
        number = re.search(r"-(\d+)$", pair[0].stem)
        return pair[1]["date"], int(number[1]) if number else 1, pair[0].name

    return sorted(records, key=age)


def newest_records():
    return {record["kind"]: record for _, record in read_records()}


def reasons_of(name):
    """The reasons of a file by what they are for. Records name the file by where it was when they were made."""
    if not name:
        return {}
    return {tuple(place): entry["reason"] for entry in read_json(LIB / pathlib.Path(name).name) for place in entry["places"]}


def reason_for(row, reasons):
    return next((reasons[tuple(row[:n])] for n in range(len(row), 0, -1) if tuple(row[:n]) in reasons), None)


def rows_without_reason():
    """A line for each newest record of a kind with rows that lack the reason that their table asks for."""
    for kind, record in newest_records().items():
        if bare := sum(reason_for(row, reasons_of(one["reasons"])) is None
                       for one in record["tables"] if "reasons" in one for row in one["rows"]):
            yield f"results/trust/README.md: {bare} rows of the newest record of {kind} lack a reason"


def cell(text):
    return text.replace("|", "\\|")


def section(record):
    lines = [f"## {record['title']}", "", " ".join([record["says"], *([NOTES[record["kind"]]] if record["kind"] in NOTES else [])]), "",
             f"`{record['command']}`, {record['date']}, commit `{record['commit'][:10]}`"
             + (" with changes" if record["commit"].endswith("changes") else "") + ".", ""]
    lines += table(["figure", ""], [[name, str(value)] for name, value in record["figures"]])
    for one in record["tables"]:
        head, rows, text_columns = one["head"], [[cell(text) for text in row] for row in one["rows"]], one["text_columns"]
        if "reasons" in one:
            reasons = reasons_of(one["reasons"])
            head, text_columns = [*head, "reason"], len(head) + 1
            rows = [[*row, cell(reason_for(plain, reasons) or WITHOUT)] for row, plain in zip(rows, one["rows"])]
        lines += ["", f"### {one['title']}", ""]
        lines += table(head, rows, text_columns) if rows else ["None."]
    return lines


def page():
    records = read_records()
    newest = newest_records()
    lines = ["# What was done to find faults", "",
             "Made by `scripts/pages` from the records beside it; `scripts/lib/trust.py` says what a record holds. The table lists",
             "every record. Below it, the newest record of each kind is shown in full. A *room* is a folder of sources with its tests.",
             "What holds answers against an independent truth is not here but in [the proofs and their tests](../../core/soundness.md).", ""]
    lines += table(["date", "what", "result", "record"],
                   [[record["date"], record["title"], record["headline"], f"[{path.name}]({path.name})"]
                    for path, record in reversed(records)], 4)
    for kind in sorted(newest):
        lines += ["", *section(newest[kind])]
    return "\n".join(lines) + "\n"
