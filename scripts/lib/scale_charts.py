"""The charts of scripts/figures scale: a panel a scene, a curve a strategy. A star behind a name says that some of its times have a mark on the page."""
from charts import (GREY, RED, STAGES, label_panels, left_out, line_style, log_axis, marker, panels, plt, save, shown, spans_decades,
                    ticks)
from scale_record import count, per_triangle, row, series, speedups, stage, starred

FEW_ROWS = 4  # strategies in a chart that has two curves for each


def style(name):
    return {**line_style(name), "marker": marker(name)}


def draw_curve(axes, points, label, law=None, **look):
    """Draws measured points and, dotted, the power law fitted to them, whose exponent follows the label. Returns the end of the
    curve for its label; nothing where nothing was measured."""
    if not points:
        return []
    if law:
        xs = [points[0][0], points[-1][0]]
        axes.plot(xs, [law["factor"] * x ** law["exponent"] for x in xs], lw=0.9, ls=":", color=look["color"])
        label += f" {law['exponent']:.2f}".replace("-", "−")
    axes.plot(*zip(*points), **{"ms": 4.5, "lw": 1.4, **look})
    return [(*points[-1], label, look["color"])]


def draw_scenes(scenes, folder, name, draw, x_label, y_label, title=""):
    """One panel a scene. `draw(axes, scene)` draws its curves, sets its axes, and returns the curves' ends."""
    if not scenes:
        return False
    figure, cells = panels(len(scenes), title_height=0.4 if title else 0.1)
    labelled = []
    for number, (axes, scene) in enumerate(zip(cells, scenes)):
        labelled.append((axes, draw(axes, scene)))
        axes.set_title(scene, fontsize=9)
        axes.set_xlabel(x_label)
        if number % 2 == 0:
            axes.set_ylabel(y_label)
    if title:
        figure.suptitle(title, fontsize=9)
    label_panels(labelled)
    save(figure, folder, f"scale-{name}")
    return True


def triangles_text(n):
    return f"{n / 1e6:.1f} M" if n >= 1e6 else f"{n / 1e3:.0f} k"


def draw_sizes(record, folder, name, curves, y_label, title="", study="size", x="triangles", from_zero=False):
    """One panel a scene of a study, against a size of its surface. `curves(scene)` yields a row, its value, label, quantity of the fitted
    law or None, and look."""
    def draw(axes, scene):
        subjects, ends = record.of(study, scene), []
        for row_name, value, label, quantity, look in curves(scene):
            law = record.fit(study, scene, row_name, quantity) if quantity else None
            ends += draw_curve(axes, series(subjects, row_name, value, x), label, law, **look)
        axes.set_xscale("log")
        if from_zero:
            axes.set_ylim(bottom=0)
        else:
            log_axis(axes.yaxis)
        ticks(axes, sorted({s[x] for s in subjects}), triangles_text if x == "triangles" else str)
        return ends

    return draw_scenes(record.scenes(study), folder, name, draw, x, y_label, title)


def draw_times(record, folder, everything, study="size", x="triangles", title="dotted: fitted power laws, their exponents beside the names"):
    names, missing = shown(record.names(study), everything)
    return draw_sizes(record, folder, study, lambda scene: (
        (name, stage("total"), starred(record, study, scene, name), "total", style(name)) for name in names),
        "ms a query, refit included", (title + left_out(missing)).strip(), study, x)


def draw_bones(record, folder, everything):
    return draw_times(record, folder, everything, "bones", "bones", "")


def draw_stages(record, folder, everything):
    first = next(iter(record.names("size")), "")
    return draw_sizes(record, folder, "stages", lambda scene: (
        (first, stage(key), key, key, {"color": colour, "marker": "o"}) for key, colour in STAGES.items()), f"{first}, ms",
        "dotted: fitted power laws, their exponents beside the names")


def draw_pairs(record, folder, everything):
    names, missing = shown(record.names("size"), everything, FEW_ROWS)
    looks = (("bvot", {"ls": "-"}), ("pctp", {"ls": "--", "mfc": "white"}))
    return draw_sizes(record, folder, "pairs", lambda scene: (
        (name, count(key), f"{name} {key.upper()}", key, {**style(name), **look}) for name in names for key, look in looks), "a query",
        "filled: overlap tests (BVOT); hollow: triangle pairs (PCTP), zero left out" + left_out(missing))


def draw_memory(record, folder, everything):
    names, missing = shown(record.names("size"), everything)
    return draw_sizes(record, folder, "memory", lambda scene: ((name, per_triangle, name, None, style(name)) for name in names),
                      "bytes a triangle", left_out(missing).strip(), from_zero=True)


