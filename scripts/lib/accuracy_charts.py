"""The charts of scripts/figures accuracy."""
from charts import COLOURS, MARKERS, label_panels, log_axis, marker, matplotlib, panels, plt, save, test_colour
from accuracy_sums import GROUPS, base, is_sweep, sums

NOTHING = {"color": "#e8f4e8", "zorder": 0}  # the band in which a share of zero is drawn


def style_of(record):
    """Colour and marker of a row and of its variants."""
    bases = list(dict.fromkeys(base(row["name"]) for row in record["rows"]))
    return {b: {"color": test_colour(b), "marker": marker(b)} for b in bases}


def front_of(points):
    """The points, by name as (cost, loss), that no other point beats in both; cheapest first."""
    def beaten(name):
        cost, loss = points[name]
        return any((c < cost and w <= loss) or (c <= cost and w < loss) for c, w in points.values())

    return sorted((name for name in points if not beaten(name)), key=lambda name: points[name])


def draw_front(axes, points):
    front = [points[name] for name in front_of(points)]
    axes.plot(*zip(*front), color="#bbbbbb", lw=5, zorder=1, solid_capstyle="round")


def draw_floor(axes, floor, losses, text):
    """Sets a logarithmic axis of losses, with a band below in which a loss of zero is drawn, at `floor`."""
    axes.axhspan(floor / 6, floor * 1.6, **NOTHING)
    axes.text(0.99, floor / 3, text, transform=axes.get_yaxis_transform(), ha="right", va="center", fontsize=8, color="#337733")
    axes.set_yscale("log")
    axes.set_ylim(floor / 6, max(10 * floor, 2 * max(losses)))


def symbol(label, **look):
    """An entry of a legend: a marker without a line."""
    return matplotlib.lines.Line2D([], [], ls="", label=label, **{"ms": 7, **look})


def draw_pareto(record, folder, pdf):
    """Wrong answers, misses and false alarms together, against mean time; an undecided answer counts as wrong."""
    styles = style_of(record)
    groups = [(g, title) for g, title in GROUPS.items() if g != "random" and sums(record, lambda w: w["group"] == g)]
    figure, cells = panels(len(groups) + 1, height=3.1, title_height=0)
    for axes, (group, title) in zip(cells, groups):
        rows = sums(record, lambda w: w["group"] == group)
        shares = {n: (r.wrong + r.undecided) / r.queries for n, r in rows.items()}
        one = max(1 / r.queries for r in rows.values())
        floor = min([share for share in shares.values() if share > 0] + [one]) / 5
        points = {n: (r.ns(), max(shares[n], floor)) for n, r in rows.items()}
        draw_front(axes, points)
        for name, (x, y) in points.items():
            look = styles[base(name)]
            axes.plot([x], [y], ls="", ms=4.5 if is_sweep(record, name) else 7.5, zorder=3,
                      mfc="white" if rows[name].false_negatives else look["color"], **look)
        draw_floor(axes, floor, [y for _, y in points.values()], "none wrong")
        axes.set_xscale("log")
        axes.margins(x=0.15)
        axes.set_xlabel("nanoseconds a query")
        axes.set_ylabel("share wrong or undecided")
        axes.set_title(title)
    key = cells[len(groups)]
    key.axis("off")
    handles = [symbol(name, **look) for name, look in styles.items()]
    handles += [symbol("filled: no contact lost", marker="o", color="#666666"),
                symbol("hollow: contacts lost", marker="o", color="#666666", mfc="white"),
                symbol("small: other tolerances", marker="o", color="#666666", ms=4.5),
                matplotlib.lines.Line2D([], [], color="#bbbbbb", lw=5, label="Pareto front")]
    key.legend(handles=handles, fontsize=9, ncol=2, loc="center")
    save(figure, folder, "accuracy-pareto", pdf=pdf)
    return True


def draw_times(axes, title):
    log_axis(axes.yaxis)
    axes.set_ylabel("nanoseconds a query")
    axes.set_title(title)


def draw_shares(axes, title):
    """An axis of shares from zero to all, logarithmic above a ten-thousandth."""
    axes.set_yscale("symlog", linthresh=1e-4)
    axes.set_ylim(-3e-5, 1)
    axes.set_ylabel("share of the queries")
    axes.set_title(title)


