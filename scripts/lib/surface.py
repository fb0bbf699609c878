"""Pictures of surfaces without a 3D library: triangles are painted from back to front."""
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

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


def draw_borders(axes, positions, triangles, label, view, width):
    """Draws the edges between triangles with different labels, where they face the viewer."""
    right, up, towards = view
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(triangles)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    twice = np.flatnonzero(np.all(edges[1:] == edges[:-1], axis=1))
    a, b = owner[twice], owner[twice + 1]
    facing = normals_of(positions, triangles) @ towards > 0
    border = twice[(label[a] != label[b]) & facing[a] & facing[b]]
    ends = positions[edges[border]]
    axes.add_collection(LineCollection(np.stack([ends @ right, ends @ up], axis=2), colors="black", linewidths=width))


def paint(axes, positions, triangles, colours, view, through=None):
    """Paints the triangles that face the viewer, and returns width and height of the surface on the page. `through`, a mask of
    triangles: these are painted last and wherever they face, as if one saw them through the surface."""
    right, up, towards = view
    corners = positions[triangles]
    order = np.argsort(corners.mean(axis=1) @ towards)
    facing = order[(normals_of(positions, triangles) @ towards > 0)[order]]
    if through is not None:
        facing = np.concatenate([facing[~through[facing]], order[through[order]]])
    flat = np.stack([corners @ right, corners @ up], axis=2)
    axes.add_collection(PolyCollection(flat[facing], facecolors=colours[facing], edgecolors=colours[facing], linewidths=0.15))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.axis("off")
    return np.ptp(flat[..., 0]), np.ptp(flat[..., 1])
