"""Links from page to page, which a file that is moved or a heading that is renamed would leave dead."""
import re

from script import ROOT
from tracked import tracked_files


def anchors(page):
    """The names of a page's headings, as links have them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def dead():
    """What is wrong with each link of a tracked page that leads nowhere. Records are left as they were written."""
    faults = []
    for page in tracked_files():
        if page.suffix != ".md" or re.match(r"results/\d", page.relative_to(ROOT).as_posix()):
            continue
        for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
            name, _, anchor = link.partition("#")
            to = page.parent / name if name else page
            if "://" in link or to.exists() and (not anchor or to.suffix != ".md" or anchor in anchors(to)):
                continue
            faults.append(f"{page.relative_to(ROOT)}: the link to {link} leads nowhere; name the file or the heading that is meant")
    return faults