def draw_tolerance(record, folder, pdf):
    """Time, false alarms, misses and undecided answers against the tolerance, a panel each."""
    styles = style_of(record)
    tolerances = {row["name"]: row["tolerance"] for row in record["rows"] if "tolerance" in row}
    # Rows of a sweep see the first queries alone, so the others are left out unless they belong to it.
    rows = sums(record, lambda w: w["group"] in ("hard", "open"))
    sweeps = {}
    for one in dict.fromkeys(base(name) for name in tolerances):
        names = sorted((n for n in tolerances if base(n) == one and n in rows and tolerances[n] > 0 and
                        is_sweep(record, n) and ":" not in n), key=lambda n: tolerances[n])
        if len(names) > 1:
            sweeps[one] = names
    if not sweeps:
        return False
    figure, cells = panels(4)
    quantities = (("time", lambda r: r.ns()), ("false alarms", lambda r: r.false_positives / r.queries),
                  ("misses", lambda r: r.false_negatives / r.queries), ("undecided", lambda r: r.undecided / r.queries))
    labelled = []
    for axes, (title, value) in zip(cells, quantities):
        ends = []
        for one, names in sweeps.items():
            points = [(tolerances[n], value(rows[n])) for n in names]
            axes.plot(*zip(*points), ms=4.5, lw=1.4, **styles[one])
            ends.append((*points[-1], one, styles[one]["color"]))
        axes.set_xscale("log")
        axes.set_xlabel("tolerance")
        if title == "time":
            draw_times(axes, title)
        else:
            draw_shares(axes, title)
        labelled.append((axes, ends))
    figure.suptitle("hard suite and open query set; tolerance of cubic and inclusion in extents of the query,\nof additive "
                    "as a share of the starting distance", fontsize=9)
    label_panels(labelled)
    save(figure, folder, "accuracy-tolerance", pdf=pdf)
    return True


def draw_hardness(record, folder, pdf):
    """Time, wrong answers and undecided answers against the hardness, a panel each."""
    styles = style_of(record)
    hardnesses = sorted({w["hardness"] for w in record["workloads"] if "hardness" in w}, reverse=True)
    if len(hardnesses) < 2:
        return False
    by = {h: sums(record, lambda w: w.get("hardness") == h) for h in hardnesses}
    names = [row["name"] for row in record["rows"] if not row["sweep"]]
    figure, cells = panels(3, columns=1, title_height=0)
    figure.set_size_inches(8, 8)
    labelled = []
    for axes, (title, value) in zip(cells, (("time", lambda r: r.ns()), ("wrong", lambda r: r.wrong / r.queries),
                                            ("undecided", lambda r: r.undecided / r.queries))):
        ends = []
        for name in names:
            points = [(h, value(by[h][name])) for h in hardnesses]
            if title == "undecided" and not any(y for _, y in points):
                continue
            look = styles[base(name)]
            axes.plot(*zip(*points), ms=4.5, lw=1.4, **look)
            ends.append((*points[-1], name, look["color"]))
        axes.set_xscale("log")
        axes.invert_xaxis()
        if title == "time":
            draw_times(axes, title)
        else:
            draw_shares(axes, title)
        labelled.append((axes, ends))
    cells[2].set_xlabel("hardness: off the degenerate lattice by this share of the size")
    label_panels(labelled)
    save(figure, folder, "accuracy-hardness", pdf=pdf)
    return True


def settings_by_knob(knobs):
    return list(dict.fromkeys(setting["knob"] for knob in knobs for setting in knob["settings"]))


