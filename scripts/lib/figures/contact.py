"""Draws where a scene touches itself: at rest, in the interval of a contact, and near the contact.

  scripts/figures contact --cscd build-release/cscd --scene hand_contact --out contact.png

Asks `cscd query` for the contacts and `cscd clusters` for the surface. The interval is the first one with contacts, unless
--interval names another.
"""
import pathlib

import numpy as np

from charts import RED, matplotlib, plt, save
from script import answer_of, parser_of, refuse
from surface import broad_side, paint, shaded, view_axes

SKIN = np.array(matplotlib.colors.to_rgb("#C9D3DB"))
TOUCHED = np.array(matplotlib.colors.to_rgb("#E69F00"))


def surface_at(cscd, scene, frame):
    document = answer_of(cscd, "clusters", scene, "--frame", frame, "--strategy", "drvbc_fast")
    return np.array(document["positions"]), np.array(document["triangles"])


def chosen_interval(answer, wanted, scene):
    touching = [interval for interval in answer["intervals"] if interval["contacts"]]
    if wanted is not None:
        touching = [interval for interval in touching if interval["index"] == wanted]
    if not touching:
        refuse(f"{scene}: has no contact there; choose another scene or interval")
    return touching[0]


def hiding(corners, point, axes):
    """The number of triangles that lie before a point, for somebody who looks along the third axis."""
    x, y, z = ((corners - point) @ axis for axis in axes)  # [triangles, 3 corners]
    sides = [x[:, i] * y[:, (i + 1) % 3] - x[:, (i + 1) % 3] * y[:, i] for i in range(3)]
    area = sum(sides)
    over = np.all([side * area > 0 for side in sides], axis=0)
    depth = sum(side * z[:, (i + 2) % 3] for i, side in enumerate(sides)) / np.where(area == 0, 1, area)
    # What touches at the point itself hides nothing.
    return np.sum(over & (depth > 0.01 * np.ptp(corners @ axes[1])))


def clearest_view(positions, triangles, points, near):
    """The view, of some all round the upright axis of another one, from which the fewest triangles hide the points. Of
    several such the one nearest to the other view."""
    right, up, towards = near
    corners = positions[triangles]
    best = None
    for azimuth in np.radians(np.arange(0, 360, 15)):
        for elevation in np.radians((-60, -35, -10, 15, 40, 65)):
            flat = np.cos(azimuth) * towards + np.sin(azimuth) * right
            direction = np.cos(elevation) * flat + np.sin(elevation) * up
            side = np.cross(up, flat)
            axes = side, np.cross(direction, side), direction
            hidden = sum(hiding(corners, point, axes) for point in points[:: max(1, len(points) // 40)])
            rank = hidden, -direction @ towards
            if best is None or rank < best[0]:
                best = rank, axes
    return best[1]


def draw(panel, positions, triangles, touched, view, title):
    colours = np.where(touched[:, None], TOUCHED, SKIN)
    paint(panel, positions, triangles, shaded(positions, triangles, colours, view), view)
    panel.set_title(title, fontsize=10)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--cscd", type=pathlib.Path, required=True, help="the program")
    parser.add_argument("--scene", default="hand_contact")
    parser.add_argument("--interval", type=int)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    if arguments.out.suffix != ".png":
        refuse(f"{arguments.out}: pictures are PNG files; let its name end in .png")
    interval = chosen_interval(answer_of(arguments.cscd, "query", arguments.scene), arguments.interval, arguments.scene)
    rest, triangles = surface_at(arguments.cscd, arguments.scene, 0)
    start, _ = surface_at(arguments.cscd, arguments.scene, interval["index"])
    points = np.array([contact["point"] for contact in interval["contacts"]])
    meeting = {vertex for contact in interval["contacts"] for vertex in contact["vertices"]}
    touched = np.isin(triangles, list(meeting)).all(axis=1)
    broad = broad_side(rest, view_axes(-60, 20))
    view = clearest_view(start, triangles, points, broad)
    right, up, _ = view

    figure, (at_rest, whole, near) = plt.subplots(1, 3, figsize=(10, 4.2), layout="none", width_ratios=(1, 1, 1.1))
    draw(at_rest, rest, triangles, np.zeros(len(triangles), bool), broad, "at rest")
    count = len(interval["contacts"])
    draw(whole, start, triangles, touched, view, f"interval {interval['index']}: {count} contacts")
    draw(near, start, triangles, touched, view, f"the first at t = {interval['time']:.3f} of the interval")
    flat = np.stack([points @ right, points @ up], axis=1)
    first = flat[np.argmin([contact["time"] for contact in interval["contacts"]])]
    for panel, size in ((whole, 6), (near, 16)):
        panel.scatter(*flat.T, s=size, color=RED, lw=0, zorder=3)
    near.scatter(*first, s=160, facecolors="none", edgecolors=RED, lw=1.6, zorder=4)
    reach = 1.1 * max(np.ptp(flat[:, 0]), np.ptp(flat[:, 1]), 0.12 * np.ptp(rest @ up)) / 2
    middle = (flat.min(axis=0) + flat.max(axis=0)) / 2
    near.set_xlim(middle[0] - reach, middle[0] + reach)
    near.set_ylim(middle[1] - reach, middle[1] + reach)
    whole.add_patch(matplotlib.patches.Rectangle(middle - reach, 2 * reach, 2 * reach, fill=False, ec="#555555", lw=0.8))
    figure.subplots_adjust(left=0.01, right=0.99, top=0.92, bottom=0.01, wspace=0.04)
    save(figure, arguments.out.parent, arguments.out.stem, shaded=True, dpi=110)
