"""results/README.md: one row a record that git tracks, from the records alone."""
import re

from markdown import table
from records import read_json
from script import ROOT, refuse
from tracked import tracked_files

RESULTS = ROOT / "results"
KINDS = ("full", "starts", "cloth", "real", "accuracy", "benchmark", "scale-contacts", "scale-largest", "scale", "thickness", "motion", "latency", "waits")
PAGES = ("tables.md", "claims.md", "accuracy.md", "scale.md", "benchmark.md", "motion.md", "latency.md", "waits.md", "notes.md")
HEAD = """# Records

Made by `scripts/pages` from the records themselves. A folder is named by its date, its machine, its commit
and its kind.

| kind | made by | says |
|---|---|---|
| full | `scripts/reproduce --full --scene all` | every strategy, ablation and today's packages, verified and timed |
| starts | `scripts/reproduce --starts --scene all` | what a query takes where its start is known, and where it is not |
| cloth | `scripts/reproduce --cloth` | sheets, a bag and a skirt: the complete strategies, and what covers that follow are worth |
| real | `scripts/record real DIR` | steps of real simulations, every contact held against truth from outside |
| accuracy | `scripts/record accuracy` | what every elementary test gets wrong, and what accuracy costs |
| benchmark | `scripts/record benchmark` | scores of this project's strategies and today's packages on [the public benchmark](../bench/BENCHMARK.md) |
| scale, scale-largest, scale-contacts | `scripts/record scale`; with `--largest`; `cscd scale --study contacts` | how cost grows with triangles, steps, bones, threads, contacts |
| thickness | `scripts/record thickness --real DIR` | what it costs that features count which come within a distance |
| motion | `scripts/record motion DIR` | where the true motion of characters differs from straight lines, and what it costs to ask |
| latency; at first waits | `scripts/record latency BASE` | preparation, all contacts, contacts, long steps and threads, before and after |

The newest record of each kind is here. A record is never rewritten after its day; whatever is found out later stands in a
`notes.md` in its folder, which says when it was written. Records (`*.json.gz`) are compressed; `cscd tables` and the scripts
read them as they are. `cscd report` makes a page of all figures of a record, `scripts/figures` draws them as files, and
`cscd tables --out` writes them as TeX; the few pictures beside records are those that pages show.

What single commits took, one small file each, is on [a page of its own](history/README.md), and so is [what was done to find
faults](trust/README.md): mutants, coverage and the like.

## Older records

A record leaves this folder when a newer one of its kind comes; git keeps it. The first command lists the folders that were here,
each below the commit that removed it, and the second shows a file of such a folder as it was before COMMIT:

    git log --diff-filter=D --format='%n%h %s' --name-only -- 'results/*/*.md'
    git show COMMIT^:results/FOLDER/tables.md

## Records that are here
"""


def kind_of(folder):
    return next((kind for kind in KINDS if folder.name.endswith("-" + kind)), "normal")


def folders_of(files):
    """Folder to the names of its files. Small runs, whose folders git ignores, are no records, and neither is a run that has not ended."""
    folders = {}
    for path in files:
        folder = path.parent
        if folder.parent == RESULTS and folder.suffix != ".part" and "-smoke" not in folder.name:
            folders.setdefault(folder, []).append(path.name)
    return folders


def first_record(folder, names):
    for name in names:
        if name.endswith((".json", ".json.gz")) and not name.startswith("tables.json"):
            try:
                record = read_json(folder / name)
            except (OSError, ValueError) as error:
                refuse(f"{folder / name}: cannot be read ({error}); write the record anew, or remove it from git")
            if str(record.get("schema", "")).startswith("cscd."):
                return record
    return None


def environment_of(record):
    """Where a record was measured. A score keeps that in the notes of whoever answered."""
    return record["environment"] if "environment" in record else record["notes"]["environment"]


def page():
    rows = []
    for folder, names in folders_of(tracked_files("results")).items():
        record = first_record(folder, names)
        if record is None:
            continue
        environment = environment_of(record)
        links = ", ".join(f"[{name.removesuffix('.md')}]({folder.name}/{name})" for name in PAGES if name in names)
        rows.append((environment["date"], folder.name,
                     [environment["date"][:10], kind_of(folder),
                      f"{re.sub(r'[(]R[)]| Processor', '', environment['cpu'])}, {environment['cores']} cores, "
                      f"{environment.get('instruction_set', 'instruction set not recorded')}",
                      f"`{environment['commit'][:10]}`", links]))
    rows = [row for _, _, row in sorted(rows, reverse=True)]
    return HEAD + "\n" + "\n".join(table(["date", "kind", "machine", "commit", "pages"], rows, text_columns=5)) + "\n"
