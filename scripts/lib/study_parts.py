"""Parts of pages (measured_parts.py) whose records hold no tables: studies of their own, and the glossary."""
from accuracy_sums import Accuracy, GROUPS
from markdown import built, number, table
from motion_table import rate_table
from records import read_json
from scale_page import summary
from scale_record import Record
from script import ROOT


def page_in(folder, up, name):
    """The link to a page of a results folder. `up` leads from the page that has the link to the root."""
    return f"{up}{folder.relative_to(ROOT).as_posix()}/{name}"


def motion(folders, up, program):
    """How often the true motion of characters differs from straight lines, and what it costs."""
    folder = folders["motion"]
    record = read_json(folder / "motion.json.gz")
    lines = rate_table(record)
    left_out = [one["model"] for one in record["left_out"]]
    return "\n".join(lines + [
        *([f"Left out: {', '.join(left_out)}; the record says why."] if left_out else []),
        f"Measured on {built(record['environment'])}; [model by model]({page_in(folder, up, 'motion.md')})."]) + "\n"


SHOWN_GROUPS = ("scenes", "open", "hard")


def accuracy(folders, up, program):
    """What each elementary test gets wrong, and what it takes."""
    folder = folders["accuracy"]
    record = Accuracy(folder / "accuracy.json.gz", program)
    by_group = {group: found for group in SHOWN_GROUPS if (found := record.sums(f"group {group}"))}
    names = [row["name"] for row in record.rows if not row["sweep"]]

    def cells(found):
        return ["–"] * 2 if found is None else [number(found.ns), f"{found.lost:,}, {found.invented:,}, {found.undecided:,}"]

    head = ["test", *(title for group in by_group for title in (f"{GROUPS[group]}: ns a query", "lost, invented, undecided"))]
    rows = [[f"`{name}`", *(cell for found in by_group.values() for cell in cells(found.get(name)))] for name in names]
    asked = "; ".join(f"{GROUPS[group]} {one.queries:,} queries, {one.contacts:,} in contact"
                      for group, found in by_group.items() for one in [found[names[0]]])
    return "\n".join([*table(head, rows), "", f"Asked were: {asked}.",
                      f"Measured on {built(record.raw['environment'])}; [what to choose, with every figure]({page_in(folder, up, 'accuracy.md')})."]) + "\n"


def growth(folders, up, program):
    """What a reader wants to know first of how cost grows, study by study."""
    lines = []
    for kind, folder in folders.items():
        record = Record(folder / "scale.json.gz", program)
        lines += [f"- {GROWTH[kind]}: [the page]({page_in(folder, up, 'scale.md')}). {' '.join(summary(record))}".rstrip()]
    return "\n".join(lines) + "\n"


GROWTH = {"scale": "Triangles, steps, bones, threads and contacts", "scale-largest": "Up to 3.1 million triangles",
          "scale-contacts": "Contacts of cloth", "thickness": "Thickness", "solver": "Small steps"}


def words():
    """What words mean, as `cscd list` explains them."""
    glossary = read_json(ROOT / "bench" / "output" / "glossary.json")
    return "\n".join(table(["word", "means"], [[f"`{word['name']}`" if "_" in word["name"] else word["name"], word["means"]]
                                              for word in glossary["words"]], text_columns=2)) + "\n"


# By the name of a part: the kinds of records that it is made of, as far as git tracks one, and the function that makes it.
STUDIES = {"motion": (("motion",), motion), "accuracy": (("accuracy",), accuracy), "growth": (tuple(GROWTH), growth)}
