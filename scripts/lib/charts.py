"""One look for all charts: a strategy has one colour and one dash everywhere, curves are labelled at their ends, and a
picture is a small PNG whose bytes depend on the record alone."""
import io
import itertools
import math
import sys
import zlib

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({
    "figure.dpi": 150, "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
    "grid.alpha": 0.3, "legend.frameon": False, "figure.constrained_layout.use": True,
    "pdf.fonttype": 42,  # text stays text, which a reader can search and a journal asks for
})
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of backend)
import matplotlib.ticker  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

from looks import LOOKS  # noqa: E402

RED, GREY = "#D55E00", "#666666"  # of contacts; of what is no row
STRATEGIES, TESTS, STAGES, FIRST_SHOWN = LOOKS["strategies"], LOOKS["tests"], {key: colour for key, _, colour in LOOKS["stages"]}, LOOKS["first"]
COLOURS = list(dict.fromkeys([look["colour"] for look in STRATEGIES.values()] + list(TESTS.values())))
MARKERS = "osD^vPX*<>h"
MOST_CURVES = 8  # of a chart, unless all are asked for


def _of_unknown(name, choices):
    return choices[zlib.crc32(name.encode()) % len(choices)]


def line_style(strategy):
    """Colour and dash of a strategy; a row such as "base --first" looks like its strategy."""
    look = STRATEGIES.get(strategy.split(" ")[0], {"colour": _of_unknown(strategy, COLOURS), "dash": []})
    return {"color": look["colour"], "ls": ":" if " --first" in strategy else (0, look["dash"]) if look["dash"] else "-"}


def marker(name):
    known = list(STRATEGIES) + list(TESTS)
    return MARKERS[known.index(name.split(" ")[0]) % len(MARKERS)] if name.split(" ")[0] in known else _of_unknown(name, MARKERS)


def test_colour(name):
    return TESTS.get(name) or _of_unknown(name, COLOURS)


def shown(names, all_of_them=False, most=MOST_CURVES):
    """At most `most` of the names, unless all are asked for, and how many were left out."""
    if all_of_them or len(names) <= most:
        return list(names), 0
    order = [name for name in FIRST_SHOWN if name in names] + [name for name in names if name not in FIRST_SHOWN]
    kept = set(order[:most])
    return [name for name in names if name in kept], len(names) - most


def left_out(count):
    """What a title says of rows that a chart leaves out."""
    return f" ({count} more rows with --all)" if count else ""


def spans_decades(values):
    """Whether positive values differ so much that an axis has to be logarithmic."""
    positive = [value for value in values if value > 0]
    return bool(positive) and math.log10(max(positive) / min(positive)) > 1.5


def _lines(names, width):
    """The names in groups, one to a line of text, whose length in letters is at most `width`, or that of a single name."""
    lines = []
    for name in names:
        if lines and len(", ".join(lines[-1] + [name])) <= width:
            lines[-1].append(name)
        else:
            lines.append([name])
    return lines


def _moved_apart(heights, gap, low, high):
    """Ascending heights, moved as little as possible so that neighbours are `gap` apart; from `low` to `high` where they fit.
    Heights that are too close form a block around their mean."""
    blocks = []  # the sum of the lowest places that the members ask for, and how many members
    for i, height in enumerate(heights):
        blocks.append((height - i * gap, 1))
        while len(blocks) > 1 and blocks[-2][0] / blocks[-2][1] > blocks[-1][0] / blocks[-1][1]:
            total, count = blocks.pop()
            blocks[-1] = (blocks[-1][0] + total, blocks[-1][1] + count)
    moved = [total / count for total, count in blocks for _ in range(count)]
    highest = high - (len(heights) - 1) * gap
    return [max(low, min(place, highest)) + i * gap for i, place in enumerate(moved)]


def label_ends(axes, ends, fontsize=8, width=24, room=0):
    """Writes each name beside the right end of its curve. Curves that end in one place share a line of text of at most `width`
    letters, and lines are moved apart so that no two overlap. `ends`: (x, y, name, colour). `room`: pixels left free beside the
    axes. To be called last, as it needs the final layout."""
    if not ends:
        return
    figure = axes.figure
    figure.canvas.draw()  # lays the axes out, so that distances on the page are known
    low, high = axes.get_ylim()
    by_place = {}
    for x, y, name, colour in ends:
        place = tuple(round(c) for c in axes.transData.transform((x, min(max(y, low), high))))
        by_place.setdefault(place, {})[name] = colour
    lines = [(place, ", ".join(names), by_place[place][names[0]]) for place in sorted(by_place, key=lambda place: place[1])
             for names in reversed(_lines(by_place[place], width))]
    heights = _moved_apart([y for (_, y), _, _ in lines], fontsize * 1.3 * figure.dpi / 72, axes.bbox.y0, axes.bbox.y1)
    right = axes.bbox.x1 + 14 + room
    points = 72 / figure.dpi  # a PDF has other pixels
    for (place, text, colour), y in zip(lines, heights):
        note = axes.annotate(text, xy=(place[0] * points, place[1] * points), xycoords="figure points",
                             xytext=(right * points, y * points), textcoords="figure points", color=colour, fontsize=fontsize,
                             va="center", annotation_clip=False,
                             arrowprops={"arrowstyle": "-", "color": colour, "lw": 0.6, "shrinkA": 0, "shrinkB": 1,
                                         "relpos": (0, 0.5)})
        note.set_in_layout(False)


