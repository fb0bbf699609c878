"""What pages and charts ask of a record of `cscd accuracy`: its rows and, from the document of figures, its sums over workloads."""
from types import SimpleNamespace

from looks import LOOKS
from records import read_json, study_of

GROUPS = dict(LOOKS["groups"])


class Accuracy:
    def __init__(self, path, program):
        self._sums = study_of(program, path, "accuracy")
        self.raw = read_json(path)
        self.rows = self.raw["rows"]

    def sums(self, kind):
        """Of every row, over the workloads of a kind, such as "group hard" (bench/tables/studies_json.h); rows that saw nothing are left out."""
        nothing = dict.fromkeys(("ns", "ns_near", "ns_contact", "distance"), None) | dict.fromkeys(("late", "early", "p99"), 0.0)
        found = self._sums.get(kind, {})
        return {row["name"]: SimpleNamespace(**nothing | found[row["name"]]) for row in self.rows if row["name"] in found}

    def stages(self, kind):
        """The numbers of queries that `filtered_exact` answered in each of its stages."""
        return self._sums["stages"][kind]

    def is_sweep(self, name):
        return next(row for row in self.rows if row["name"] == name)["sweep"]


def base(name):
    return name.split("@")[0]
