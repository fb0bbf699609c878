"""Draws the paper's Figures 1, 8 and 9 of any scene: clusters, and triangles that are not positive.

  scripts/figures clusters --cscd build-release/cscd --scene octopus --figure 1 --out octopus-figure1.png

--figure  1   clusters of rvbc, which are fixed, above those of drvbc, which are merged anew in every interval
          8   one pose with few clusters (drvbc) and with many (drvbc_unmerged): triangles that are not positive, seen through
              the surface, and the clusters
          9   what merging does over time: triangles that are not positive, before merging above (drvbc_unmerged) and after it
              below (drvbc); a part of each picture is enlarged

Asks `cscd clusters` for the surface and the clusters in force in the interval that begins at a frame. The surface is seen from where
it shows most of itself. Clusters that touch have different colours (greedy colouring of their graph, in Okabe and Ito's palette).
Triangles are painted from back to front, with no 3D library.
"""
import functools
import pathlib

import numpy as np

from charts import matplotlib, plt, save
from script import answer_of, parser_of, refuse
from surface import broad_side, paint, shaded, shared_edges, view_axes

PALETTE = np.array([matplotlib.colors.to_rgb(c) for c in
                    ("#0072B2", "#E69F00", "#56B4E9", "#D55E00", "#009E73", "#F0E442", "#CC79A7")])
NOT_POSITIVE, BACKGROUND = "#0033CC", "#DDDDD6"
DETAIL = 0.2  # width of what is enlarged, as a share of the picture


def colour_of_cluster(triangles, cluster):
    """A colour for each cluster that no neighbour has, where the palette allows it; few colours are not the aim."""
    neighbours = {c: set() for c in np.unique(cluster)}
    for a, b in cluster[np.stack(shared_edges(triangles)[1:], axis=1)]:
        if a != b:
            neighbours[a].add(b)
            neighbours[b].add(a)
    colour = {}
    for i, c in enumerate(neighbours):
        taken = {colour[n] for n in neighbours[c] if n in colour}
        free = [k % len(PALETTE) for k in range(i, i + len(PALETTE)) if k % len(PALETTE) not in taken]
        colour[c] = free[0] if free else i % len(PALETTE)
    return np.array([colour[c] for c in cluster])


