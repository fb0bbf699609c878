"""The page of how cost grows, from a record of `cscd scale`."""
from looks import LOOKS
from markdown import built, number, picture, table
from scale_record import FIRST, MARK, count, mark, per_triangle, row, series, speedups, stage

LONG = 3  # the step, in frames, at which time is to be nearly that of one frame
MANY = 16  # threads that the page foresees
JUMP = 1.25  # exponent between neighbouring sizes above which one exponent over all sizes says too little
STEEP = 1.1  # exponent above which time grows faster than the triangles
NOWHERE = (f"Nowhere in this record, as far as these rules see: `drvbc_fast` loses where its time grows faster than with the power {STEEP} "
           "of the triangles, or jumps from one size to the next; where another row is faster in every repetition; and where long "
           "steps, contacts or bones cost it far more than they should. Preparation and other rows are not judged.")
CONTACTS = 2  # times what the plain scene takes: what contacts may cost
STAGES = [(key, title) for key, title, _ in LOOKS["stages"]]
QUANTITIES = (("ms", stage("total")), ("preparation, ms", lambda prepared, asked: prepared["make_ms"]), ("BVOT", count("bvot")),
              ("PCTP", count("pctp")), ("bytes a triangle", per_triangle))


def marks(steps, name):
    """The mark of a ratio of times of these steps."""
    return "".join(sorted({mark(step, name) for step in steps}))


def long_ratio(record, scene, name):
    """Time at LONG frame steps over that at one, or None, and its mark."""
    steps = record.of("step", scene)[0]["steps"]
    return record.ratios.get((scene, name, LONG)), marks([step for step in steps if step["step"] in (1, LONG)], name)


def contact_ratio(record, scene, name, of="median_interval"):
    """Time with contacts over that without, or None, and its mark."""
    return record.contacts.get((scene, name, of)), marks(record.of("contacts", scene)[0]["steps"], name)


def brief(ratio, mark_of):
    return f"{ratio['ratio']:.2f}{mark_of}"


def bounded(ratio, mark_of):
    """A ratio with the mark of its times, and its interval, where it has one."""
    if not ratio:
        return "–"
    return brief(ratio, mark_of) + (f" [{ratio['low']:.2f}, {ratio['high']:.2f}]" if "low" in ratio else "")


def by_row(names, quantities, cells):
    """Lines of a table, one for each row and quantity; `cells(name, title, value)` are those behind its title."""
    return [[f"`{name}`: {title}", *cells(name, title, value)] for name in names for title, value in quantities]


def drawing(drawn, name, title):
    return picture(f"scale-{name}", title) if name in drawn else []


def size_part(record, drawn):
    scenes = record.scenes("size")
    if not scenes:
        return []
    first = record.names("size")[0]
    sizes = [s["triangles"] for s in record.of("size")]
    text = ["## With triangles", "",
            f"Each scene with {min(sizes):,} to {max(sizes):,} triangles in the same motion. Exponents of a least-squares line in "
            "log-log: 1 is linear, 2 quadratic.", ""]
    laws = [("time", "total"), *((title, key) for key, title in STAGES), ("preparation", "make_ms"), ("BVOT", "bvot"), ("PCTP", "pctp")]
    lines = by_row(record.names("size"), laws, lambda name, _, key: [record.exponent("size", scene, name, key) for scene in scenes])
    lines = [line for line in lines if any(cell != "–" for cell in line[1:])]
    text += table(["exponent"] + scenes, lines) + ["", "–: absent, or zero at all but two sizes.", ""]
    text += drawing(drawn, "size", "time against triangles")
    largest = {scene: max(record.of("size", scene), key=lambda s: s["triangles"]) for scene in scenes}

    def cell(name, title, value, subject):
        pair = row(subject, name), row(subject["steps"][0], name)
        return number(value(*pair)) + (mark(subject["steps"][0], name) if title == "ms" else "") if all(pair) else "–"

    lines = by_row(record.names("size"), QUANTITIES, lambda *of: [cell(*of, largest[scene]) for scene in scenes])
    text += ["At the largest size:", ""]
    text += table(["", *(f"{scene}, {largest[scene]['triangles']:,}" for scene in scenes)], lines) + [""]
    text += drawing(drawn, "stages", f"stages of {first} against triangles")
    text += drawing(drawn, "pairs", "overlap tests and pairs against triangles")
    text += ["Memory is what stays resident when the strategy has been made and has answered twice, over what was there before; "
             "small surfaces pay for whole pages.", ""]
    text += drawing(drawn, "memory", "bytes a triangle against triangles")
    return text