def draw_knobs(record, folder, pdf):
    """Time and contacts found, knob by knob: two panels each, a curve a scene."""
    knobs = record.get("knobs", [])
    if not knobs:
        return False
    names = settings_by_knob(knobs)
    columns = min(3, len(names))
    bands = -(-len(names) // columns)
    figure, cells = plt.subplots(2 * bands, columns, figsize=(8, 3.3 * bands), squeeze=False, height_ratios=[1.3, 1] * bands)
    for axes in cells.flat:
        axes.set_visible(False)
    for place, name in enumerate(names):
        band, column = divmod(place, columns)
        top, bottom = cells[2 * band][column], cells[2 * band + 1][column]
        for number, knob in enumerate(knobs):
            settings = [s for s in knob["settings"] if s["knob"] == name]
            x = range(len(settings))
            look = {"color": COLOURS[number % len(COLOURS)], "marker": MARKERS[number % len(MARKERS)], "ms": 4, "lw": 1.2}
            found = [100 * s["contacts"] / knob["contacts"] if knob["contacts"] else 100 for s in settings]
            top.plot(x, [s["ms"] / knob["default_ms"] for s in settings], label=knob["scene"], **look)
            bottom.plot(x, found, **look)
            for i, s in enumerate(settings):
                if s["lost_first"]:
                    bottom.plot([i], [found[i]], "x", color="red", ms=9, mew=1.5, zorder=4)
            labels = [s["value"] for s in settings]
        for axes in (top, bottom):
            axes.set_visible(True)
            axes.set_xticks(range(len(labels)))
            axes.set_xlim(-0.4, len(labels) - 0.6)
        top.set_xticklabels([])
        bottom.set_xticklabels(labels, rotation=60 if max(map(len, labels)) > 5 else 0,
                               ha="right" if max(map(len, labels)) > 5 else "center", fontsize=8)
        top.set_title(name)
    ratios = [t["ms"] / knob["default_ms"] for knob in knobs for t in knob["settings"]]
    least = min([t["contacts"] / knob["contacts"] for knob in knobs for t in knob["settings"] if knob["contacts"]] + [1])
    for band in range(bands):  # one scale for all
        for top, bottom in zip(cells[2 * band], cells[2 * band + 1]):
            top.set_ylim(min(ratios) / 1.3, max(ratios) * 1.3)
            log_axis(top.yaxis)
            bottom.set_ylim(100 - 108 * (1 - least) - 0.05, 100 + 8 * (1 - least) + 0.05)
        cells[2 * band][0].set_ylabel("time")
        cells[2 * band + 1][0].set_ylabel("found, %")
    handles, labels = cells[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncol=3, fontsize=9, title_fontsize=9,
                  title="time of an interval, where the default takes 1; share of contacts found (red cross: a first one lost)")
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 0.75 / figure.get_size_inches()[1]))
    save(figure, folder, "accuracy-knobs", pdf=pdf)
    return True


def draw_knob_front(record, folder, pdf):
    """All settings of all knobs at once: contacts that are missing against time."""
    knobs = [knob for knob in record.get("knobs", []) if knob["contacts"]]
    if not knobs:
        return False
    names = settings_by_knob(knobs)
    looks = {name: {"color": COLOURS[n % len(COLOURS)], "marker": MARKERS[n % len(MARKERS)]} for n, name in enumerate(names)}
    wide = 4 if len(knobs) > 1 else 2
    lines = -(-(len(names) + 1) // wide)
    figure, cells = panels(len(knobs), title_height=0.25 * lines + 0.15)
    for number, (axes, knob) in enumerate(zip(cells, knobs)):
        floor = 0.3 / knob["contacts"]
        points = {i: (s["ms"] / knob["default_ms"], max(1 - s["contacts"] / knob["contacts"], floor))
                  for i, s in enumerate(knob["settings"])}
        draw_front(axes, points)
        for i, s in enumerate(knob["settings"]):
            look = looks[s["knob"]]
            axes.plot(*points[i], ls="", ms=6, mfc="white" if s["lost_first"] else look["color"], zorder=3, **look)
        axes.axvline(1, color="#999999", lw=0.8, ls=":", zorder=0)
        draw_floor(axes, floor, [y for _, y in points.values()], "none missing")
        log_axis(axes.xaxis)
        axes.set_title(f"{knob['scene']}: {knob['contacts']:,} contacts", fontsize=9)
        axes.set_xlabel("time of an interval, default = 1")
        if number % 2 == 0:
            axes.set_ylabel("share of contacts missing")
    handles = [symbol(name, **looks[name]) for name in names]
    handles.append(symbol("hollow: a first contact lost", marker="o", color="#666666", mfc="white"))
    figure.legend(handles=handles, ncol=wide, loc="upper center", fontsize=9)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - (0.25 * lines + 0.1) / figure.get_size_inches()[1]))
    save(figure, folder, "accuracy-knob-front", pdf=pdf)
    return True


def draw_all(record, folder, pdf=False):
    """Draws what the record has, as PDF too where that is asked for; returns the names of the charts that were drawn."""
    drawings = {"pareto": draw_pareto, "tolerance": draw_tolerance, "hardness": draw_hardness, "knobs": draw_knobs,
                "knob-front": draw_knob_front}
    return {name for name, draw in drawings.items() if draw(record, folder, pdf)}
