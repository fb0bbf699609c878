"""The small table of a record of `scripts/record motion`, for its own page and for the page of characters."""
from markdown import number, table

MOST_RATIO = 5  # the aim: so many times a straight query, at most


def ratio(rows):
    """Times of the true motion over those of straight lines, of some rows of one rate."""
    straight = sum(row["ms"]["straight"] for row in rows)
    return sum(row["ms"]["true"] for row in rows) / straight if straight else None


def whole_ratio(rows):
    """How many times longer whole queries take with the true motion than without it."""
    whole = sum(row["ms"]["whole"] for row in rows)
    return (whole + sum(row["ms"]["true"] for row in rows)) / whole if whole else None


def by_rate(record):
    """For each rate its characters' and its scenes' rows."""
    for fps in record["rates"]:
        of = [(subject, next(row for row in subject["rates"] if row["fps"] == fps)) for subject in record["subjects"]]
        yield fps, [row for subject, row in of if not subject["scene"]], {s["model"]: row for s, row in of if s["scene"]}


def rate_table(record):
    """Lines of the small table, a row a rate, and what it says of the aim."""
    scenes = [subject["model"] for subject in record["subjects"] if subject["scene"]]
    rows, ratios = [], []
    for fps, characters, of_scene in by_rate(record):
        every = [*characters, *of_scene.values()]
        ratios += [value for value in (ratio([row]) for row in of_scene.values()) if value]
        rows.append([str(fps), f"{sum(row['asked'] for row in every):,}", str(sum(len(row["differ"]) for row in every)),
                     *map(number, [whole_ratio(characters), ratio(characters), ratio(list(of_scene.values())), *(ratio([row]) for row in of_scene.values())])])
    lines = table(["frames a second", "intervals asked", "answers that differ", "characters, whole query", "characters", "scenes", *scenes], rows)
    missed = sum(value > MOST_RATIO for value in ratios)
    return lines + ["", "A whole query takes so many times longer with `--true-motion`, preparation and intervals that start crossed included. The columns after "
                    "that say how many times an answer about straight lines one about the true motion takes, in intervals that are asked about "
                    f"both. The aim is at most {MOST_RATIO} on the scenes, and it is "
                    + (f"missed in {missed} of {len(ratios)} of their cells." if missed else "met.")]
