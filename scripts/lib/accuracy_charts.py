"""The charts of scripts/figures accuracy."""
from charts import GREY, label_panels, log_axis, marker, matplotlib, panels, save, test_colour
from accuracy_sums import GROUPS, base

NOTHING = {"color": "#e8f4e8", "zorder": 0}  # the band in which a share of zero is drawn


def style_of(record):
    """Colour and marker of a row and of its variants."""
    bases = list(dict.fromkeys(base(row["name"]) for row in record.rows))
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
    groups = [(g, title) for g, title in GROUPS.items() if g != "random" and record.sums(f"group {g}")]
    figure, cells = panels(len(groups) + 1, height=3.1, title_height=0)
    for axes, (group, title) in zip(cells, groups):
        rows = record.sums(f"group {group}")
        shares = {n: (r.lost + r.invented + r.undecided) / r.queries for n, r in rows.items()}
        one = max(1 / r.queries for r in rows.values())
        floor = min([share for share in shares.values() if share > 0] + [one]) / 5
        points = {n: (r.ns, max(shares[n], floor)) for n, r in rows.items()}
        draw_front(axes, points)
        for name, (x, y) in points.items():
            look = styles[base(name)]
            axes.plot([x], [y], ls="", ms=4.5 if record.is_sweep(name) else 7.5, zorder=3,
                      mfc="white" if rows[name].lost else look["color"], **look)
        draw_floor(axes, floor, [y for _, y in points.values()], "none wrong")
        axes.set_xscale("log")
        axes.margins(x=0.15)
        axes.set_xlabel("nanoseconds a query")
        axes.set_ylabel("share wrong or undecided")
        axes.set_title(title)
    key = cells[len(groups)]
    key.axis("off")
    handles = [symbol(name, **look) for name, look in styles.items()]
    handles += [symbol("filled: no contact lost", marker="o", color=GREY),
                symbol("hollow: contacts lost", marker="o", color=GREY, mfc="white"),
                symbol("small: other tolerances", marker="o", color=GREY, ms=4.5),
                matplotlib.lines.Line2D([], [], color="#bbbbbb", lw=5, label="Pareto front")]
    key.legend(handles=handles, fontsize=9, ncol=2, loc="center")
    save(figure, folder, "accuracy-pareto", pdf=pdf)
    return True


def set_scale(axes, title):
    """An axis of times, or of shares from zero to all, logarithmic above a ten-thousandth."""
    if title == "time":
        log_axis(axes.yaxis)
        axes.set_ylabel("nanoseconds a query")
    else:
        axes.set_yscale("symlog", linthresh=1e-4)
        axes.set_ylim(-3e-5, 1)
        axes.set_ylabel("share of the queries")
    axes.set_title(title)


def draw_tolerance(record, folder, pdf):
    """Time, false alarms, misses and undecided answers against the tolerance, a panel each."""
    styles = style_of(record)
    tolerances = {row["name"]: row["tolerance"] for row in record.rows if "tolerance" in row}
    # Rows of a sweep see the first queries alone, so the others are left out unless they belong to it.
    rows = record.sums("sweep")
    sweeps = {}
    for one in dict.fromkeys(base(name) for name in tolerances):
        names = sorted((n for n in tolerances if base(n) == one and n in rows and tolerances[n] > 0 and
                        record.is_sweep(n) and ":" not in n), key=lambda n: tolerances[n])
        if len(names) > 1:
            sweeps[one] = names
    if not sweeps:
        return False
    figure, cells = panels(4)
    quantities = (("time", lambda r: r.ns), ("false alarms", lambda r: r.invented / r.queries),
                  ("misses", lambda r: r.lost / r.queries), ("undecided", lambda r: r.undecided / r.queries))
    labelled = []
    for axes, (title, value) in zip(cells, quantities):
        ends = []
        for one, names in sweeps.items():
            points = [(tolerances[n], value(rows[n])) for n in names]
            axes.plot(*zip(*points), ms=4.5, lw=1.4, **styles[one])
            ends.append((*points[-1], one, styles[one]["color"]))
        axes.set_xscale("log")
        axes.set_xlabel("tolerance")
        set_scale(axes, title)
        labelled.append((axes, ends))
    figure.suptitle("hard suite and open query set; tolerance of cubic and inclusion in extents of the query,\nof additive "
                    "as a share of the starting distance", fontsize=9)
    label_panels(labelled)
    save(figure, folder, "accuracy-tolerance", pdf=pdf)
    return True


def draw_hardness(record, folder, pdf):
    """Time, wrong answers and undecided answers against the hardness, a panel each."""
    styles = style_of(record)
    hardnesses = sorted({w["hardness"] for w in record.raw["workloads"] if "hardness" in w}, reverse=True)
    if len(hardnesses) < 2:
        return False
    by = {h: record.sums(f"hardness {h:g}") for h in hardnesses}
    names = [row["name"] for row in record.rows if not row["sweep"]]
    figure, cells = panels(3, columns=1, title_height=0)
    figure.set_size_inches(8, 8)
    labelled = []
    for axes, (title, value) in zip(cells, (("time", lambda r: r.ns), ("wrong", lambda r: (r.lost + r.invented) / r.queries),
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
        set_scale(axes, title)
        labelled.append((axes, ends))
    cells[2].set_xlabel("hardness: off the degenerate lattice by this share of the size")
    label_panels(labelled)
    save(figure, folder, "accuracy-hardness", pdf=pdf)
    return True


def draw_all(record, folder, pdf=False):
    """Draws what the record has, as PDF too where that is asked for; returns the names of the charts that were drawn."""
    drawings = {"pareto": draw_pareto, "tolerance": draw_tolerance, "hardness": draw_hardness}
    return {name for name, draw in drawings.items() if draw(record, folder, pdf)}
