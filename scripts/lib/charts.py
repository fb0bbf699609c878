"""One look for all charts: a strategy has one colour and one dash everywhere, curves are labelled at their ends, and a
picture is a small PNG whose bytes depend on the record alone."""
import io
import itertools
import math
import zlib

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({
    "figure.dpi": 150, "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
    "grid.alpha": 0.3, "legend.frameon": False, "figure.constrained_layout.use": True,
})
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of backend)
import matplotlib.ticker  # noqa: E402
from PIL import Image  # noqa: E402

# Okabe and Ito's colours, which colour-blind readers can tell apart, and a few more for rows that are seldom drawn.
BLACK, ORANGE, BLUE, GREEN, PINK, RED, SKY, OLIVE, GREY = (
    "#000000", "#E69F00", "#0072B2", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#999933", "#888888")
STRATEGIES = {  # colour and dash by name; a family has one colour
    "base": (BLACK, "-"), "brute": (GREY, ":"), "aabb": (SKY, "-"), "mcd": (ORANGE, "-"), "selfccd": (GREEN, "-"),
    "embree": (SKY, "--"), "cgal_boxes": (SKY, ":"), "fcl": (GREY, "--"),
    "rvbc": (PINK, "-"), "rvbc_relative": (PINK, "--"),
    "drvbc": (BLUE, "-"), "drvbc_unrefined": (BLUE, "--"), "drvbc_unmerged": (BLUE, ":"), "drvbc_unrelative": (BLUE, "-."),
    "drvbc_uncached": (BLUE, (0, (5, 1, 1, 1))), "drvbc_one_vertex": (BLUE, (0, (1, 3))),
    "drvbc_fast": (RED, "-"), "drvbc_fast_complete": (RED, "--"), "drvbc_fast_one_cover": (OLIVE, "-"),
    "drvbc_fast_two_covers": (OLIVE, "--"), "drvbc_fast_swept_bounds": (OLIVE, ":"), "drvbc_fast_no_stars": (OLIVE, "-."),
    "drvbc_fast_no_planes": (OLIVE, (0, (5, 1, 1, 1))), "drvbc_fast_bones": (RED, "-."), "drvbc_fast_no_bones": (RED, ":"),
}
TESTS = {  # elementary tests
    "newton": BLACK, "newton_float": GREY, "filtered_exact": RED, "exact": PINK, "cubic": ORANGE, "inclusion": BLUE,
    "additive": GREEN, "fcl": SKY,
}
MARKERS = "osD^vPX*<>h"
COLOURS = (BLACK, ORANGE, BLUE, GREEN, PINK, RED, SKY, OLIVE, "#882255", "#44AA99")
STAGES = {"refit": "#999999", "rv_update": SKY, "traversal": ORANGE, "elementary": BLUE}
START_TEST = "embedding"  # a stage outside the query: the exact test whether the start is embedded
# Which rows a chart shows when there are more than MOST_CURVES.
FIRST_SHOWN = ("base", "aabb", "mcd", "selfccd", "rvbc", "drvbc", "drvbc_fast", "drvbc_fast_complete")
MOST_CURVES = 8


def _of_unknown(name, choices):
    return choices[zlib.crc32(name.encode()) % len(choices)]


def line_style(strategy):
    """Colour and dash of a strategy; a row such as "base --first" looks like its strategy."""
    colour, dash = STRATEGIES.get(strategy.split(" ")[0], (_of_unknown(strategy, COLOURS), "-"))
    return {"color": colour, "ls": ":" if " --first" in strategy else dash}


def marker(name):
    known = list(STRATEGIES) + list(TESTS)
    return MARKERS[known.index(name.split(" ")[0]) % len(MARKERS)] if name.split(" ")[0] in known else _of_unknown(name, MARKERS)


def test_colour(name):
    return TESTS.get(name) or _of_unknown(name, COLOURS)


def shown(names, all_of_them=False):
    """At most eight of the names, unless all are asked for, and how many were left out."""
    if all_of_them or len(names) <= MOST_CURVES:
        return list(names), 0
    order = [name for name in FIRST_SHOWN if name in names] + [name for name in names if name not in FIRST_SHOWN]
    kept = set(order[:MOST_CURVES])
    return [name for name in names if name in kept], len(names) - MOST_CURVES


def spans_decades(values):
    """Whether positive values differ so much that an axis has to be logarithmic."""
    positive = [value for value in values if value > 0]
    return bool(positive) and math.log10(max(positive) / min(positive)) > 1.5


def _joined(names):
    text = ", ".join(names)
    return text if len(text) <= 24 else ",\n".join(names)


def label_ends(axes, ends, fontsize=8):
    """Writes each name beside the right end of its curve. Curves that end in one place share a line of text, and lines are
    moved apart so that no two overlap. `ends`: (x, y, name, colour). To be called last, as it needs the final layout."""
    if not ends:
        return
    figure = axes.figure
    figure.canvas.draw()  # lays the axes out, so that distances on the page are known
    low, high = axes.get_ylim()
    by_place = {}
    for x, y, name, colour in ends:
        place = tuple(round(c) for c in axes.transData.transform((x, min(max(y, low), high))))
        by_place.setdefault(place, ([], colour))[0].append(name)
    places = sorted(by_place, key=lambda place: place[1])
    gap = fontsize * 1.3 * figure.dpi / 72
    at = []
    for _, y in places:
        at.append(max(y, at[-1] + gap) if at else y)
    top = axes.bbox.y1
    for i in reversed(range(len(at))):  # where the uppermost would leave the axes, the lines move down again
        at[i] = min(at[i], top)
        top = at[i] - gap
    right = axes.bbox.x1 + 14
    for place, y in zip(places, at):
        names, colour = by_place[place]
        note = axes.annotate(_joined(names), xy=place, xycoords="figure pixels", xytext=(right, y),
                             textcoords="figure pixels", color=colour, fontsize=fontsize, va="center", annotation_clip=False,
                             arrowprops={"arrowstyle": "-", "color": colour, "lw": 0.6, "shrinkA": 0, "shrinkB": 1})
        note.set_in_layout(False)


def ticks(axes, values, text):
    """Ticks where something was measured, and nowhere else."""
    axes.set_xticks(values, [text(value) for value in values])
    axes.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())


def panels(count, height=2.9, width=3.5):
    """A figure with `count` axes, at most three across."""
    columns = min(3, count)
    rows = -(-count // columns)
    figure, cells = plt.subplots(rows, columns, figsize=(width * columns + 0.4, height * rows + 0.4), squeeze=False)
    flat = list(itertools.chain(*cells))
    for axes in flat[count:]:
        axes.set_visible(False)
    return figure, flat


def reduced(image, colours):
    """The picture in few colours; a chart has few anyway, and the file is a fraction of the size."""
    return image.convert("RGB").quantize(colours, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)


def save(figure, folder, name, colours=64, dpi=None):
    """Writes FOLDER/NAME.png and closes the figure."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi or figure.dpi, metadata={"Software": None})
    plt.close(figure)
    buffer.seek(0)
    reduced(Image.open(buffer), colours).save(folder / f"{name}.png", optimize=True)
