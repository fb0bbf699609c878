"""What pages and charts ask of a record of `cscd scale`."""
from records import read_json, study_of


class Record:
    """Subjects by study and scene, and what is asked of them. Each step has `lacking`: by row, what its answers lack, as the document of
    figures says."""

    def __init__(self, path, program):
        growth = study_of(program, path, "growth")
        self.raw = record = read_json(path)
        self.shortfall_meaning = growth["shortfall_meaning"].replace("*", MARK)
        for subject, steps in zip(record["subjects"], growth["shortfalls"]):
            for step, lacking in zip(subject["steps"], steps):
                step["lacking"] = lacking
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


def mark(step, name):
    """What stands behind every time of a row in a step."""
    return MARK if name in step["lacking"] else ""


def starred(record, study, scene, name):
    """The name of a row as charts label its times: with a star where any of its steps has a mark."""
    subjects = record.of(study, scene)
    return name + ("*" if any(mark(step, name) for subject in subjects for step in subject["steps"]) else "")


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
