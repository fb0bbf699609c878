"""results/README.md: one row a record that git tracks, from the records alone; and whether git has the commits that records name."""
import re
import subprocess

from markdown import table
from records import read_json
from scale_page import page as scale_page
from scale_record import Record
from script import ROOT, refuse
from tracked import git, is_checkout, tracked_files

RESULTS = ROOT / "results"
KINDS = ("full", "starts", "cloth", "real", "accuracy", "benchmark", "scale-contacts", "scale-largest", "scale", "thickness", "solver", "motion", "sets", "latency", "waits")
PAGES = ("tables.md", "claims.md", "accuracy.md", "scale.md", "benchmark.md", "motion.md", "sets.md", "latency.md", "waits.md", "notes.md")
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
| solver | `scripts/record solver --real DIR` | what small steps cost, as a solver takes them |
| motion | `scripts/record motion DIR` | where the true motion of characters differs from straight lines, and what it costs to ask |
| sets | `scripts/record sets` | what the instruction set costs: AVX-512, AVX2, SSE2 and WebAssembly in Node |
| latency; at first waits | `scripts/record latency BASE` | preparation, all contacts, contacts, long steps and threads, before and after |

The newest record of each kind is here. A record (`*.json.gz`) is never rewritten after its day; whatever is found out later stands
in a `notes.md` in its folder, which says when it was written. A page beside a record may be made anew from it, as `scripts/pages`
does with pages of how cost grows. Records are compressed; `cscd tables` and the scripts read them as they are. `cscd report` makes
a page of all figures of a record, `scripts/figures` draws the paper's Figures 11 and 12, and `cscd tables --out` writes tables as TeX; the few
pictures beside records are those that pages show.

What single commits took, one small file each, is on [a page of its own](history/README.md), and so is [what was done to find
faults](trust/README.md): mutants, coverage and the like.

## Older records

A record leaves this folder when a newer one of its kind comes; git keeps it. The first command lists the folders that were here,
each below the commit that removed it, and the second shows a file of such a folder as it was before COMMIT:

    git log --diff-filter=D --format='%n%h %s' --name-only -- 'results/*/*.md'
    git show COMMIT^:results/FOLDER/tables.md

## Records that are here
"""


# Commits that records name and git does not have, and why that is so. The page of results prints the reasons.
MISSING_COMMITS = {
    "52b1cc0b60": "the record of the true motion was measured from a commit that was rewritten before it came here, so its sources cannot be "
                  "built again; the record came with commit `c78c47848e`",
}


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
    missing = [f"\nGit has no commit `{commit}`: {why}.\n" for commit, why in MISSING_COMMITS.items()]
    return HEAD + "\n" + "\n".join(table(["date", "kind", "machine", "commit", "pages"], rows, text_columns=5)) + "\n" + "".join(missing)


def scale_pages(program):
    """By name, how the page of each record of `cscd scale` is made of the record and of the charts beside it."""
    pages = {}
    for path in tracked_files("results"):
        if path.name == "scale.json.gz":
            drawn = {chart.stem.removeprefix("scale-") for chart in path.parent.glob("scale-*.png")}
            name = (path.parent / "scale.md").relative_to(ROOT).as_posix()
            pages[name] = lambda path=path, drawn=drawn: scale_page(Record(path, program), drawn)
    return pages


def commits_named():
    """The commits that records and entries of the history name, each with a file that names it."""
    named = {}
    for path in tracked_files("results"):
        document = read_json(path) if path.name.endswith((".json", ".json.gz")) else None
        if not isinstance(document, dict):
            continue
        notes = document.get("notes")
        for part in (document, document.get("environment"), notes.get("environment") if isinstance(notes, dict) else None):
            if isinstance(part, dict) and isinstance(part.get("commit"), str):
                named.setdefault(part["commit"].split(" ")[0], path)  # "with changes" may follow
    return named


def commit_faults():
    """Commits that git does not have although a record names them, and reasons in MISSING_COMMITS that nothing needs any more. Finds nothing
    where git cannot know: in an export, in a clone without the whole history, and where the files were put into a repository of their own."""
    if not is_checkout(ROOT) or git(ROOT, "rev-parse", "--is-shallow-repository") != ["false"]:
        return []
    named = commits_named()
    asked = "".join(f"{commit}^{{commit}}\n" for commit in named)
    done = subprocess.run(["git", "-C", str(ROOT), "cat-file", "--batch-check"], input=asked, capture_output=True, text=True, check=True)
    lost = {commit: path for (commit, path), line in zip(named.items(), done.stdout.splitlines()) if " commit " not in line}
    faults = [f"{path.relative_to(ROOT)}: git has no commit {commit[:10]}; measure from a commit that stays, or say why in MISSING_COMMITS "
              "(scripts/lib/results_index.py)" for commit, path in lost.items() if commit[:10] not in MISSING_COMMITS]
    if len(lost) == len(named):
        return []
    needed = {commit[:10] for commit in lost}
    return faults + [f"MISSING_COMMITS (scripts/lib/results_index.py): {commit} is not missing, or no record names it; remove the line"
                     for commit in MISSING_COMMITS if commit not in needed]
