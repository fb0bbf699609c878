"""What pages and charts ask of a record of `cscd scale`."""


class Record:
    """Subjects by study and scene, and what is asked of them."""

    def __init__(self, record):
        self.raw = record
        self.fits = {(f["study"], f["scene"], f["strategy"], f["quantity"]): f for f in record["fits"]}
        self.ratios = {(r["scene"], r["strategy"], r["step"]): r for r in record["step_ratios"]}
        self.contacts = {(r["scene"], r["strategy"], r["of"]): r for r in record["contact_ratios"]}
        self.thickness = {(r["scene"], r["strategy"], r["thickness"]): r for r in record.get("thickness_ratios", [])}
        names = [row["name"] for subject in record["subjects"] for row in subject["strategies"]]
        self.strategies = list(dict.fromkeys(names))

    def of(self, study, scene=None):
        return [s for s in self.raw["subjects"] if s["study"] == study and scene in (None, s["scene"])]

    def scenes(self, study):
        return list(dict.fromkeys(s["scene"] for s in self.of(study)))

    def names(self, study):
        found = {row["name"] for s in self.of(study) for row in s["strategies"]}
        return [name for name in self.strategies if name in found]

    def fit(self, study, scene, strategy, quantity):
        found = self.fits.get((study, scene, strategy, quantity))
        return found if found and found["exponent"] is not None else None

    def exponent(self, study, scene, strategy, quantity):
        found = self.fit(study, scene, strategy, quantity)
        return f"{found['exponent']:.2f}" if found else "–"


FIRST = " --first"  # ends the name of a row that is asked for the earliest contact alone
MARK = "\\*"  # on a page in Markdown


def guarantee(subject, name):
    return next(row["guarantee"] for row in subject["strategies"] if row["name"] == name)


def lacks(subject, step, name):
    """What a row's answers in a step lack, in words; nothing where it keeps all contacts and promises something from every start. The record
    says it; of an older one it follows from the contacts that the complete rows count in as many intervals."""
    own = row(step, name)
    if not own or not own["intervals"]:
        return ""
    if "shortfall" in own:
        return own["shortfall"]
    promise = guarantee(subject, name)
    if promise == "complete":
        return ""
    starts = len(step["starts"])
    void = starts - step.get("clear", step["embedded"]) if promise in ("first_contact", "all_from_embedded") else 0
    found = contacts_of(own)
    complete = [contacts_of(other) for other in step["strategies"]
                if guarantee(subject, other["name"]) == "complete" and not other["name"].endswith(FIRST)
                and other["intervals"] == own["intervals"]]
    texts = []
    if not name.endswith(FIRST) and complete and found < max(complete):
        texts.append(f"kept {found} of {max(complete)} contacts")
    if not name.endswith(FIRST) and not complete and step["colliding"]:
        texts.append("may have lost contacts, as no complete row answered the same intervals")
    if void > 0:
        texts.append(f"promise void on {void} of {starts} intervals")
    return "; ".join(texts)


def contacts_of(row):
    """All contacts that a row counted in its intervals, of which the record keeps the mean."""
    return round(row["counts"].get("contacts", 0) * row["intervals"])


def mark(subject, step, name):
    """What stands behind every time of a row in a step, as the tables have it (bench/records/shortfall.h)."""
    return MARK if lacks(subject, step, name) else ""


def starred(record, study, scene, name):
    """The name of a row as charts label its times: with a star where any of its steps has a mark."""
    subjects = record.of(study, scene)
    return name + ("*" if any(mark(subject, step, name) for subject in subjects for step in subject["steps"]) else "")


def row(of, name):
    """The row of a strategy, of a step or of a whole subject."""
    return next((r for r in of["strategies"] if r["name"] == name), None)


def series(subjects, name, value, x="triangles"):
    """Points of one strategy over its subjects, positive values alone."""
    points = []
    for subject in subjects:
        prepared, asked = row(subject, name), row(subject["steps"][0], name)
        y = value(prepared, asked) if prepared and asked else None
        if y:
            points.append((subject[x], y))
    return sorted(points)


def stage(key):
    return lambda prepared, asked: asked.get("ms", {}).get(key)


def count(key):
    return lambda prepared, asked: asked["counts"].get(key)


def per_triangle(prepared, asked):
    return prepared.get("held_bytes_per_triangle")


def speedups(record, scene, name):
    """Times as fast as on one thread, by threads; nothing where one has no time."""
    ms = dict(series(record.of("threads", scene), name, stage("total"), "threads"))
    return {threads: ms[1] / value for threads, value in ms.items()} if 1 in ms else {}