def step_part(record, drawn):
    scenes = record.scenes("step")
    if not scenes:
        return []
    text = ["## With the length of the step", "",
            "The same surfaces, intervals that end more or fewer frames later. A share of a frame ends on the straight line to "
            f"the next. Time at {LONG} frame steps over that at 1, [95 % interval]:", ""]
    text += table([f"{LONG}x over 1x"] + scenes, [
        [f"`{name}`", *(bounded(*long_ratio(record, scene, name)) for scene in scenes)]
        for name in record.names("step")]) + [""]
    text += drawing(drawn, "step", "time against the length of the step")
    steps = [step["step"] for step in record.of("step")[0]["steps"]]
    by_length = {scene: {step["step"]: step for step in record.of("step", scene)[0]["steps"]} for scene in scenes}
    lines = [[scene, *(f"{by[s]['colliding']} of {len(by[s]['starts'])}" if s in by else "–" for s in steps)]
             for scene, by in by_length.items()]
    text += ["Intervals with a contact. Beyond one frame step vertices move in straight lines where the scene's bones turn, so "
             "that limbs pass through each other that never meet in the scene:", ""]
    text += table(["step"] + [f"{length:g}" for length in steps], lines) + [""]
    name = record.names("step")[0]
    lines = []
    for scene in scenes:
        by = {length: row(step, name) for length, step in by_length[scene].items()}
        for key in ("bvot", "pctp"):
            lines.append([f"{scene}: {key.upper()}"] + [number(by[s]["counts"].get(key)) if s in by else "–" for s in steps])
        lines.append([f"{scene}: ms"] + [number(by[s].get("ms", {}).get("total")) + mark(by_length[scene][s], name)
                                         if s in by else "–" for s in steps])
    text += [f"`{name}`, step by step:", ""] + table(
        ["step"] + [f"{length:g}" for length in steps], lines) + [""]
    return text


def bones_part(record, drawn):
    scenes = record.scenes("bones")
    if not scenes:
        return []
    text = ["## With bones", "", "The same surface in the same motion; the chain's bones are merged or cut.", ""]
    for scene in scenes:
        subjects = record.of("bones", scene)

        def cells(name, title, value):
            found = dict(series(subjects, name, value, "bones"))
            return [number(found.get(s["bones"], 0)) + (mark(s["steps"][0], name) if title == "ms" else "") for s in subjects]

        lines = by_row(record.names("bones"), QUANTITIES, cells)
        text += table([f"{scene}, bones"] + [str(s["bones"]) for s in subjects], lines) + [""]
    return text + drawing(drawn, "bones", "time against bones")


def predicted(subjects, name):
    """How many times as fast as on one thread MANY would be, by Amdahl's law fitted to each stage, or None.

    A stage that takes a on one thread and b on n has the serial share (n b / a - 1) / (n - 1), held to [0, 1]."""
    most = max(s["threads"] for s in subjects)
    if most == 1:
        return None
    one, many = 0, 0
    for key, _ in STAGES:
        found = dict(series(subjects, name, stage(key), "threads"))
        if not found.get(1) or found.get(most) is None:
            continue
        serial = min(1, max(0, (most * found[most] / found[1] - 1) / (most - 1)))
        one += found[1]
        many += found[1] * (serial + (1 - serial) / MANY)
    return one / many if many else None


