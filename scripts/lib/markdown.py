"""Parts of Markdown pages, and links from page to page, which a file that is moved or a heading that is renamed would leave dead."""
import re

from script import ROOT
from tracked import tracked_files


def table(head, rows, text_columns=1):
    """Lines of a table. The first columns hold text and stand to the left, the others numbers, to the right."""
    rule = "|" + "---|" * text_columns + "---:|" * (len(head) - text_columns)
    return ["| " + " | ".join(head) + " |", rule] + ["| " + " | ".join(row) + " |" for row in rows]


def number(value):
    """A figure as `cscd` writes it (figure_text in core/base/number_text.h): three significant digits, all digits before the point,
    commas between thousands; a dash for nothing."""
    return "–" if value is None else f"{value:,.0f}" if 999.5 <= abs(value) < 1e15 else f"{value:.3g}"


def picture(name, title):
    return [f"![{title}]({name}.png)", ""]


def built(environment):
    """Where and from what a record was made, in a line."""
    instructions = f", {environment['instruction_set']}" if "instruction_set" in environment else ""
    changes = " with uncommitted changes" if environment["dirty"] else ""
    return (f"{environment['cpu']}, {environment['cores']} cores; {environment['compiler']}, {environment['build_type']}"
            f"{instructions}; commit {environment['commit'][:12]}{changes}; {environment['date'][:10]}")


def anchors(page):
    """The names of a page's headings, as links have them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def dead_links():
    """What is wrong with each link of a tracked page that leads nowhere, pages of records included."""
    faults = []
    for page in tracked_files():
        if page.suffix != ".md":
            continue
        for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
            name, _, anchor = link.partition("#")
            to = page.parent / name if name else page
            if "://" in link or to.exists() and (not anchor or to.suffix != ".md" or anchor in anchors(to)):
                continue
            faults.append(f"{page.relative_to(ROOT)}: the link to {link} leads nowhere; name the file or the heading that is meant")
    return faults