def draw_step(record, folder, everything):
    names, missing = shown(record.names("step"), everything)

    def draw(axes, scene):
        steps = record.of("step", scene)[0]["steps"]
        ends = []
        for name in names:
            ends += draw_curve(axes, [(step["step"], asked["ms"]["total"]) for step in steps
                                      if (asked := row(step, name)) and "ms" in asked], starred(record, "step", scene, name), **style(name))
        for step in steps:
            if step["colliding"]:
                axes.axvspan(step["step"] / 1.19, step["step"] * 1.19, color=RED, zorder=0, lw=0,
                             alpha=0.2 * step["colliding"] / len(step["starts"]))
        axes.set_xscale("log")
        log_axis(axes.yaxis)
        ticks(axes, [step["step"] for step in steps], lambda length: f"{length:g}")
        return ends

    return draw_scenes(record.scenes("step"), folder, "step", draw, "step, in frame steps", "ms a query, refit included",
                       "shaded: steps with contacts, the darker the more of their intervals have one" + left_out(missing))


def draw_small(record, folder, everything):
    """Steps that follow each other, where touching counts, and what reading the positions takes."""
    names, missing = shown(record.names("small"), everything)

    def draw(axes, scene):
        steps = [step for subject in record.of("small", scene) for step in subject["steps"] if step["series"] == "substeps" and not step["thickness"]]
        ends = []
        for name in names:
            asked = [(step["moves"], own) for step in steps if (own := row(step, name)) and "ms" in own]
            ends += draw_curve(axes, [(moves, own["ms"]["total"]) for moves, own in asked], starred(record, "small", scene, name), **style(name))
        reading = [(step["moves"], min(found)) for step in steps if (found := [own["streaming_ms"] for own in step["strategies"] if "streaming_ms" in own])]
        ends += draw_curve(axes, reading, "reading positions", color=GREY, ls=":")
        axes.set_xscale("log")
        log_axis(axes.yaxis)
        ticks(axes, [step["moves"] for step in steps], lambda moves: f"{moves:g}")
        return ends

    return draw_scenes(record.scenes("small"), folder, "small", draw, "how far a step moves, in mean edges", "ms a query, refit included",
                       left_out(missing).strip())


def draw_threads(record, folder, everything):
    names, missing = shown(record.names("threads"), everything)

    def draw(axes, scene):
        counts = [s["threads"] for s in record.of("threads", scene)]
        axes.plot(counts, counts, lw=0.9, ls=":", color=GREY)
        ends = [(counts[-1], counts[-1], "ideal", GREY)]
        for name in names:
            ends += draw_curve(axes, list(speedups(record, scene, name).items()), starred(record, "threads", scene, name), **style(name))
        if spans_decades(counts):
            axes.set_xscale("log")
        axes.set_ylim(bottom=0)
        ticks(axes, counts, str)
        return ends

    scenes = [scene for scene in record.scenes("threads") if len(record.of("threads", scene)) > 1]
    return draw_scenes(scenes, folder, "threads", draw, "threads", "times as fast as on one",
                       "dotted: as many times as fast as there are threads" + left_out(missing))


def draw_contacts(record, folder, most):
    """Bars; a dotted line at `most`, the ratio that contacts may cost."""
    scenes, names = record.scenes("contacts"), record.names("contacts")
    if not scenes:
        return False
    figure, axes = plt.subplots(figsize=(8, 3.4))
    wide = 0.8 / len(names)
    for i, name in enumerate(names):
        found = [(x - 0.4 + (i + 0.5) * wide, ratio) for x, scene in enumerate(scenes)
                 if (ratio := record.contacts.get((scene, name, "median_interval")))]
        look = line_style(name)
        # A family has one colour. What its dash tells apart in curves, dots do in bars.
        filling = {}
        if name.endswith(" --first"):
            filling = {"alpha": 0.55, "hatch": "////", "edgecolor": "white"}
        elif look["ls"] != "-":
            filling = {"hatch": "..", "edgecolor": "white"}
        label = max((starred(record, "contacts", scene, name) for scene in scenes if row(record.of("contacts", scene)[0], name)), key=len, default=name)
        axes.bar([x for x, _ in found], [r["ratio"] for _, r in found], wide, label=label, color=look["color"], **filling)
        for x, r in found:
            if "low" in r:
                axes.plot([x] * 2, [r["low"], r["high"]], color=GREY, lw=1)
    axes.axhline(1, color=GREY, lw=0.8)
    axes.axhline(most, color=GREY, lw=0.8, ls=":")
    axes.set_xticks(range(len(scenes)), scenes)
    axes.grid(axis="x", visible=False)
    axes.set_ylabel("time with contacts,\nover time without")
    axes.legend(fontsize=8, ncols=min(4, len(names)), loc="lower center", bbox_to_anchor=(0.5, 1))
    save(figure, folder, "scale-contacts")
    return True


def draw_all(record, folder, everything, most_for_contacts):
    """Draws what the record has; returns the names of the charts that were drawn."""
    drawings = {"size": draw_times, "stages": draw_stages, "pairs": draw_pairs, "memory": draw_memory, "step": draw_step,
                "bones": draw_bones, "threads": draw_threads, "small": draw_small}
    drawn = {name for name, draw in drawings.items() if draw(record, folder, everything)}
    return drawn | ({"contacts"} if draw_contacts(record, folder, most_for_contacts) else set())
