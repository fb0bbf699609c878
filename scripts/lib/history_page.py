"""results/history/README.md: what each row took, commit by commit, and the changes of level that `cscd history` finds."""
import pathlib
import shutil
import tempfile

from markdown import number, table
from script import ROOT, answer_of
from tracked import tracked_files

FOLDER = ROOT / "results" / "history"


def marked(point):
    """What a row took at a commit, with the mark of one that did not answer everything, or is not known to have."""
    return number(point["median"]) + point["mark"].replace("*", "\\*")


def page(program):
    """The page, from the entries that git tracks."""
    with tempfile.TemporaryDirectory() as folder:
        for path in tracked_files(FOLDER):
            copy = pathlib.Path(folder, path.relative_to(FOLDER))
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copy)
        history = answer_of(program, "history", folder)
    courses = history["courses"]
    lines = ["# What each commit took", "", "Made by `scripts/pages` from the entries beside this page (`cscd history`): whole queries, "
             "medians over processes. `cscd report results/FOLDER --history results/history` draws them.", ""]
    if (FOLDER / "notes.md").exists():
        lines += ["What is known about the steps stands in the [notes](notes.md).", ""]
    for machine in dict.fromkeys(course["machine"] for course in courses):
        every = [course for course in courses if course["machine"] == machine]
        several = [course for course in every if len(course["points"]) > 1]
        commits = {point["commit"] for course in several for point in course["points"]}
        once = len(every) - len(several)
        lines += [f"## {machine}", "", f"{len(commits)} commits." + (
            f" {once} more rows of scenes were measured at a single commit." if once else ""), ""]
        rows = [[course["scene"], f"`{course['row']}`", f"`{change['commit'][:10]}`",
                 marked(course["points"][change["first"] - 1]), marked(course["points"][change["first"]]), f"{100 * (change['ratio'] - 1):+.1f} %"] for course in several for change in course["changes"]]
        lines += table(["scene", "row", "first commit of the new level", "ms before", "ms at it", "level"], rows,
                       text_columns=3) if rows else ["No change of level was found."]
        lines.append("")
    return "\n".join(lines + [line.replace("* ", "\\* ", 1) + "\n" for line in history["note"].splitlines()])
