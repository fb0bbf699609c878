"""results/history/README.md: how fast each row was, commit by commit, and the changes of level that `cscd history` finds."""
import pathlib
import shutil
import tempfile

from markdown import number, table
from script import ROOT, answer_of
from tracked import tracked_files

FOLDER = ROOT / "results" / "history"


def marked(point):
    """How much faster a row was at a commit, with the mark of one that did not answer everything, or is not known to have."""
    return number(point["median"]) + point["mark"].replace("*", "\\*")


def page(program):
    """The page, from the entries that git tracks."""
    with tempfile.TemporaryDirectory() as folder:
        for path in tracked_files(FOLDER):
            copy = pathlib.Path(folder, path.relative_to(FOLDER))
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copy)
        history = answer_of(program, "history", folder)
    courses = [course for course in history["courses"] if len(course["points"]) > 1]
    once = len(history["courses"]) - len(courses)
    commits, machines = ({point[what] for course in courses for point in course["points"]} for what in ("commit", "machine"))
    lines = ["# How fast each commit was", "", "Made by `scripts/pages` from the entries beside this page (`cscd history`): how many times faster a row answers "
             "a query than another row of the same run, medians over processes. Machines differ in speed, so speedups are followed and times are not. "
             "`cscd report results/FOLDER --history results/history` draws them.", ""]
    if (FOLDER / "notes.md").exists():
        lines += ["What is known about the steps stands in the [notes](notes.md).", ""]
    lines += [f"{len(commits)} commits on {len(machines)} kinds of machine. {once} more rows of scenes were measured at a single commit.", ""]
    rows = [[course["scene"], f"`{course['row']}` over `{course['over']}`", f"`{change['commit'][:10]}`",
             marked(course["points"][change["first"] - 1]), marked(course["points"][change["first"]]), f"{100 * (change['ratio'] - 1):+.1f} %"]
            for course in courses for change in course["changes"]]
    lines += table(["scene", "row", "first commit of the new level", "before", "at it", "level"], rows,
                   text_columns=3) if rows else ["No change of level was found."]
    lines.append("")
    return "\n".join(lines + [line.replace("* ", "\\* ", 1) + "\n" for line in history["note"].splitlines()])