def threads_part(record, drawn):
    scenes = record.scenes("threads")
    if not scenes:
        return []
    where = record.raw["environment"]
    text = ["## With threads", "", f"The same surface; the machine has {where['cores']} hardware threads. "
            "–: no time, as an answer was wrong or a stage has nothing to do.", ""]
    beyond = []
    for scene in scenes:
        subjects = record.of("threads", scene)
        lines = []
        for name in record.names("threads"):
            for key, title in (("total", "ms"), *STAGES):
                found = dict(series(subjects, name, stage(key), "threads"))
                if found:
                    lines.append([f"`{name}`: {title}"] + [number(found.get(s["threads"])) + mark(s["steps"][0], name) for s in subjects])
            found = speedups(record, scene, name)
            lines.append([f"`{name}`: times as fast as on one"] + [number(found.get(s["threads"])) for s in subjects])
            if foreseen := predicted(subjects, name):
                beyond.append([f"`{name}` on {scene}", number(foreseen)])
        text += table([f"{scene}, {subjects[0]['triangles']:,} triangles, threads"] +
                      [str(s["threads"]) for s in subjects], lines) + [""]
    if beyond:
        text += [f"Not measured: what {MANY} threads would gain if each stage kept its serial share (Amdahl's law, fitted to one thread "
                 "and the largest number above).", "", *table(["", f"times as fast on {MANY} threads"], beyond), ""]
    return text + drawing(drawn, "threads", "times as fast against threads")


def contacts_part(record, drawn):
    scenes = record.scenes("contacts")
    if not scenes:
        return []
    steps = {scene: record.of("contacts", scene)[0]["steps"] for scene in scenes}
    text = ["## With contacts", "",
            "Each scene and its variant that collides and is pushed apart, in turn, in the intervals of their clips: the same "
            "surface, prepared once. A row with `--first` is asked for the earliest contact alone, the others for all that they "
            "find. Time of the median interval with contacts over that without, [95 % interval]:", ""]
    def ratios(of):
        return [[f"`{name}`", *(bounded(*contact_ratio(record, s, name, of)) for s in scenes)] for name in record.names("contacts")]

    lines = [["intervals with a contact"] + [f"{steps[s][1]['colliding']} of {len(steps[s][1]['starts'])}" for s in scenes]]
    text += table(["with over without"] + scenes, lines + ratios("median_interval")) + [""]
    for scene in scenes:
        reasons = {}
        for one in record.of("contacts", scene)[0].get("left_out", []):
            reasons.setdefault(one["why"].split(":")[0], []).append(f"`{one['name']}`")
        text += [f"Not run on {scene}: {', '.join(names)} ({why})." for why, names in reasons.items()]
    text += ([""] if text[-1] else []) + drawing(drawn, "contacts", "time with contacts over time without")
    text += ["The same of all intervals together, where few with many contacts weigh as much as they take:", ""]
    text += table(["with over without"] + scenes, ratios("total")) + [""]

    def cell(name, title, value, step):
        own = row(step, name)
        return number(value(own)) + (mark(step, name) if "ms" in title else "") if own else "–"

    quantities = (("ms, median interval", lambda r: r.get("ms", {}).get("median_interval")), ("ms, mean", lambda r: r.get("ms", {}).get("total")),
                  ("elementary tests, ms", lambda r: r.get("ms", {}).get("elementary")), ("PCTP", lambda r: r["counts"].get("pctp")))
    lines = by_row(record.names("contacts"), quantities,
                   lambda *of: [" → ".join(cell(*of, step) for step in steps[scene]) for scene in scenes])
    return text + ["Without → with:", ""] + table([""] + scenes, lines) + [""]


