"""Pictures of surfaces without a 3D library: triangles are painted from back to front."""
import numpy as np
from matplotlib.collections import PolyCollection

AMBIENT = 0.35


def view_axes(azimuth, elevation):
    """Right, up and towards the viewer, for a view from that direction in degrees."""
    a, e = np.radians(azimuth), np.radians(elevation)
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return right, np.cross(towards, right), towards


def broad_side(positions, near):
    """Axes of a view along the direction in which the surface is thinnest, its longest direction upright, from the side that
    is nearer to another view."""
    _, _, axes = np.linalg.svd(positions - positions.mean(axis=0), full_matrices=False)
    up = axes[0] * (1 if axes[0][np.argmax(np.abs(axes[0]))] > 0 else -1)
    towards = axes[2] * (1 if axes[2] @ near[2] > 0 else -1)
    return np.cross(up, towards), up, towards


def normals_of(positions, triangles):
    corners = positions[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


def shaded(positions, triangles, colours, view):
    """The colours of the triangles under a light from above, over the viewer's left shoulder."""
    right, up, towards = view
    light = -0.4 * right + 0.7 * up + 0.6 * towards
    bright = AMBIENT + (1 - AMBIENT) * np.clip(normals_of(positions, triangles) @ (light / np.linalg.norm(light)), 0, 1)
    return colours * bright[:, None]


def shared_edges(triangles):
    """Edges that two triangles share, as pairs of vertices, and the numbers of both triangles."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(triangles)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    twice = np.flatnonzero(np.all(edges[1:] == edges[:-1], axis=1))
    return edges[twice], owner[twice], owner[twice + 1]


def border_edges(positions, triangles, label, towards):
    """Edges between triangles with different labels, as positions of their ends, where both triangles face the viewer."""
    edges, a, b = shared_edges(triangles)
    facing = normals_of(positions, triangles) @ towards > 0
    return positions[edges[(label[a] != label[b]) & facing[a] & facing[b]]]


def paint(axes, positions, triangles, colours, view, through=None, label=None, border=0.5):
    """Paints the triangles that face the viewer, and returns width and height of the surface on the page. `through`, a mask of
    triangles: these are painted last and wherever they face, as if one saw them through the surface. `label`, a number a
    triangle: where it changes, an edge is drawn in black, `border` points wide."""
    right, up, towards = view
    corners = positions[triangles]
    drawn = np.arange(len(triangles))[normals_of(positions, triangles) @ towards > 0]
    if through is not None:
        drawn = np.concatenate([drawn[~through[drawn]], np.flatnonzero(through)])
    polygons, fill, widths = corners[drawn], colours[drawn], np.full(len(drawn), 0.15)
    depth = polygons.mean(axis=1) @ towards
    if through is not None:
        depth[through[drawn]] += 1e3 * np.ptp(corners @ towards)
    if label is not None:  # edges are painted as triangles without area, a little nearer to the viewer
        ends = border_edges(positions, triangles, label, towards)
        nearer = np.ptp(corners @ towards) / 100
        polygons = np.concatenate([polygons, ends[:, [0, 1, 1]]])
        depth = np.concatenate([depth, ends.mean(axis=1) @ towards + nearer])
        fill = np.concatenate([fill, np.zeros((len(ends), 3))])
        widths = np.concatenate([widths, np.full(len(ends), border)])
    order = np.argsort(depth, kind="stable")
    flat = np.stack([polygons @ right, polygons @ up], axis=2)
    axes.add_collection(PolyCollection(flat[order], facecolors=fill[order], edgecolors=fill[order], linewidths=widths[order]))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.axis("off")
    return np.ptp(corners @ right), np.ptp(corners @ up)
