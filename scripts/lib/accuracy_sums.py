"""Sums over the workloads of a record of `cscd accuracy`."""

CLASSES = ("far", "near", "contact")
GROUPS = {
    "scenes": "pairs of the scenes",
    "open": "open query set",
    "hard": "hard suite",
    "random": "random families, all hardnesses",
    "close": "hard families at a distance",
}


class Sum:
    """One row over several workloads: counts; time a query as the mean over workloads of the median over blocks."""

    def __init__(self):
        self.counts = dict.fromkeys(("queries", "contacts", "false_negatives", "false_positives", "undecided_contacts",
                                     "undecided_apart"), 0)
        self.time = {}  # class: [queries, nanoseconds in all]
        self.late = self.early = 0.0
        self.p99 = 0.0
        self.distance = None

    def add(self, row):
        for key in self.counts:
            self.counts[key] += row[key]
        for name, cell in row.get("ns", {}).items():
            total = self.time.setdefault(name, [0, 0.0])
            total[0] += cell["queries"]
            total[1] += cell["queries"] * cell["median"]
        if "time_error" in row:
            self.late = max(self.late, row["time_error"]["largest_late"])
            self.early = max(self.early, row["time_error"]["largest_early"])
            self.p99 = max(self.p99, row["time_error"]["p99"])
        if "false_positive_distance" in row:
            self.distance = max(self.distance or 0.0, row["false_positive_distance"]["largest"])

    def __getattr__(self, name):
        return self.counts[name]

    @property
    def wrong(self):
        return self.false_negatives + self.false_positives

    @property
    def undecided(self):
        return self.undecided_contacts + self.undecided_apart

    def ns(self, *classes):
        """Mean a query, over the named classes (all when none is named); None where nothing was timed."""
        cells = [self.time[c] for c in (classes or CLASSES) if c in self.time]
        queries = sum(cell[0] for cell in cells)
        return sum(cell[1] for cell in cells) / queries if queries else None


def sums(record, keep):
    """Of every row, over the workloads that `keep` lets through; rows that saw nothing are left out."""
    result = {}
    for workload in record["workloads"]:
        if keep(workload):
            for row in workload["rows"]:
                if row["queries"]:
                    result.setdefault(row["row"], Sum()).add(row)
    return result


def is_sweep(record, name):
    return next(row for row in record["rows"] if row["name"] == name)["sweep"]


def base(name):
    return name.split("@")[0]