def thickness_part(record):
    scenes = record.scenes("thickness")
    if not scenes:
        return []
    names = record.names("thickness")
    base, others = names[0], names[1:]
    text = ["## With a thickness", "",
            "Features count that come within a thickness, in mean edges of the surface at rest, of each other; 0 is touching. Clear starts: "
            f"starts in which nothing crosses and nothing is that close. Milliseconds a query, the mean; in brackets, times the same row at 0; "
            f"then, how many times faster than `{base}` whose boxes grow by the same thickness.", ""]
    lines = []
    for scene in scenes:
        subject = record.of("thickness", scene)[0]
        for step in subject["steps"]:
            starts, thickness = len(step["starts"]), step["thickness"]
            cells = [scene, f"{thickness:g}", f"{step['clear']} of {starts}", f"{step['colliding']} of {starts}"]
            unit = row(step, base)
            for name in names:
                own = row(step, name)
                if not own or "ms" not in own:
                    cells.append("–")
                    continue
                ratio = record.thickness.get((scene, name, thickness))
                cells.append(number(own["ms"]["total"]) + mark(step, name)
                             + (f" ({ratio['ratio']:.2f})" if ratio else "")
                             + (f", {number(unit['ms']['total'] / own['ms']['total'])} times" if name in others and unit and "ms" in unit else ""))
            pairs = row(step, names[-1])
            lines.append(cells + [number(pairs["counts"].get("contacts")) if pairs and pairs["intervals"] else "–"])
    head = ["scene", "thickness", "clear starts", "with close pairs", *(f"`{name}`" for name in names), f"close pairs, `{names[-1]}`"]
    return text + table(head, lines) + [""]


def small_part(record, drawn):
    scenes = record.scenes("small")
    if not scenes:
        return []
    names = record.names("small")
    text = ["## Small steps", "",
            "Steps as a solver takes them, between the clip's frames on straight lines. Of a series of 25, every fourth is measured, and a time is the mean of these: substeps follow each "
            "other; trials, whole, half and a quarter of a step, begin where the substeps before them end; iterations creep towards an end, each 0.9 times "
            "as long as the one before. How far a step (of iterations, the first) moves, as its first frame does, and a thickness, are in mean edges at "
            "rest; where the clip is too short for a series, steps are shorter. Milliseconds a query, the mean; reading: what it "
            "takes to read the positions of both ends once.", ""]
    lines = []
    for scene in scenes:
        for step in (step for subject in record.of("small", scene) for step in subject["steps"]):
            rows = [timed(step, name) for name in names]
            reading = [own["streaming_ms"] for own in rows if own and "streaming_ms" in own]
            lines.append([scene, step["series"], f"{step['moves']:g}", f"{step['thickness']:g}", f"{step['colliding']} of {len(step['starts'])}",
                          *(time_of(step, own) if own else "–" for own in rows), number(min(reading) if reading else None)])
    head = ["scene", "series", "moves", "thickness", "with contacts", *(f"`{name}`" for name in names), "reading"]
    return text + table(head, lines, 2) + [""] + drawing(drawn, "small", "time against how far small steps move")


def timed(step, name):
    """The row of a strategy in a step, or None where it has no time."""
    own = row(step, name)
    return own if own and "ms" in own else None


def slower(mine, theirs):
    """Whether a row took longer than another in every repetition. Less than that is noise."""
    of = [row.get("total_samples") or [row["ms"]["total"]] for row in (mine, theirs)]
    return min(of[0]) > max(of[1])


def time_of(step, own):
    """What a row takes in a step, with its mark."""
    return number(own["ms"]["total"]) + mark(step, own["name"])


def beaten(where, step, name, rows):
    """In a sentence, that the fastest of some rows is faster than a row; nothing where none is."""
    mine, best = timed(step, name), min((r for r in rows if "ms" in r), key=lambda r: r["ms"]["total"], default=None)
    if not mine or not best or not slower(mine, best):
        return []
    return [f"{where}: `{best['name']}` is faster than `{name}`, {time_of(step, best)} against {time_of(step, mine)} ms."]