class Panel:
    """A surface with colours, a title, and how it is seen."""

    def __init__(self, document, view, title, colours, through=None, detail=None, borders=None):
        self.positions, self.triangles = np.array(document["positions"]), np.array(document["triangles"])
        self.view, self.title, self.through, self.borders = view, title, through, borders
        self.detail = detail if detail is not None and detail.any() else None
        self.colours = shaded(self.positions, self.triangles, colours, view)
        if through is not None:  # shading would hide what matters
            self.colours[through] = matplotlib.colors.to_rgb(NOT_POSITIVE)

    def draw(self, axes):
        """Returns width and height of what was painted."""
        size = self.paint(axes, 0.5)
        axes.set_title(self.title, fontsize=9)
        if self.detail is not None:
            self.enlarge(axes, size)
        return size

    def paint(self, axes, border):
        return paint(axes, self.positions, self.triangles, self.colours, self.view, self.through, self.borders, border)

    def enlarge(self, axes, size):
        """Shows beside the picture, enlarged, where most triangles of the mask `detail` are."""
        right, up, _ = self.view
        middle = self.positions[self.triangles].mean(axis=1)
        points = np.stack([middle @ right, middle @ up], axis=1)[self.detail]
        half = DETAIL / 2 * max(size)
        close = (np.abs(points[:, None] - points[None, ::max(1, len(points) // 500)]) < half).all(axis=2)
        x, y = points[::max(1, len(points) // 500)][close.sum(axis=0).argmax()]
        inset = axes.inset_axes([1.02, 0.0, 0.36 * size[1] / size[0], 0.36])  # as high as wide, and as high in all panels
        self.paint(inset, 1)
        inset.set_xlim(x - half, x + half)
        inset.set_ylim(y - half, y + half)
        inset.axis("on")
        inset.set(xticks=[], yticks=[])
        for spine in inset.spines.values():
            spine.set_visible(True)
        axes.indicate_inset_zoom(inset, edgecolor="black", alpha=1)


def by_cluster(document, view):
    cluster = np.array(document["mega_cluster"])
    title = f"frame {document['frame']}, {document['strategy']}:\n{len(np.unique(cluster))} clusters"
    return Panel(document, view, title, PALETTE[colour_of_cluster(np.array(document["triangles"]), cluster)], borders=cluster)


def by_sign(document, view, detail=None):
    through = ~np.array(document["positive"])
    clusters = np.array(document["mega_cluster"])
    title = f"frame {document['frame']}, {document['strategy']}:\n{len(np.unique(clusters))} clusters, {np.sum(through)} not positive"
    colours = np.tile(matplotlib.colors.to_rgb(BACKGROUND), (len(clusters), 1))
    return Panel(document, view, title, colours, through, detail, clusters)


def figure_1(ask, frames, view):
    return [[by_cluster(ask(frame, strategy), view) for frame in frames] for strategy in ("rvbc", "drvbc")]


def figure_8(ask, frames, view):
    few, many = ask(frames[0], "drvbc"), ask(frames[0], "drvbc_unmerged")
    return [[by_sign(few, view), by_sign(many, view), by_cluster(many, view)]]


def figure_9(ask, frames, view):
    columns = []
    for frame in frames:
        apart, merged = ask(frame, "drvbc_unmerged"), ask(frame, "drvbc")
        differ = np.array(apart["positive"]) != np.array(merged["positive"])  # what merging makes of the signs
        columns.append([by_sign(apart, view, differ), by_sign(merged, view, differ)])
    return list(zip(*columns))


FIGURES = {"1": figure_1, "8": figure_8, "9": figure_9}


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--cscd", type=pathlib.Path, required=True, help="the program")
    parser.add_argument("--scene", default="rope", help="default rope")
    parser.add_argument("--figure", choices=FIGURES, required=True, help="of the paper")
    parser.add_argument("--frames", default="60,110,170,235", help="where intervals begin, with commas between; Figure 8 takes the first")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    if arguments.out.suffix != ".png":
        refuse(f"{arguments.out}: pictures are PNG files; let its name end in .png")
    frames = [int(frame) for frame in arguments.frames.split(",")]
    # Every figure shows drvbc at the first frame, which the view is made for.
    ask = functools.cache(lambda frame, strategy: answer_of(arguments.cscd, "clusters", arguments.scene, "--frame", frame,
                                                            "--strategy", strategy))
    view = broad_side(np.array(ask(frames[0], "drvbc")["positions"]), view_axes(-60, 20))
    draw(FIGURES[arguments.figure](ask, frames, view), arguments.out)


def draw(panels, out):
    """Draws a picture of `panels`, a list of rows of Panel. Panels of a row have one height, and widths as the shapes need them."""
    figure, grid = plt.subplots(len(panels), len(panels[0]), squeeze=False, layout="none")
    sizes = [[panel.draw(axes) for axes, panel in zip(axes_row, row)] for axes_row, row in zip(grid, panels)]
    wide = 1.6 if any(panel.detail is not None for row in panels for panel in row) else 1  # room for enlarged parts
    height = 4.2
    widths = [max(0.6 * height, height * w / h) for w, h in sizes[0]]
    grid[0][0].get_gridspec().set_width_ratios(widths)
    figure.set_size_inches(min(16.0, (sum(widths) + 0.3 * len(widths)) * wide), (height + 0.4) * len(panels))
    figure.subplots_adjust(left=0.01, right=0.99 if wide == 1 else 0.85, top=1 - 0.1 / len(panels), bottom=0.01,
                           wspace=0.05 if wide == 1 else 0.75)
    save(figure, out.parent, out.stem, shaded=True, dpi=110)