def label_panels(labelled, fontsize=8):
    """Labels the curves of all panels of a figure: pairs of axes and of ends, as label_ends() takes them. Each panel keeps room
    for its names on its right, by names that nobody sees."""
    for axes, ends in labelled:
        for _, _, name, _ in ends:
            axes.annotate(name, xy=(1, 0.5), xycoords="axes fraction", xytext=(16 * 72 / axes.figure.dpi, 0),
                          textcoords="offset points", fontsize=fontsize, alpha=0, va="center", annotation_clip=False)
    for axes, ends in labelled:
        label_ends(axes, ends, fontsize, max((len(name) for _, _, name, _ in ends), default=0))


def log_axis(axis):
    """A logarithmic axis whose ticks are plain numbers: powers of ten, or 1, 2 and 5 of each where there are few decades."""
    axes = axis.axes
    set_scale, limits = (axes.set_xscale, axes.get_xlim) if axis is axes.xaxis else (axes.set_yscale, axes.get_ylim)
    set_scale("log")
    low, high = limits()
    if not spans_decades((low, high)):
        axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def ticks(axes, values, text):
    """Ticks where something was measured, and nowhere else."""
    axes.set_xticks(values, [text(value) for value in values])
    axes.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())


def panels(count, height=2.7, columns=2, title_height=0.4):
    """A figure with `count` axes, as wide as the page shows it readably: eight inches, or five for a single panel."""
    columns = min(columns, count)
    rows = -(-count // columns)
    width = 8 if columns > 1 else 5
    figure, cells = plt.subplots(rows, columns, figsize=(width, height * rows + title_height), squeeze=False)
    flat = list(itertools.chain(*cells))
    for axes in flat[count:]:
        axes.set_visible(False)
    return figure, flat


def _palette(image, colours, method):
    reduced_image = image.quantize(colours, method=method, dither=Image.Dither.NONE)
    return np.array(reduced_image.getpalette()[:3 * colours], np.uint8).reshape(-1, 3)


def reduced(image, shaded):
    """The picture in few colours, in a fraction of the bytes. Large areas keep their colours: the most frequent colours of a
    chart, which has few, and a median cut of the many shades of a surface. The rest of the palette covers all colours alike, so
    that a few small markers or triangles keep theirs too, nearly."""
    image = image.convert("RGB")
    found, which, counts = np.unique(np.asarray(image).reshape(-1, 3), axis=0, return_inverse=True, return_counts=True)
    frequent = _palette(image, 192, Image.Quantize.MEDIANCUT) if shaded else found[np.argsort(-counts, kind="stable")[:32]]
    covering = _palette(image, 64 if shaded else 96, Image.Quantize.MAXCOVERAGE)
    palette = np.unique(np.concatenate([frequent, covering]), axis=0)
    nearest = np.empty(len(found), np.uint8)
    for start in range(0, len(found), 4096):
        part = slice(start, start + 4096)
        nearest[part] = ((found[part, None].astype(np.int32) - palette) ** 2).sum(axis=2).argmin(axis=1)
    few = Image.fromarray(nearest[which].reshape(image.height, image.width), "P")
    few.putpalette(palette.tobytes())
    return few


def save(figure, folder, name, shaded=False, dpi=None, pdf=False):
    """Writes FOLDER/NAME.png, and NAME.pdf where a paper may want it, closes the figure, and says so: some figures take a minute."""
    folder.mkdir(parents=True, exist_ok=True)
    if pdf:
        figure.savefig(folder / f"{name}.pdf", metadata={"CreationDate": None})
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi or figure.dpi, metadata={"Software": None})
    plt.close(figure)
    buffer.seek(0)
    reduced(Image.open(buffer), shaded).save(folder / f"{name}.png", optimize=True)
    print(f"drawn: {folder / name}.png" + (f", {name}.pdf" if pdf else ""), file=sys.stderr, flush=True)