def losses(record):
    """What grows faster than it should, by rule, so that a new record changes it without a hand."""
    found = []
    for scene in record.scenes("size"):
        name, *others = record.names("size")
        subjects = sorted(record.of("size", scene), key=lambda s: s["triangles"])
        for smaller, larger in zip(subjects, subjects[1:]):
            growth = larger["triangles"] / smaller["triangles"]
            times = [timed(s["steps"][0], name) for s in (smaller, larger)]
            ratio = times[1]["ms"]["total"] / times[0]["ms"]["total"] if all(times) else 0
            if ratio > growth ** JUMP:
                found.append(f"{scene}: from {smaller['triangles']:,} to {larger['triangles']:,} triangles, {growth:.1f} times as "
                             f"many, the time of `{name}` grows {ratio:.1f} times.")
        law = record.fit("size", scene, name, "total")
        if law and law["exponent"] > STEEP:
            found.append(f"{scene}: the time of `{name}` grows with exponent {law['exponent']:.2f}, more than linearly.")
        for subject in record.of("size", scene):
            step = subject["steps"][0]
            mine = timed(step, name)
            found += [f"{scene} with {subject['triangles']:,} triangles: `{name}` takes {time_of(step, mine)} ms, `{other}` {time_of(step, theirs)} ms."
                      for other in others if mine and (theirs := timed(step, other)) and slower(mine, theirs)]
    for scene in record.scenes("step"):
        name = record.names("step")[0]
        ratio = long_ratio(record, scene, name)
        if ratio[0] and ratio[0]["ratio"] > 1.5:
            found.append(f"{scene}: `{name}` takes {brief(*ratio)} times as long at {LONG} frame steps as at one.")
        for step in record.of("step", scene)[0]["steps"]:
            found += beaten(f"{scene} at {step['step']:g} frame steps", step, name, step["strategies"])
    for scene in record.scenes("contacts"):
        name = record.of("contacts", scene)[0]["strategies"][0]["name"]
        for asked in (name, name + FIRST):
            for of, title in (("median_interval", "in the median interval"), ("total", "over all intervals")):
                ratio = contact_ratio(record, scene, asked, of)
                if ratio[0] and ratio[0]["ratio"] > CONTACTS:
                    found.append(f"{scene} with contacts: `{asked}` takes {brief(*ratio)} times as long as without, {title}.")
        for step in record.of("contacts", scene)[0]["steps"]:
            found += beaten(step["scene"], step, name, [r for r in step["strategies"] if not r["name"].endswith(FIRST)])
    for scene in record.scenes("bones"):
        law = record.fit("bones", scene, record.names("bones")[0], "total")
        if law and law["exponent"] > 0.5:
            found.append(f"{scene}: time grows with the number of bones, exponent {law['exponent']:.2f}.")
    return found


def checked_part(record):
    raw = record.raw
    steps = [step for subject in raw["subjects"] for step in subject["steps"]]
    failures = [f for step in steps for f in step["verified"]["failures"]]
    against = sum(step["verified"]["by_reference"] for step in steps)
    other = sum(step["verified"]["by_each_other"] for step in steps)
    embedded = sum(step["embedded"] for step in steps)
    where = raw["environment"]
    text = ["## How to read it", "",
            f"- {against} intervals were answered by the complete reference too and held against it"
            + (f"; on {other} of large surfaces the strategies were held against each other" if other else "")
            + f". {embedded} of {against + other} start embedded. "
            + ("All answers right." if not failures else "WRONG: " + "; ".join(failures)),
            "- BVOT counts pairs of bounding volumes that were compared, PCTP pairs of triangles that were passed on to the elementary tests.",
            "- Where the reference answers fewer intervals, its times and counters are of those alone.",
            "- Times are medians over repetitions of the mean over the intervals, strategies interleaved in random order; "
            "counters are means.",
            "- A strategy that follows the surface forgets what it adapted to, and then answers as many intervals of the same length before each one "
            f"that is timed as the clip has, up to {max(max(step['leads']) for step in steps)}." if all("leads" in step for step in steps) else
            "- Unlike `cscd run`, this study makes no pass over the intervals before it takes times, and no strategy forgets what it adapted to: one that "
            "follows the surface has the clusters that the intervals asked before left it, which lie further apart than those of a simulation.",
            "- Body and limbs are subdivided above the scene's own resolution (Loop), tubes and boxes built anew.",
            f"- {built(where)}.", "",
            f"Command: `{' '.join(raw['command'])}`"]
    return text


def mark_part(record):
    """The footnote of every mark: which rows lack what, in which steps."""
    lines = []
    for subject in record.raw["subjects"]:
        for step in subject["steps"]:
            where = f"{subject['study']}, {step['scene']}" + (
                f", {step['series']} of {step['moves']:g} edges" if "moves" in step else "") + (
                f", thickness {step['thickness']:g}" if "thickness" in step else f", step {step['step']:g}" if subject["study"] == "step" else "") + (
                f", {subject['triangles']:,} triangles" if subject["study"] == "size" else "")
            rows = [f"`{own['name']}` ({text})" for own in step["strategies"] if "ms" in own and (text := step["lacking"].get(own["name"]))]
            lines += [f"- {where}: {', '.join(rows)}"] if rows else []
    if not lines:
        return []
    return [f"## What {MARK} stands for", "", f"{record.shortfall_meaning}. A "
            "promise is void on an interval whose start is not embedded: the surface crosses itself there, or with a thickness, something is close.",
            "", *lines, ""]


SMALL_STEP = {"series": "substeps", "moves": 0.01, "thickness": 0}


def small_step(record):
    """What a small step takes with a list of what is near, and what it takes without, in milliseconds by scene."""
    steps = {scene: step for scene in record.scenes("small") for subject in record.of("small", scene) for step in subject["steps"]
             if all(step[key] == value for key, value in SMALL_STEP.items())}
    rows = {scene: [timed(step, name) for name in ("drvbc_fast_near", "drvbc_fast_complete")] for scene, step in steps.items()}
    return {scene: [found["ms"]["total"] for found in of] for scene, of in rows.items() if all(of)}


def small_step_text(record):
    """In a sentence without its subject, how long small steps take, and how much longer they would without a list; nothing where a record
    has none."""
    times = small_step(record)
    if not times:
        return ""
    near, ratios = sorted(ms for ms, _ in times.values()), sorted(without / ms for ms, without in times.values())
    return (f"that moves {SMALL_STEP['moves']:g} of the mean edge takes {number(near[0])} to {number(near[-1])} ms on {', '.join(times)}, {number(ratios[0])} to "
            f"{number(ratios[-1])} times faster than the same method without its list of near pairs")


def summary(record):
    """The figures that a reader wants first, a line each."""
    names = record.names("size") or record.names("step") or record.names("contacts") or record.names("thickness") or record.names("small")
    text, parts = [], []
    for scene in record.scenes("size"):
        law = record.fit("size", scene, names[0], "total")
        if law:
            parts.append(f"{scene} {law['exponent']:.2f}")
    if parts:
        text += [f"`{names[0]}`, time against triangles, exponents: {', '.join(parts)}."]
    ratios = [f"{scene} {brief(*ratio)}" for scene in record.scenes("step") if (ratio := long_ratio(record, scene, names[0]))[0]]
    if ratios:
        text += [f"Time at {LONG} frame steps over that at one: {', '.join(ratios)}."]
    for name in (names[0], names[0] + FIRST):
        ratios = [f"{scene} {brief(*ratio)}" for scene in record.scenes("contacts") if (ratio := contact_ratio(record, scene, name))[0]]
        if ratios:
            text += [f"`{name}`, the median interval's time with contacts over that without: {', '.join(ratios)}."]
    if small := small_step_text(record):
        text += [f"A substep {small}."]
    return text


def page(record, drawn):
    text = ["# How cost grows", ""]
    if record.raw["smoke"]:
        text += ["**A small run: it shows that everything works; its times mean nothing.**", ""]
    text += summary(record)
    if any(record.scenes(study) for study in ("size", "step", "contacts", "bones")):
        lost = losses(record)
        text += ["", "## Where it loses", ""] + ([f"- {line}" for line in lost] or [NOWHERE])
    text += [""] + size_part(record, drawn) + step_part(record, drawn) + bones_part(record, drawn) + threads_part(record, drawn)
    text += contacts_part(record, drawn) + thickness_part(record) + small_part(record, drawn)
    text += mark_part(record)
    text += checked_part(record)
    return "\n".join(text) + "\n"
